// SPDX-License-Identifier: MIT
// Photographs against what their scene says of them: everything is measured on the files.
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "datasets/readers/scene.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/truth/ground_truth.h"
#include "datasets/types/errors.h"
#include "datasets/types/median.h"
#include "tests/datasets/temp_folder.h"
#include "tests/synthetic/small_photographs.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using test::small;

Image<float> grey_of(const Picture& p) {
  Image<float> grey(p.width(), p.height());
  for (size_t i = 0; i < grey.data.size(); ++i)
    grey.data[i] = (p.red.data[i] + p.green.data[i] + p.blue.data[i]) / 3;
  return grey;
}

// The camera's curve undone: on it, borders of dark things lie inside of them (0.2 px).
Image<float> linear(Image<float> grey) {
  for (float& v : grey.data) v = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  return grey;
}

double bilinear(const Image<float>& image, const Vector2d& at) {
  const int x = int(at.x()), y = int(at.y());
  const double u = at.x() - x, v = at.y() - y;
  return (1 - v) * ((1 - u) * image.at(x, y) + u * image.at(x + 1, y)) +
         v * ((1 - u) * image.at(x, y + 1) + u * image.at(x + 1, y + 1));
}

// Where along `normal` from `at` the picture changes most, within 3 px; NaN where little does.
double offset_of_edge(const Image<float>& image, const Vector2d& at, const Vector2d& normal) {
  double strongest = 0, offset = 0;
  for (double s = -3; s <= 3; s += 0.05) {
    const double change = std::abs(bilinear(image, at + (s + 0.8) * normal) -
                                   bilinear(image, at + (s - 0.8) * normal));
    if (change > strongest) strongest = change, offset = s;
  }
  return strongest > 0.06 && std::abs(offset) < 2.9 ? offset : std::nan("");
}

// Distances [px] of the truth, as `draw` puts it into the image, from the edges of the photograph.
template <typename Draw>
std::vector<double> offsets(const SyntheticScene& scene, const View& view, const Draw& draw) {
  const Image<float> grey = linear(grey_of(read_picture(view)));
  std::vector<double> all;
  for (const TruthCurve& curve : scene.truth.curves)
    for (int i = 1; i < curve.points.cols(); i += 3) {
      const Vector2d a = draw(curve.points.col(i - 1)), b = draw(curve.points.col(i));
      if (a.minCoeff() < 6 || a.x() > grey.width - 7 || a.y() > grey.height - 7) continue;
      if ((b - a).norm() < 1e-6) continue;
      const Vector2d along = (b - a).normalized();
      const double offset = offset_of_edge(grey, a, {-along.y(), along.x()});
      if (std::isfinite(offset)) all.push_back(std::abs(offset));
    }
  return all;
}

TEST(Photographs, TruthThroughTheLensLiesOnTheEdgesOfTheFiles) {
  for (const Finish surface : {Finish::kPainted, Finish::kMetal, Finish::kPrinted}) {
    const TempFolder folder;
    SynthesizeOptions options = small();
    options.photo.surface = surface;
    options.photo.distortion = 2;
    options.rig.distance = 1.9;  // so that the part reaches to where the lens bends much
    options.render.noise = 2;
    options.render.exposure = 0.2;
    const SyntheticScene scene = synthesize(options);
    write_scene(scene, folder.path());
    const Scene read = open_scene(folder.path());
    ASSERT_EQ(read.views.size(), 3u);
    std::vector<double> with_lens, as_pinhole;
    for (const View& view : read.views) {
      double depth;
      const auto through_lens = [&](const Vector3d& p) {
        Vector2d pixel(-1, -1);
        view.image_pixel(view.project(p, &depth), &pixel);
        return pixel;
      };
      for (const double offset : offsets(scene, view, through_lens)) with_lens.push_back(offset);
      const auto straight = [&](const Vector3d& p) { return view.project(p, &depth); };
      for (const double offset : offsets(scene, view, straight)) as_pinhole.push_back(offset);
    }
    EXPECT_GT(with_lens.size(), 1000u);
    ASSERT_FALSE(with_lens.empty());
    EXPECT_LT(median(with_lens), 0.18) << "surface " << int(surface);
    EXPECT_GT(median(as_pinhole), 0.5) << "the test would notice";
  }
}

TEST(Photographs, MasksAreThePartsSilhouette) {
  const SyntheticScene scene = synthesize(small("flange"));
  for (int k = 0; k < 2; ++k) {
    const View& view = scene.unit_views[k];
    const Image<float> mask = render_view(scene, k).mask;
    const Vector3f eye = view.center_in_world().cast<float>();
    int part = 0, wrong = 0, soft = 0;
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x) {
        Vector2d ideal;
        ASSERT_TRUE(view.ideal_pixel({double(x), double(y)}, &ideal));
        const Vector3f way =
            (view.cam_from_world.rotation.transpose() * view.camera.ray(ideal)).cast<float>();
        const Hit part_alone = scene.tracer.cast(eye, way),
                  first = scene.photo->tracer.cast(eye, way);
        const bool seen = part_alone.face >= 0 && first.depth > 0.9999f * part_alone.depth;
        part += seen;
        const float m = mask.at(x, y);
        if (m > 0.1f && m < 0.9f) ++soft;
        wrong += seen ? m < 0.1f : m > 0.9f;
      }
    EXPECT_GT(part, 5000);
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(soft, 100);
    EXPECT_LT(soft, part / 10);
    EXPECT_NEAR(std::accumulate(mask.data.begin(), mask.data.end(), 0.0), part, 0.01 * part);
  }
}

TEST(Photographs, AreTheSameBytesForAnyNumberOfThreads) {
  SynthesizeOptions options = small();
  options.rig.resolution = 300;
  options.rig.views = 4;
  options.photo.surface = Finish::kMetal;
  options.photo.tag = 3;
  options.photo.pose_error_px = 0.5;
  options.render.noise = 2;
  options.render.blur = 0.6;
  const TempFolder one, many;
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  write_scene(synthesize(options), one.path());
  omp_set_num_threads(5);
  write_scene(synthesize(options), many.path());
  omp_set_num_threads(before);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(one.path())) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const std::string name = std::filesystem::relative(entry.path(), one.path()).string();
    EXPECT_EQ(bytes_of(entry.path().string()), bytes_of(many.path() + "/" + name)) << name;
  }
  EXPECT_GE(files, 4 + 4 + 3 + 3 + 1);
}

// Offsets [px], outwards, of the borders of a square in space from those in the picture.
std::vector<double> offsets_of_square(const View& view, const Image<float>& grey,
                                      const Eigen::Matrix<double, 3, 4>& corners) {
  std::vector<double> all;
  const auto draw = [&](const Vector3d& p) {
    double depth;
    Vector2d pixel(-1, -1);
    view.image_pixel(view.project(p, &depth), &pixel);
    return pixel;
  };
  const Vector2d middle = draw(corners.rowwise().mean());
  for (int c = 0; c < 4; ++c)
    for (double t = 0.15; t < 0.86; t += 0.05) {
      const Vector3d a = corners.col(c), b = corners.col((c + 1) % 4);
      const Vector2d at = draw(a + t * (b - a)), on = draw(a + (t + 0.01) * (b - a));
      if (at.minCoeff() < 6 || at.x() > grey.width - 7 || at.y() > grey.height - 7) continue;
      Vector2d normal = Vector2d(at.y() - on.y(), on.x() - at.x()).normalized();
      if (normal.dot(at - middle) < 0) normal = -normal;
      const double offset = offset_of_edge(grey, at, normal);
      if (std::isfinite(offset)) all.push_back(offset);
    }
  return all;
}

// By those who detect them, and by its borders.
TEST(Photographs, TheTagIsFoundWhereTheSceneSays) {
  const TempFolder folder;
  SynthesizeOptions options = small();
  options.rig.views = 12;
  options.rig.resolution = 640;
  options.extent = 30;
  options.photo.tag = 17;
  options.photo.tag_size = 8;
  const SyntheticScene scene = synthesize(options);
  write_scene(scene, folder.path());
  const auto tag = nlohmann::json::parse(bytes_of(folder.path() + "/scene.json")).at("tag");
  EXPECT_EQ(tag.at("id"), 17);
  EXPECT_NEAR(tag.at("size"), 8, 1e-4);
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  const std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector(
      apriltag_detector_create(), apriltag_detector_destroy);
  apriltag_detector_add_family(detector.get(), family.get());
  detector->quad_decimate = 1;
  Eigen::Matrix<double, 3, 4> corners;
  for (int c = 0; c < 4; ++c)
    for (int axis = 0; axis < 3; ++axis) corners(axis, c) = tag.at("corners").at(c).at(axis);
  int found = 0;
  std::vector<double> sides;
  for (const View& view : open_scene(folder.path()).views) {
    const Image<float> grey = grey_of(read_picture(view));
    std::vector<std::uint8_t> bytes(grey.data.size());
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::uint8_t(255 * grey.data[i] + 0.5f);
    image_u8_t image = {grey.width, grey.height, grey.width, bytes.data()};
    zarray_t* detections = apriltag_detector_detect(detector.get(), &image);
    for (int i = 0; i < zarray_size(detections); ++i) {
      apriltag_detection_t* detection;
      zarray_get(detections, i, &detection);
      EXPECT_EQ(detection->id, 17);
      ++found;
      Vector2d middle = Vector2d::Zero();
      for (int c = 0; c < 4; ++c) {
        double depth;
        Vector2d pixel;
        ASSERT_TRUE(view.image_pixel(view.project(corners.col(c), &depth), &pixel));
        // libapriltag counts from the corner of the first pixel, and finds squares a little large.
        const Vector2d there(detection->p[c][0] - 0.5, detection->p[c][1] - 0.5);
        EXPECT_LT((there - pixel).norm(), 0.9);
        middle += (there - pixel) / 4;
      }
      EXPECT_LT(middle.norm(), 0.2);
      for (const double offset : offsets_of_square(view, linear(grey), corners))
        sides.push_back(offset);
    }
    apriltag_detections_destroy(detections);
  }
  EXPECT_GE(found, 6);
  ASSERT_GT(sides.size(), 100u);
  const double mean = std::accumulate(sides.begin(), sides.end(), 0.0) / double(sides.size());
  EXPECT_NEAR(mean, 0, 0.05);
  for (double& side : sides) side = std::abs(side - mean);
  ASSERT_FALSE(sides.empty());
  EXPECT_LT(median(sides), 0.12);
}

TEST(Photographs, VisibilityKnowsTableAndThings) {
  SynthesizeOptions options = small("box");
  options.rig.views = 24;
  options.rig.resolution = 128;
  const SyntheticScene scene = synthesize(options);
  double lowest = 1;
  for (const TruthCurve& curve : scene.truth.curves)
    lowest = std::min(lowest, curve.points.row(2).minCoeff());
  int standing = 0;
  for (const TruthCurve& curve : scene.truth.curves) {
    const double mean =
        std::accumulate(curve.visible_views.begin(), curve.visible_views.end(), 0.0) /
        double(curve.visible_views.size());
    // An edge between two faces that look up or to a side is seen from more than half of the
    // places, one on the table from less.
    const bool on_table = curve.points.row(2).maxCoeff() < lowest + 1e-6;
    standing += on_table;
    EXPECT_GT(mean, on_table ? 5 : 10);
    EXPECT_LT(mean, on_table ? 16 : 24.1);
  }
  EXPECT_EQ(standing, 4);
}

TEST(Photographs, PartsStandAsTheyAreTold) {
  SynthesizeOptions options = small();
  options.rig.views = 20;
  for (const Up up : {Up::kZ, Up::kMinusZ, Up::kY, Up::kMinusY, Up::kX, Up::kMinusX}) {
    options.photo.up = up;
    const SyntheticScene scene = synthesize(options);
    const int axis = up == Up::kZ || up == Up::kMinusZ   ? 2
                     : up == Up::kY || up == Up::kMinusY ? 1
                                                         : 0;
    const double sign = up == Up::kZ || up == Up::kY || up == Up::kX ? 1 : -1;
    double depth;
    for (const View& view : scene.unit_views) {
      EXPECT_GT(sign * view.center_in_world()[axis], 0.4);
      EXPECT_LT(view.project(0.2 * sign * Vector3d::Unit(axis), &depth).y(),
                view.project(Vector3d::Zero(), &depth).y());
      EXPECT_NEAR(view.cam_from_world.rotation.determinant(), 1, 1e-9);
    }
    // It touches the table, and nothing of it is below.
    double lowest = 9;
    for (const TruthCurve& curve : scene.unit_curves)
      lowest = std::min(lowest, (sign * curve.points.row(axis)).minCoeff());
    EXPECT_NEAR(scene.photo->room.unit_from_room.translation()[axis] * sign, lowest, 2e-4);
  }
}

double mean_of(const Image<float>& image) {
  return std::accumulate(image.data.begin(), image.data.end(), 0.0) / double(image.data.size());
}

TEST(Photographs, ExposureAndNoiseAreWhatTheySay) {
  SynthesizeOptions options = small();
  options.rig.resolution = 200;
  const Picture plain = render(synthesize(options), 1);
  options.render.noise = 4;
  const Picture noisy = render(synthesize(options), 1);
  double sum = 0, both = 0;
  int n = 0;
  for (size_t i = 0; i < plain.red.data.size(); ++i) {
    const double p = plain.red.data[i], q = plain.blue.data[i];
    if (std::min(p, q) < 0.15 || std::max(p, q) > 0.85) continue;  // not clipped
    const double r = noisy.red.data[i] - p, b = noisy.blue.data[i] - q;
    sum += r * r;
    both += r * b;
    ++n;
  }
  EXPECT_NEAR(255 * std::sqrt(sum / n), 4, 0.15);
  EXPECT_LT(std::abs(both / sum), 0.05) << "colours have a noise of their own";
  options.render.noise = 0;
  options.render.exposure = 0.5;
  const SyntheticScene scene = synthesize(options);
  for (int k = 0; k < 3; ++k) {
    const double gain = exposure_of(options.render, options.seed, k);
    options.render.exposure = 0;
    const double before = mean_of(render(synthesize(options), k).green);
    options.render.exposure = 0.5;
    EXPECT_EQ(mean_of(render(scene, k).green) > before, gain > 1);
  }
}

// Prints are there to hold on to, and shadows are soft.
TEST(Photographs, HaveTextureAroundThePartAndLightOnIt) {
  const SyntheticScene scene = synthesize(small());
  const RenderedView view = render_view(scene, 0);
  const Image<float> grey = grey_of(view.picture);
  int corners = 0;
  double part = 0, part_pixels = 0;
  for (int y = 2; y + 2 < grey.height; ++y)
    for (int x = 2; x + 2 < grey.width; ++x) {
      if (view.mask.at(x, y) > 0.99f) part += grey.at(x, y), ++part_pixels;
      if (view.mask.at(x, y) > 0) continue;
      double xx = 0, yy = 0, xy = 0;
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u) {
          const double gx = grey.at(x + u + 1, y + v) - grey.at(x + u - 1, y + v),
                       gy = grey.at(x + u, y + v + 1) - grey.at(x + u, y + v - 1);
          xx += gx * gx, yy += gy * gy, xy += gx * gy;
        }
      const double smaller = (xx + yy) / 2 - std::hypot((xx - yy) / 2, xy);
      corners += smaller > 0.02;
    }
  EXPECT_GT(corners, 1500);
  EXPECT_GT(part / part_pixels, 0.25);
  EXPECT_LT(part / part_pixels, 0.9);
}

TEST(Photographs, RefuseWhatCannotBe) {
  SynthesizeOptions options = small();
  options.rig.kind = RigKind::kSphere;
  EXPECT_THROW(synthesize(options), InputError);
  options = small();
  options.photo.tag = 100000;
  EXPECT_THROW(synthesize(options), InputError);
  options = small();
  options.photo.distortion = 4;
  EXPECT_THROW(synthesize(options), InputError);
  options = small();
  options.photo.tag = 0;
  options.photo.tag_size = 2 * options.extent;
  EXPECT_THROW(synthesize(options), InputError);
}

}  // namespace
}  // namespace sketchsplat

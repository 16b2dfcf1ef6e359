// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/synthetic/cad/parts.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

SynthesizeOptions small(const std::string& part) {
  SynthesizeOptions options;
  options.part = part;
  options.rig.views = 3;
  options.rig.resolution = 96;
  options.outputs = "none";
  return options;
}

float bilinear(const Image<float>& image, const Vector2d& p) {
  const int x = int(std::floor(p.x())), y = int(std::floor(p.y()));
  const double u = p.x() - x, v = p.y() - y;
  return float((1 - v) * ((1 - u) * image.at(x, y) + u * image.at(x + 1, y)) +
               v * ((1 - u) * image.at(x, y + 1) + u * image.at(x + 1, y + 1)));
}

// Where alpha passes 1/2 along `normal`, if it goes from nothing to full there and nowhere else.
bool outline_offset(const Image<float>& alpha, const Vector2d& at, const Vector2d& normal,
                    double* offset) {
  constexpr double kReach = 4, kStep = 0.05;
  double crossing = 0;
  int crossings = 0;
  float before = bilinear(alpha, at - kReach * normal);
  const float after = bilinear(alpha, at + kReach * normal);
  if (std::abs(before - after) < 0.999f) return false;
  for (double t = -kReach + kStep; t <= kReach; t += kStep) {
    const float value = bilinear(alpha, at + t * normal);
    if ((before < 0.5f) != (value < 0.5f)) {
      crossing = t - kStep * (value - 0.5) / (value - before);
      ++crossings;
    }
    before = value;
  }
  *offset = after < 0.5f ? crossing : -crossing;  // positive: the picture is larger than the truth
  return crossings == 1;
}

// One face of a convex edge looks at the camera, the other away: by the normals, not by rays.
bool is_outline(const TruthCurve& curve, int i, const View& view) {
  const Vector3d tangent = (curve.points.col(i + 1) - curve.points.col(i)).normalized();
  const Vector3d outward = curve.outward.col(i), side = tangent.cross(outward);
  const Vector3d to_eye = view.center_in_world() - curve.points.col(i);
  const double half = curve.dihedral_deg * M_PI / 360;
  const double front = std::cos(half) * outward.dot(to_eye),
               turn = std::sin(half) * side.dot(to_eye);
  return (front + turn > 0) != (front - turn > 0);
}

struct Offsets {
  double mean = 0, rms = 0;
  int count = 0;
};
Offsets outline_offsets(const SyntheticScene& scene) {
  Offsets result;
  for (size_t k = 0; k < scene.views.size(); ++k) {
    const Picture picture = render(scene, int(k));
    for (const TruthCurve& curve : scene.truth.curves)
      for (int i = 5; i + 5 < curve.points.cols(); ++i) {
        double depth, offset;
        const Vector2d p = scene.views[k].project(curve.points.col(i), &depth);
        const Vector2d q = scene.views[k].project(curve.points.col(i + 1), &depth);
        if ((q - p).norm() < 0.3) continue;  // seen end on
        if (!is_outline(curve, i, scene.views[k])) continue;
        const Vector2d normal = Vector2d(p.y() - q.y(), q.x() - p.x()).normalized();
        // A concave part may hide the edge or the free space beside it.
        if (!outline_offset(picture.alpha, p, normal, &offset) || std::abs(offset) > 1) continue;
        result.mean += offset;
        result.rms += offset * offset;
        ++result.count;
      }
  }
  result.mean /= result.count;
  result.rms = std::sqrt(result.rms / result.count);
  return result;
}

TEST(Render, OutlinesMeetTheProjectedTruthWithinATwentiethOfAPixel) {
  for (const char* part : {"box", "l-bracket", "box-chamfer"}) {
    SynthesizeOptions options = small(part);
    options.rig.resolution = 800;
    options.rig.views = 4;
    const Offsets offsets = outline_offsets(synthesize(options));
    EXPECT_GT(offsets.count, 500) << part;
    EXPECT_LT(std::abs(offsets.mean), 0.01) << part;
    EXPECT_LT(offsets.rms, 0.08) << part;
    RecordProperty(std::string(part) + "_mean", std::to_string(offsets.mean));
    RecordProperty(std::string(part) + "_rms", std::to_string(offsets.rms));
  }
}

TEST(Render, TrianglesStayWithinTheDeflectionOfACylinder) {
  const Brep brep = make_part("cut-cylinder", 1);
  const UnitFrame frame = unit_frame(brep, "cut-cylinder");
  const SurfaceMesh mesh = tessellate(brep, frame, 2e-5);
  const Vector3d axis = frame * Vector3d::Zero();  // the cylinder stands on the origin, along z
  double radius = 0, sag = 0;
  for (const auto& p : mesh.points)
    radius = std::max(radius, (p.cast<double>() - axis).head<2>().norm());
  ASSERT_GT(radius, 0.1);
  int on_wall = 0;
  for (const auto& corner : mesh.corners) {
    Vector3d middle = Vector3d::Zero();
    bool wall = true;
    for (unsigned c : corner) {
      const Vector3d p = mesh.points[c].cast<double>();
      const Vector3d outward(p.x() - axis.x(), p.y() - axis.y(), 0);
      wall &= mesh.normals[c].cast<double>().dot(outward.normalized()) > 1 - 1e-6;
      middle += p / 3;
    }
    if (!wall) continue;
    ++on_wall;
    sag = std::max(sag, radius - (middle - axis).head<2>().norm());
  }
  EXPECT_GT(on_wall, 100);
  EXPECT_LT(sag, 2.1e-5);
}

TEST(WriteScene, LayoutIsThatOfAbcNef) {
  const TempFolder folder;
  write_scene(synthesize(small("box-hole")), folder.path());
  const auto meta = nlohmann::json::parse(bytes_of(folder.file("meta_data.json")));
  for (const char* key : {"camera_model", "height", "width", "worldtogt", "scene_box", "frames"})
    EXPECT_TRUE(meta.contains(key)) << key;
  ASSERT_EQ(meta["frames"].size(), 3u);
  EXPECT_EQ(meta["frames"][2]["rgb_path"], "2_colors.png");
  EXPECT_TRUE(fs::exists(folder.file("color/2_colors.png")));
  EXPECT_EQ(meta["frames"][0]["camtoworld"].size(), 4u);
  EXPECT_EQ(meta["frames"][0]["intrinsics"][0][2], 47.5);
  const auto truth = nlohmann::json::parse(bytes_of(folder.file("groundtruth/gt.json")));
  ASSERT_EQ(truth.size(), 14u);
  for (const auto& curve : truth) EXPECT_EQ(curve["points"].size(), curve["visible_views"].size());
}

TEST(Synthesize, ExtentScalesTheWorldAndChangesNoPixel) {
  const SyntheticScene unit = synthesize(small("box-hole"));
  const Picture before = render(unit, 1);
  for (double extent : {1e-3, 1e3}) {
    SynthesizeOptions options = small("box-hole");
    options.extent = extent;
    const SyntheticScene scene = synthesize(options);
    EXPECT_LT((scene.truth.sketch.nodes / extent - unit.truth.sketch.nodes).cwiseAbs().maxCoeff(),
              1e-14);
    ASSERT_EQ(scene.truth.curves.size(), unit.truth.curves.size());
    for (size_t c = 0; c < unit.truth.curves.size(); ++c)
      EXPECT_EQ(scene.truth.curves[c].visible_views, unit.truth.curves[c].visible_views);
    double depth;
    const Vector3d node = scene.truth.sketch.nodes.col(0),
                   unit_node = unit.truth.sketch.nodes.col(0);
    EXPECT_LT(
        (scene.views[1].project(node, &depth) - unit.views[1].project(unit_node, &depth)).norm(),
        1e-9);
    const Picture after = render(scene, 1);
    EXPECT_EQ(before.red.data, after.red.data);
    EXPECT_EQ(before.alpha.data, after.alpha.data);
  }
}

TEST(Render, NoiseHasItsSigmaInsideAndLeavesAlphaAlone) {
  SynthesizeOptions options = small("box");
  options.rig.resolution = 400;
  const SyntheticScene clean = synthesize(options);
  options.render.noise = 3;
  const SyntheticScene noisy = synthesize(options);
  const Picture a = render(clean, 0), b = render(noisy, 0);
  EXPECT_EQ(a.alpha.data, b.alpha.data);
  double sum = 0, sum2 = 0;
  int n = 0;
  for (size_t i = 0; i < a.red.data.size(); ++i) {
    const double d = 255.0 * (b.red.data[i] - a.red.data[i]);
    EXPECT_TRUE(a.alpha.data[i] > 0 || d == 0);
    if (a.alpha.data[i] < 1) continue;
    sum += d;
    sum2 += d * d;
    ++n;
  }
  ASSERT_GT(n, 3000);
  EXPECT_NEAR(sum / n, 0, 0.2);
  EXPECT_NEAR(std::sqrt(sum2 / n), 3, 0.15);
}

TEST(Render, OpaqueBackgroundIsTheTransparentPictureOverIt) {
  SynthesizeOptions options = small("box-hole");
  const Picture clear = render(synthesize(options), 0);
  options.render.transparent = false;
  options.render.background = 0;
  const Picture opaque = render(synthesize(options), 0);
  EXPECT_TRUE(opaque.alpha.empty());
  int inside = 0;
  for (size_t i = 0; i < clear.red.data.size(); ++i) {
    EXPECT_TRUE(clear.alpha.data[i] > 0 || opaque.red.data[i] == 0);
    if (clear.alpha.data[i] < 1) continue;
    EXPECT_NEAR(opaque.red.data[i], clear.red.data[i], 1e-6);
    ++inside;
  }
  EXPECT_GT(inside, 100);
}

TEST(Render, BlurKeepsTheLightAndWidensTheOutline) {
  SynthesizeOptions options = small("box");
  const Picture sharp = render(synthesize(options), 0);
  options.render.blur = 2;
  const Picture soft = render(synthesize(options), 0);
  const auto partial = [](const Picture& p) {
    return std::count_if(p.alpha.data.begin(), p.alpha.data.end(),
                         [](float a) { return a > 0.02f && a < 0.98f; });
  };
  EXPECT_GT(partial(soft), 2 * partial(sharp));
  double before = 0, after = 0;
  for (float a : sharp.alpha.data) before += a;
  for (float a : soft.alpha.data) after += a;
  EXPECT_NEAR(after / before, 1, 1e-3);
}

TEST(Step, RealPartsLoadWithSoundTruth) {
  const fs::path root = fs::path(SKETCHSPLAT_SOURCE_DIR) / "../shared/data/step-parts";
  if (!fs::is_directory(root)) GTEST_SKIP() << "the real parts are not there: " << root;
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    const Brep brep = read_step(entry.path().string());
    const Truth truth = sharp_edges(brep, unit_frame(brep, entry.path().string()), 1.0);
    EXPECT_TRUE(validate(truth.sketch).empty()) << entry.path();
    EXPECT_FALSE(truth.curves.empty()) << entry.path();
    for (const TruthCurve& curve : truth.curves)
      EXPECT_GT(curve.dihedral_deg, 0.1) << entry.path() << " keeps a tangent edge";
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace sketchsplat

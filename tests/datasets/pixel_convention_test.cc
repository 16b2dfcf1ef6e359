// SPDX-License-Identifier: MIT
// A cube is ray-cast pixel by pixel with the formulas of the NeRF data, written down here once
// more, and saved; what open_scene makes of the folder must project its corners onto the saved
// masks.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "datasets/readers/scene.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

constexpr int kWidth = 48, kHeight = 36, kViews = 100;
constexpr double kFocal = 50, kCx = 22.3, kCy = 19.1;  // not the middle of the image, on purpose

/// Whether a ray meets the unit cube [0, 1]^3: slabs.
bool meets_cube(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double near = 0, far = 1e30;
  for (int k = 0; k < 3; ++k) {
    const double a = -origin[k] / direction[k], b = (1 - origin[k]) / direction[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

/// Camera on a Fibonacci sphere about the cube, OpenGL axes: right, up, backward.
Eigen::Matrix4d world_from_gl(int i) {
  const double z = 1 - (2 * i + 1.0) / kViews, phi = 2.399963 * i, r = std::sqrt(1 - z * z);
  const Eigen::Vector3d backward(r * std::cos(phi), r * std::sin(phi), z);
  const Eigen::Vector3d hint(std::sin(0.7 * i), std::cos(1.3 * i), 0.3);
  const Eigen::Vector3d right = hint.cross(backward).normalized();
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.col(0).head<3>() = right;
  pose.col(1).head<3>() = backward.cross(right);
  pose.col(2).head<3>() = backward;
  pose.col(3).head<3>() = Eigen::Vector3d(0.5, 0.5, 0.5) + 4 * backward;
  return pose;
}

/// NeRF: the ray through the centre of pixel (x, y) is ((x - cx) / f, -(y - cy) / f, -1).
Image<float> ray_cast(const Eigen::Matrix4d& pose) {
  Image<float> mask(kWidth, kHeight, 0.0f);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Eigen::Vector3d ray((x - kCx) / kFocal, -(y - kCy) / kFocal, -1);
      mask.at(x, y) = meets_cube(pose.topRightCorner<3, 1>(), pose.topLeftCorner<3, 3>() * ray);
    }
  }
  return mask;
}

template <typename Matrix>
std::string as_json(const Matrix& m) {
  static const Eigen::IOFormat format(17, Eigen::DontAlignCols, ",", ",", "[", "]", "[", "]");
  std::ostringstream text;
  text << m.format(format);
  return text.str();
}

void write_scene(const TempFolder& folder) {
  Eigen::Matrix3d K;
  K << kFocal, 0, kCx, 0, kFocal, kCy, 0, 0, 1;
  std::string frames;
  for (int i = 0; i < kViews; ++i) {
    const std::string name = "train/" + std::to_string(i);
    write_png(folder.file(name + ".png"), ray_cast(world_from_gl(i)));
    frames += (i ? "," : "") + (R"({"file_path": "./)" + name) + R"(", "transform_matrix": )" +
              as_json(world_from_gl(i)) + R"(, "camera_intrinsics": )" + as_json(K) + "}";
  }
  folder.write("transforms_train.json", R"({"frames": [)" + frames + "]}");
}

using Quad = std::array<Eigen::Vector2d, 4>;

/// The projected faces of the cube.
std::vector<Quad> project_faces(const View& view) {
  std::vector<Quad> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      Quad quad;
      for (int k = 0; k < 4; ++k) {
        Eigen::Vector3d corner;
        corner[axis] = side;
        corner[(axis + 1) % 3] = k == 1 || k == 2;
        corner[(axis + 2) % 3] = k >= 2;
        double depth = 0;
        quad[k] = view.project(corner, &depth);
        EXPECT_GT(depth, 0);
      }
      faces.push_back(quad);
    }
  }
  return faces;
}

/// Distance of a point to the nearest side of a convex quad [px], positive inside.
double depth_inside(const Quad& quad, const Eigen::Vector2d& point) {
  double left = 1e30, right = 1e30;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d along = (quad[(k + 1) % 4] - quad[k]).normalized();
    const Eigen::Vector2d to = point - quad[k];
    const double distance = along.x() * to.y() - along.y() * to.x();
    left = std::min(left, distance);
    right = std::min(right, -distance);
  }
  return std::max(left, right);
}

TEST(PixelConvention, MaskIsWhatTheProjectedFacesOfACubeCoverPixelByPixel) {
  const TempFolder folder;
  write_scene(folder);
  const Scene scene = open_scene(folder.path());
  ASSERT_EQ(scene.views.size(), size_t(kViews));
  int wrong = 0, covered = 0;
  for (const View& view : scene.views) {
    const Image<float> mask = read_grey(view.image_path);
    const std::vector<Quad> faces = project_faces(view);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        double inside = -1e30;
        for (const Quad& face : faces) {
          inside = std::max(inside, depth_inside(face, Eigen::Vector2d(x, y)));
        }
        const bool seen = mask.at(x, y) > 0;
        covered += seen;
        wrong += seen ? inside < -1e-6 : inside > 1e-6;  // on a border both are right
      }
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(covered, 100 * kViews);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write_colmap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "datasets/synthetic/write_truth.h"

namespace sketchsplat {
namespace {

constexpr double kCorner = 0.5;  // COLMAP counts pixels from the corner of the first one

template <typename... Values>
std::string printed(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string cameras_text(const View& view) {
  const Camera& c = view.camera;
  const bool pinhole = view.lens.is_identity();
  std::string text = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  text += printed("1 %s %d %d %.12g %.12g %.12g %.12g", pinhole ? "PINHOLE" : "OPENCV", c.width,
                  c.height, c.fx, c.fy, c.cx + kCorner, c.cy + kCorner);
  const Lens::Terms& k = view.lens.terms();
  if (!pinhole) text += printed(" %.12g %.12g %.12g %.12g", k.k1, k.k2, k.p1, k.p2);
  return text + "\n";
}

std::string images_text(const std::vector<View>& views, const std::vector<TiePoint>& points) {
  std::vector<std::string> sights(views.size());
  for (size_t i = 0; i < points.size(); ++i)
    for (const TiePoint::Sight& sight : points[i].sights) {
      std::string& line = sights[sight.view];
      line += printed("%s%.3f %.3f %zu", line.empty() ? "" : " ", sight.pixel.x() + kCorner,
                      sight.pixel.y() + kCorner, i + 1);
    }
  std::string text =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "# POINTS2D[] as (X, Y, POINT3D_ID)\n";
  for (size_t k = 0; k < views.size(); ++k) {
    const Pose& pose = views[k].cam_from_world;
    Eigen::Quaterniond q(pose.rotation);
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const Eigen::Vector3d& t = pose.translation;
    text += printed("%zu %.15g %.15g %.15g %.15g %.15g %.15g %.15g 1 ", k + 1, q.w(), q.x(), q.y(),
                    q.z(), t.x(), t.y(), t.z());
    text += views[k].name + "\n" + sights[k] + "\n";
  }
  return text;
}

std::string points_text(const std::vector<View>& views, const std::vector<TiePoint>& points) {
  std::vector<int> used(views.size(), 0);  // POINTS2D of each image so far
  std::string text = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";
  for (size_t i = 0; i < points.size(); ++i) {
    const TiePoint& point = points[i];
    int rgb[3];
    for (int c = 0; c < 3; ++c)
      rgb[c] = int(255 * std::pow(std::clamp(point.color[c], 0.0f, 1.0f), 1 / 2.2f) + 0.5f);
    text += printed("%zu %.12g %.12g %.12g %d %d %d %.4f", i + 1, point.point.x(), point.point.y(),
                    point.point.z(), rgb[0], rgb[1], rgb[2], reprojection_error(point, views));
    for (const TiePoint::Sight& sight : point.sights)
      text += printed(" %d %d", sight.view + 1, used[sight.view]++);
    text += "\n";
  }
  return text;
}

}  // namespace

void write_colmap(const std::vector<View>& views, const std::vector<TiePoint>& points,
                  const std::string& folder) {
  write_text(folder + "/cameras.txt", cameras_text(views.at(0)));
  write_text(folder + "/points3D.txt", points_text(views, points));
  write_text(folder + "/images.txt", images_text(views, points));
}

}  // namespace sketchsplat

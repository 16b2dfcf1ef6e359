// SPDX-License-Identifier: MIT
#include "edges/views/convex_hull.h"

#include <opencv2/imgproc.hpp>

namespace sketchsplat {

using Eigen::Vector2d;

namespace {

double cross(const Vector2d& o, const Vector2d& a, const Vector2d& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

}  // namespace

std::vector<Vector2d> convex_hull(const std::vector<Vector2d>& places) {
  if (places.empty()) return {};
  std::vector<cv::Point2f> points;  // about the first: floats are fine enough then
  for (const Vector2d& p : places)
    points.emplace_back(float(p.x() - places[0].x()), float(p.y() - places[0].y()));
  std::vector<int> hull;
  cv::convexHull(points, hull, false, false);
  std::vector<Vector2d> out;
  for (const int k : hull) out.push_back(places[k]);
  return out;
}

std::vector<Vector2d> widened(const std::vector<Vector2d>& places, double margin) {
  std::vector<Vector2d> out;
  for (const Vector2d& p : places)
    for (int k = 0; k < 4; ++k)
      out.push_back(p + margin * Vector2d(k & 1 ? 1 : -1, k & 2 ? 1 : -1));
  return out;
}

bool is_inside(const std::vector<Vector2d>& polygon, const Vector2d& p) {
  for (size_t i = 0; i < polygon.size(); ++i)
    if (cross(polygon[i], polygon[(i + 1) % polygon.size()], p) < 0) return false;
  return !polygon.empty();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/batch/thumbnail.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "eval/metrics/prediction.h"

namespace sketchsplat {
namespace {

constexpr size_t kMost = 400;  // curves
constexpr double kSide = 100, kMargin = 3;

// Right and up on the page for somebody who looks along (-1, 2, -1.2) of the world.
Eigen::Matrix<double, 2, 3> page_from_world() {
  const Eigen::Vector3d forward = Eigen::Vector3d(-1, 2, -1.2).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix<double, 2, 3> page;
  page << right.transpose(), right.cross(forward).transpose();
  return page;
}

// Two or four control points each, the longest polygons first.
std::vector<Eigen::Matrix2Xd> drawn(const Prediction& edges) {
  const Eigen::Matrix<double, 2, 3> page = page_from_world();
  std::vector<Eigen::Matrix2Xd> curves;
  for (const auto& line : edges.lines) curves.push_back(page * line);
  for (const auto& curve : edges.curves) curves.push_back(page * curve);
  const auto length = [](const Eigen::Matrix2Xd& c) {
    return (c.rightCols(c.cols() - 1) - c.leftCols(c.cols() - 1)).colwise().norm().sum();
  };
  std::stable_sort(curves.begin(), curves.end(),
                   [&](const auto& a, const auto& b) { return length(a) > length(b); });
  if (curves.size() > kMost) curves.resize(kMost);
  return curves;
}

}  // namespace

std::string thumbnail_path(const std::string& parametric_edges) {
  const std::vector<Eigen::Matrix2Xd> curves = drawn(read_prediction(parametric_edges));
  Eigen::AlignedBox2d box;
  for (const Eigen::Matrix2Xd& curve : curves)
    for (int i = 0; i < curve.cols(); ++i) box.extend(Eigen::Vector2d(curve.col(i)));
  if (box.isEmpty()) return "";
  const double size = box.sizes().maxCoeff(), scale = (kSide - 2 * kMargin) / (size > 0 ? size : 1);
  std::string path;
  for (const Eigen::Matrix2Xd& curve : curves)
    for (int i = 0; i < curve.cols(); ++i) {
      const Eigen::Vector2d p = (curve.col(i) - box.center()) * scale;
      char text[64];
      std::snprintf(text, sizeof text, "%s%.1f %.1f",
                    i == 0             ? "M"
                    : i > 1            ? " "
                    : curve.cols() > 2 ? "C"
                                       : "L",
                    kSide / 2 + p.x() + 0.0, kSide / 2 - p.y() + 0.0);
      path += text;
    }
  return path;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <random>

#include "eval/inspect/nominal.h"
#include "sketches/graph/sketch.h"
#include "sketches/solve/covariance.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat::test {

/// Edges of a box from the origin; nodes in binary order: x is the lowest bit.
inline Sketch box(const Eigen::Vector3d& size) {
  Sketch s;
  for (int k = 0; k < 8; ++k)
    s.add_node(Eigen::Vector3d(k & 1, k >> 1 & 1, k >> 2).cwiseProduct(size));
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 8; ++k)
      if (!(k >> axis & 1)) s.add_stroke(StrokeKind::kLine, k, k | 1 << axis, {});
  return s;
}

/// A through hole along z of a box of this height: two circles.
inline void add_hole(Sketch* s, double x, double y, double height, double radius) {
  for (const double z : {0.0, height})
    s->add_stroke(StrokeKind::kCircle, -1, -1, {{x, y, z}, {0, 0, radius}});
}

/// 100 x 60 x 10 with three holes: strokes 0 to 11 are lines, 12 and 13 the first hole. No turn
/// maps it to itself.
inline Sketch plate() {
  Sketch s = box({100, 60, 10});
  add_hole(&s, 20, 15, 10, 4);
  add_hole(&s, 20, 45, 10, 4);
  add_hole(&s, 75, 25, 10, 9);
  return s;
}

/// The same standard deviation of every control point, independent; every direction determined.
inline Sketch with_sigma(Sketch s, double sigma) {
  for (int i = 0; i < s.size(); ++i) {
    const int n = 3 * num_controls(s.strokes[i].kind);
    Evidence& e = s.evidence[i];
    e.sigma = sigma;
    e.covariance = upper_triangle(sigma * sigma * Eigen::MatrixXd::Identity(n, n));
    e.determined = n;
  }
  return s;
}

/// Strokes with nodes of their own, their control points moved by chance as `with_sigma` says.
inline Sketch noisy(const Sketch& s, double sigma, std::mt19937* random) {
  std::normal_distribution<double> error(0, sigma);
  const auto move = [&](Eigen::Vector3d p) {
    for (int k = 0; k < 3; ++k) p[k] += error(*random);
    return p;
  };
  Sketch out;
  for (int i = 0; i < s.size(); ++i) {
    const Stroke& stroke = s.strokes[i];
    std::vector<Eigen::Vector3d> handles;
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      handles.push_back(move(s.handles.col(stroke.handle + h)));
    const bool closed = is_closed(stroke.kind);
    const int begin = closed ? -1 : out.add_node(move(s.nodes.col(stroke.begin)));
    const int end = closed ? -1 : out.add_node(move(s.nodes.col(stroke.end)));
    out.add_stroke(stroke.kind, begin, end, handles, s.evidence[i]);
  }
  return out;
}

/// Somewhere else, as large.
inline Similarity elsewhere() { return {1, rotation_about({0.7, -1.9, 0.4}), {300, -20, 55}}; }

}  // namespace sketchsplat::test

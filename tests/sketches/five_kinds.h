// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <random>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A bracket: line, arc and cubic share nodes (a chain with a star at node 1), circle and ellipse
/// stand alone. Every kind once, but two lines.
inline Sketch five_kinds() {
  Sketch s;
  const int a = s.add_node({0.1, 0.2, 0.3}), b = s.add_node({1.0, 0.1, 0.4});
  const int c = s.add_node({1.2, 0.9, 0.35}), d = s.add_node({0.2, 1.1, 0.5});
  s.add_stroke(StrokeKind::kLine, a, b, {}, {0.9, 40, 0.08, 1e-4, 0.95});
  s.add_stroke(StrokeKind::kArc, b, c, {{1.4, 0.45, 0.5}}, {0.75, 31, 0.11, 2e-4});
  s.add_stroke(StrokeKind::kBezier, c, d, {{0.9, 1.5, 0.2}, {0.5, 0.8, 0.9}}, {1.0, 17, 0.3, 1e-3});
  s.add_stroke(StrokeKind::kLine, d, b, {}, {0.5, 3, 0.9, 1.0 / 3});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {{0.5, 0.5, 0.6}, {0.03, -0.08, 0.2}});
  s.add_stroke(StrokeKind::kEllipse, -1, -1,
               {{0.4, 0.3, -0.2}, {0.3, 0.05, 0.1}, {-0.1, 0.2, 0.02}});
  return s;
}

/// These and an elliptic arc that goes on from the bracket.
inline Sketch all_kinds() {
  Sketch s = five_kinds();
  const int f = s.add_node({-0.5, 0.6, 0.1});
  s.add_stroke(StrokeKind::kEllipticArc, 0, f, {{-0.7, -0.1, 0.6}, {-0.5, 0.1, 0.45}},
               {0.8, 12, 0.2, 1e-4});
  return s;
}

/// The same sketch moved by scale * rotation * x + shift.
inline Sketch moved(Sketch s, double scale, const Eigen::Matrix3d& rotation,
                    const Eigen::Vector3d& shift) {
  s.nodes = (scale * (rotation * s.nodes)).colwise() + shift;
  const Eigen::Matrix3Xd old = scale * (rotation * s.handles);
  s.handles = old;
  for (const Stroke& stroke : s.strokes)
    for (int h = 0; h < (is_closed(stroke.kind) ? 1 : num_handles(stroke.kind)); ++h)
      s.handles.col(stroke.handle + h) += shift;  // all but the axes of closed curves are points
  return s;
}

/// Reproducible on every platform: the engine's numbers are fixed by the standard, distributions
/// not.
struct Random {
  std::mt19937 engine{1};
  double uniform() { return 2.0 * double(engine()) / 4294967295.0 - 1.0; }  ///< [-1, 1]
  double noise() {  ///< about normal, variance 1
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum / 2;
  }
  Eigen::Vector3d point() { return {uniform(), uniform(), uniform()}; }
  Eigen::Matrix3d rotation() {
    const Eigen::Quaterniond q(uniform(), uniform(), uniform(), uniform());
    return q.normalized().toRotationMatrix();
  }
};

/// Three cubics that go on smoothly, the second stored backwards, and a line from their end.
inline Sketch smooth_chain() {
  const Eigen::Vector3d p[4] = {{0, 0, 0}, {2, 0, 0}, {5, 1, 0}, {6, 3, 1}};
  const Eigen::Vector3d t[4] = {{1, 1, 0}, {2, -1, 0.5}, {1, 1, 1}, {0, 1, 0}};
  Sketch s;
  for (const Eigen::Vector3d& q : p) s.add_node(q);
  s.add_node({6, 3, 4});
  s.add_stroke(StrokeKind::kBezier, 0, 1, {p[0] + 0.5 * t[0], p[1] - 0.3 * t[1]});
  s.add_stroke(StrokeKind::kBezier, 2, 1, {p[2] - 1.1 * t[2], p[1] + 0.8 * t[1]});
  s.add_stroke(StrokeKind::kBezier, 2, 3, {p[2] + 0.7 * t[2], p[3] - 0.4 * t[3]});
  s.add_stroke(StrokeKind::kLine, 3, 4, {});
  return s;
}

}  // namespace sketchsplat

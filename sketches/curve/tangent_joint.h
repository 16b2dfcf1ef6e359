// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sketches/curve/curve.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A node in which an arc and a line, or two arcs, go on from one another, and nothing else ends.
struct TangentJoint {
  int node = -1;
  int arc = -1, other = -1;  ///< strokes: `other` is a line or an arc
};

/// All such joints that turn by at most `angle` [rad], of strokes of one plane, to a quarter of it:
/// arcs of several planes draw a curve of another kind. Strokes that share both nodes have none.
std::vector<TangentJoint> find_tangent_joints(const Sketch& sketch, double angle);

/// Of an arc with these control points: along its tangent in `node`, into it; not a unit vector.
template <typename T>
Vec3<T> arc_tangent(const Vec3<T>& node, const Vec3<T>& apex, const Vec3<T>& far) {
  const Vec3<T> c[3] = {node, apex, far};
  Vec3<T> p, d;
  evaluate_curve<T>(StrokeKind::kArc, c, 0, &p, &d);
  return d;
}

}  // namespace sketchsplat

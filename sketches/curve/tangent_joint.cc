// SPDX-License-Identifier: MIT
#include "sketches/curve/tangent_joint.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace sketchsplat {
namespace {

// Unit vectors of a line or an arc in its node.
struct Way {
  Eigen::Vector3d along;   // into it
  Eigen::Vector3d normal;  // of an arc's plane; of a line zero
};

Way way_of(const Sketch& sketch, int stroke, int node) {
  const Stroke& s = sketch.strokes[stroke];
  const Eigen::Vector3d along = tangent_out(sketch, stroke, node);
  if (s.kind == StrokeKind::kLine) return {along, Eigen::Vector3d::Zero()};
  const Eigen::Vector3d chord = sketch.nodes.col(other_end(s, node)) - sketch.nodes.col(node);
  return {along, along.cross(chord).normalized()};
}

// Does b go on from a, and both in one plane as far as it takes to say so?
bool go_on(const Way& a, const Way& b, double angle) {
  constexpr double kPlanes = 0.25;  // of the angle, by which one leaves the other's plane
  const double out = std::sin(kPlanes * angle);
  return std::atan2(a.along.cross(b.along).norm(), -a.along.dot(b.along)) <= angle &&
         std::abs(a.normal.dot(b.along)) <= out && std::abs(b.normal.dot(a.along)) <= out &&
         (b.normal.isZero() || a.normal.cross(b.normal).norm() <= std::sin(angle));
}

}  // namespace

std::vector<TangentJoint> find_tangent_joints(const Sketch& sketch, double angle) {
  std::vector<std::vector<int>> ends(sketch.nodes.cols());
  for (int i = 0; i < sketch.size(); ++i)
    if (const Stroke& s = sketch.strokes[i]; !is_closed(s.kind))
      for (const int node : {s.begin, s.end}) ends[node].push_back(i);
  const auto is_arc = [&](int i) { return sketch.strokes[i].kind == StrokeKind::kArc; };
  std::vector<TangentJoint> joints;
  for (int n = 0; n < int(ends.size()); ++n) {
    if (ends[n].size() != 2) continue;
    int a = ends[n][0], b = ends[n][1];
    if (!is_arc(a)) std::swap(a, b);
    if (!is_arc(a) || !(is_arc(b) || sketch.strokes[b].kind == StrokeKind::kLine)) continue;
    const int far_a = other_end(sketch.strokes[a], n), far_b = other_end(sketch.strokes[b], n);
    if (far_a == far_b || far_a == n || far_b == n) continue;
    if (go_on(way_of(sketch, a, n), way_of(sketch, b, n), angle)) joints.push_back({n, a, b});
  }
  return joints;
}

}  // namespace sketchsplat

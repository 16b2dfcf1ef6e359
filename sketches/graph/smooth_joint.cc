// SPDX-License-Identifier: MIT
#include "sketches/graph/smooth_joint.h"

#include <Eigen/Geometry>
#include <cmath>

namespace sketchsplat {
namespace {

TangentEnd tangent_end(const Sketch& sketch, int stroke, bool at_end) {
  const Stroke& s = sketch.strokes[stroke];
  if (s.kind == StrokeKind::kLine) return {stroke, at_end, true, at_end ? s.begin : s.end};
  return {stroke, at_end, false, s.handle + (at_end ? 1 : 0)};
}

}  // namespace

std::vector<SmoothJoint> find_smooth_joints(const Sketch& sketch, double smooth_angle) {
  std::vector<std::vector<TangentEnd>> ends(sketch.nodes.cols());
  for (int i = 0; i < sketch.size(); ++i)
    if (const Stroke& s = sketch.strokes[i]; !is_closed(s.kind)) {
      ends[s.begin].push_back(tangent_end(sketch, i, false));
      ends[s.end].push_back(tangent_end(sketch, i, true));
    }
  const auto kind = [&](const TangentEnd& e) { return sketch.strokes[e.stroke].kind; };
  const auto is_plain = [&](const TangentEnd& e) {
    return kind(e) == StrokeKind::kLine || kind(e) == StrokeKind::kBezier;
  };
  std::vector<SmoothJoint> joints;
  for (int n = 0; n < int(ends.size()); ++n) {
    if (ends[n].size() != 2) continue;
    const TangentEnd &a = ends[n][0], &b = ends[n][1];
    if (a.stroke == b.stroke || !is_plain(a) || !is_plain(b)) continue;
    if (kind(a) == StrokeKind::kLine && kind(b) == StrokeKind::kLine) continue;
    const auto tangent = [&](const TangentEnd& e) -> Eigen::Vector3d {
      return (e.is_node ? sketch.nodes : sketch.handles).col(e.column) - sketch.nodes.col(n);
    };
    const Eigen::Vector3d u = tangent(a), v = tangent(b);
    if (!(u.norm() > 0 && v.norm() > 0)) continue;
    const double angle = std::atan2(u.cross(v).norm(), -u.dot(v));
    if (angle <= smooth_angle) joints.push_back({n, a, b, angle});
  }
  return joints;
}

}  // namespace sketchsplat

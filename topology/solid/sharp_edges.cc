// SPDX-License-Identifier: MIT
#include "topology/solid/sharp_edges.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_chain.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// Where a line runs smoothly into an arc is known to a few pixels along them, so that round faces
// that touch others come out at an angle of less than this to them.
constexpr double kTouchingDeg = 30;
// A curve in which two faces meet has no corners where nothing else begins. Cubics that were fitted
// one by one meet at less than this.
constexpr double kCubicsDeg = 30;
constexpr double kSameHandles = 1e-6;  // relative

// Of every edge, whether two faces meet in it, and at an angle: not one, nor two that touch, one of
// them round.
std::vector<bool> sharp(const Solid& solid) {
  std::map<int, std::vector<const SolidFace*>> sides;
  for (const SolidFace& face : solid.faces)
    for (const Loop& loop : face.loops)
      for (const LoopStroke& s : loop) sides[s.stroke].push_back(&face);
  const auto outwards = [&](const SolidFace& face, const Vector3d& p) -> Vector3d {
    return (face.reversed ? -1 : 1) * surface_normal(solid.surfaces[face.surface], p);
  };
  std::vector<bool> out(solid.inferred.size());
  Vector3d p, d;
  for (const auto& [stroke, faces] : sides) {
    if (faces.size() != 2) continue;
    const SolidFace &one = *faces.front(), &other = *faces.back();
    double most = 0;
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      evaluate_stroke(solid.edges, stroke, t, &p, &d);
      const Vector3d a = outwards(one, p), b = outwards(other, p);
      most = std::max(most, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI);
    }
    const bool flat = solid.surfaces[one.surface].kind == SurfaceKind::kPlane &&
                      solid.surfaces[other.surface].kind == SurfaceKind::kPlane;
    out[stroke] = flat || most >= kTouchingDeg;
  }
  return out;
}

// Does a stroke of the sketch, or one after another, run along all of an edge?
bool is_there(const Sketch& sketch, const Sketch& edges, int edge, double reach) {
  constexpr int kPlaces = 8;
  Vector3d p, d;
  for (int i = 1; i < kPlaces; ++i) {
    evaluate_stroke(edges, edge, double(i) / kPlaces, &p, &d);
    bool near = false;
    for (int s = 0; s < sketch.size() && !near; ++s)
      near = distance_to_stroke(sketch, s, p).distance <= reach;
    if (!near) return false;
  }
  return true;
}

}  // namespace

SharpEdges sharp_edges(const SolidSearch& found, bool with_inferred) {
  Solid solid = *found.solid;
  solid.edges = found.as_seen;
  smooth_joints(&solid.edges, kCubicsDeg);
  SharpEdges out;
  out.bent = !solid.edges.handles.isApprox(found.as_seen.handles, kSameHandles);
  const std::vector<bool> is_sharp = sharp(solid);
  std::vector<bool> keep;
  std::vector<int> index;
  for (size_t e = 0; e < solid.inferred.size(); ++e) {
    keep.push_back(!solid.inferred[e] || (with_inferred && is_sharp[e]));
    index.push_back(keep.back() ? int(out.inferred.size()) : -1);
    if (keep.back()) out.inferred.push_back(solid.inferred[e]);
  }
  out.sketch = keep_strokes(solid.edges, keep);
  for (const int e : found.edge_of) out.now.push_back(e < 0 ? -1 : index[e]);
  return out;
}

SharpEdges with_sure_edges(const Sketch& sketch, const SolidSearch& found, double reach) {
  SharpEdges out;
  out.sketch = sketch;
  out.inferred.assign(sketch.size(), false);
  for (int s = 0; s < sketch.size(); ++s) out.now.push_back(s);
  Solid shell = *found.shell;
  shell.edges = found.as_seen;
  const std::vector<bool> is_sharp = sharp(shell);
  const auto node_at = [&](int node) {
    if (node < 0) return -1;
    const Vector3d place = shell.edges.nodes.col(node);
    Eigen::Index nearest = 0;
    if (out.sketch.nodes.cols() > 0 &&
        (out.sketch.nodes.colwise() - place).colwise().norm().minCoeff(&nearest) <= reach)
      return int(nearest);
    return out.sketch.add_node(place);
  };
  for (int e = 0; e < shell.edges.size(); ++e) {
    if (!shell.inferred[e] || !is_sharp[e] || is_there(sketch, shell.edges, e, reach)) continue;
    const Stroke& edge = shell.edges.strokes[e];
    std::vector<Vector3d> handles;
    for (int h = 0; h < num_handles(edge.kind); ++h)
      handles.push_back(shell.edges.handles.col(edge.handle + h));
    const int begin = node_at(edge.begin), end = node_at(edge.end);
    if (begin >= 0 && begin == end) continue;
    out.sketch.add_stroke(edge.kind, begin, end, handles);
    out.inferred.push_back(true);
  }
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "eval/inspect/nominal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "datasets/types/errors.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "topology/faces/planar_faces.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-4;      // [extents] centres, radii and planes that are one
constexpr double kSmoothDeg = 0.5;  // turn at a joint within an edge
constexpr double kPlane = 5e-4;     // [extents] flatness of a face

double cosine(double degrees) { return std::cos(degrees * M_PI / 180); }

struct Conic {
  Vector3d centre, normal;
  double size = 0;  // radius, or length of the larger semi-axis
};
bool conic_of(const Sketch& sketch, int s, Conic* out) {
  const StrokeKind kind = sketch.strokes[s].kind;
  if (kind == StrokeKind::kArc || kind == StrokeKind::kCircle) {
    const CircleParameters c = circle_parameters(sketch, s);
    *out = {c.centre, c.normal, c.radius};
    return !c.straight;
  }
  if (kind != StrokeKind::kEllipticArc) return false;
  const EllipticArcParameters e = elliptic_arc_parameters(control_points(sketch, s));
  const EllipseAxes axes = principal_axes(e.p, e.q);
  *out = {e.centre, e.p.cross(e.q).stableNormalized(),
          std::max(axes.major.norm(), axes.minor.norm())};
  return !e.straight;
}

// Does one of two strokes that meet in a node, and nothing else there, go on as the other?
bool continues(const Sketch& sketch, int a, int b, int node, double same) {
  if (sketch.strokes[a].kind != sketch.strokes[b].kind) return false;
  if (tangent_out(sketch, a, node).dot(tangent_out(sketch, b, node)) > -cosine(kSmoothDeg))
    return false;
  Conic ca, cb;
  const bool is_a = conic_of(sketch, a, &ca), is_b = conic_of(sketch, b, &cb);
  if (!is_a || !is_b) return is_a == is_b;
  return (ca.centre - cb.centre).norm() < same && std::abs(ca.size - cb.size) < same &&
         std::abs(ca.normal.dot(cb.normal)) > cosine(kSmoothDeg);
}

class Grouper {
 public:
  Grouper(const Sketch& sketch, double extent)
      : sketch_(sketch), same_(kSame * extent), at_(sketch.nodes.cols()), done_(sketch.size()) {
    for (int s = 0; s < sketch.size(); ++s) {
      if (is_closed(sketch.strokes[s].kind)) continue;
      at_[sketch.strokes[s].begin].push_back(s);
      at_[sketch.strokes[s].end].push_back(s);
    }
  }

  // The edge of a stroke; empty if it is part of an earlier one.
  std::vector<int> edge_from(int stroke) {
    if (done_[stroke]) return {};
    done_[stroke] = true;
    std::vector<int> ahead = {stroke};
    if (is_closed(sketch_.strokes[stroke].kind)) return ahead;
    follow(stroke, sketch_.strokes[stroke].end, &ahead);
    std::vector<int> back;
    follow(stroke, sketch_.strokes[stroke].begin, &back);
    ahead.insert(ahead.begin(), back.rbegin(), back.rend());
    return ahead;
  }

 private:
  void follow(int stroke, int node, std::vector<int>* chain) {
    while (at_[node].size() == 2) {
      const int next = at_[node][at_[node][0] == stroke ? 1 : 0];
      if (done_[next] || !continues(sketch_, stroke, next, node, same_)) return;
      done_[next] = true;
      chain->push_back(next);
      const Stroke& s = sketch_.strokes[next];
      node = s.begin == node ? s.end : s.begin;
      stroke = next;
    }
  }

  const Sketch& sketch_;
  double same_;
  std::vector<std::vector<int>> at_;  // strokes that end in a node
  std::vector<bool> done_;
};

// A full turn of arcs is a circle.
StrokeKind kind_of(const Sketch& sketch, const std::vector<int>& strokes) {
  const StrokeKind kind = sketch.strokes[strokes[0]].kind;
  if (kind != StrokeKind::kArc && kind != StrokeKind::kEllipticArc) return kind;
  double turn = 0;
  for (const int s : strokes)
    turn += kind == StrokeKind::kArc
                ? circle_parameters(sketch, s).angle
                : 2 * elliptic_arc_parameters(control_points(sketch, s)).half_angle;
  if (turn < 2 * M_PI * 0.999) return kind;
  return kind == StrokeKind::kArc ? StrokeKind::kCircle : StrokeKind::kEllipse;
}

std::vector<NominalPlane> planes_of(const Nominal& nominal) {
  std::vector<NominalPlane> planes;
  for (const PlanarFace& face : planar_faces(nominal.sketch, {kPlane})) {
    const auto same = [&](const NominalPlane& p) {
      return std::abs(p.normal.dot(face.normal)) > cosine(0.05) &&
             std::abs((face.point - p.point).dot(p.normal)) < kSame * nominal.extent;
    };
    auto plane = std::find_if(planes.begin(), planes.end(), same);
    if (plane == planes.end()) {
      planes.push_back({"P" + std::to_string(planes.size() + 1), face.point, face.normal, {}});
      plane = planes.end() - 1;
    }
    std::set<int> edges(plane->edges.begin(), plane->edges.end());
    const auto add = [&](const Loop& loop) {
      for (const LoopStroke& s : loop) edges.insert(nominal.edge_of_stroke[s.stroke]);
    };
    add(face.outer);
    for (const Loop& hole : face.holes) add(hole);
    plane->edges.assign(edges.begin(), edges.end());
  }
  return planes;
}

template <typename List>
int find_name(const List& list, const std::string& name) {
  for (size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return int(i);
  return -1;
}

}  // namespace

Nominal make_nominal(const Sketch& sketch, const std::string& name) {
  if (sketch.size() == 0) throw InputError(name, "a part with edges", "none");
  Nominal out;
  out.name = name;
  out.sketch = sketch;
  out.extent = largest_extent(sketch);
  out.edge_of_stroke.resize(sketch.size());
  Grouper grouper(sketch, out.extent);
  for (int s = 0; s < sketch.size(); ++s) {
    NominalEdge edge;
    edge.strokes = grouper.edge_from(s);
    if (edge.strokes.empty()) continue;
    edge.name = "E" + std::to_string(out.edges.size() + 1);
    edge.kind = kind_of(sketch, edge.strokes);
    for (const int k : edge.strokes) {
      edge.length += stroke_length(sketch, k);
      out.edge_of_stroke[k] = int(out.edges.size());
    }
    out.edges.push_back(edge);
  }
  out.planes = planes_of(out);
  return out;
}

bool circle_of(const Nominal& nominal, int edge, NominalCircle* circle) {
  const NominalEdge& e = nominal.edges[edge];
  if (e.kind != StrokeKind::kArc && e.kind != StrokeKind::kCircle) return false;
  circle->angle = 0;
  for (const int s : e.strokes) {
    const CircleParameters c = circle_parameters(nominal.sketch, s);
    if (c.straight) return false;
    circle->centre = c.centre, circle->normal = c.normal, circle->radius = c.radius;
    circle->angle = std::min(2 * M_PI, circle->angle + c.angle);
  }
  return true;
}

int find_edge(const Nominal& nominal, const std::string& name) {
  return find_name(nominal.edges, name);
}

int find_plane(const Nominal& nominal, const std::string& name) {
  return find_name(nominal.planes, name);
}

}  // namespace sketchsplat

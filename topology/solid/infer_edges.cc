// SPDX-License-Identifier: MIT
#include "topology/solid/infer_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "topology/solid/circle_rim.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kBend = 0.1, kAlike = 0.998;  // of corners: sine; cosine

class Inference {
 public:
  Inference(const Sketch& seen, const Sketch& sketch, const std::vector<SurfaceStrokes>& surfaces,
            double tolerance, double slide)
      : seen_(seen.size()),
        degree_(node_degrees(sketch)),
        sketch_(sketch),
        surfaces_(surfaces),
        tolerance_(tolerance),
        slide_(slide) {
    const std::vector<int> seen_degree = node_degrees(seen);
    std::copy(seen_degree.begin(), seen_degree.end(), degree_.begin());
    for (const Stroke& s : sketch.strokes)
      if (!is_closed(s.kind)) joined_.insert(std::minmax(s.begin, s.end));
    for (const SurfaceStrokes& s : surfaces) {
      std::set<int> nodes;
      for (const int stroke : s.strokes)
        if (!is_closed(sketch.strokes[stroke].kind))
          nodes.insert({sketch.strokes[stroke].begin, sketch.strokes[stroke].end});
      nodes_.emplace_back(nodes.begin(), nodes.end());
    }
  }

  std::vector<ImpliedStroke> find() {
    for (size_t i = 0; i < surfaces_.size(); ++i)
      if (surfaces_[i].surface.kind != SurfaceKind::kPlane) add_rulings(int(i));
    for (size_t i = 0; i < surfaces_.size(); ++i)
      for (size_t k = i + 1; k < surfaces_.size(); ++k)
        if (surfaces_[i].surface.kind == SurfaceKind::kPlane &&
            surfaces_[k].surface.kind == SurfaceKind::kPlane)
          add_meeting(int(i), int(k));
    add_twin_corners();
    std::vector<ImpliedStroke> out;
    for (const auto& [ends, smooth] : lines_)
      out.push_back(
          {StrokeKind::kLine, ends.first, ends.second, {}, smooth, twins_.count(ends) > 0});
    add_rims(&out);
    add_arcs(&out);
    return out;
  }

 private:
  void add_rulings(int index) {
    const Layout layout(surfaces_[index].surface);
    const std::vector<int>& nodes = nodes_[index];
    // Off by this along the arc, a line that is tangent to it leaves it by a tolerance.
    const double wide =
        std::max(slide_, std::sqrt(2 * surfaces_[index].surface.radius * slide_ / 9));
    std::vector<bool> done(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (done[i]) continue;
      const double u = layout.flat(Vector3d(sketch_.nodes.col(nodes[i]))).x();
      std::vector<std::pair<double, int>> along;
      for (size_t k = i; k < nodes.size(); ++k) {
        const Eigen::Vector2d flat = layout.flat(Vector3d(sketch_.nodes.col(nodes[k])));
        double off = flat.x() - u;
        off -= layout.period() * std::round(off / layout.period());
        const bool slides = is_smooth(nodes[i]) && is_smooth(nodes[k]);
        if (std::abs(off) > (slides ? wide : slide_)) continue;
        done[k] = true;
        along.emplace_back(flat.y(), nodes[k]);
      }
      add_neighbours(&along, true);
    }
  }

  // Do two strokes go on from one another there?
  bool is_smooth(int node) const {
    const std::vector<Vector3d> away = away_from(node);
    return away.size() == 2 && away[0].dot(away[1]) < 0 && away[0].cross(away[1]).norm() < kBend;
  }

  // Tangents of the strokes that are seen, out of a node.
  std::vector<Vector3d> away_from(int node) const {
    std::vector<Vector3d> away;
    for (int s = 0; s < seen_; ++s)
      if (sketch_.strokes[s].begin == node || sketch_.strokes[s].end == node)
        away.push_back(tangent_out(sketch_, s, node));
    return away;
  }

  void add_meeting(int a, int b) {
    const Surface &p = surfaces_[a].surface, &q = surfaces_[b].surface;
    const Vector3d direction = p.axis.cross(q.axis);
    if (direction.norm() < 0.02) return;  // about a degree: where they meet is not known
    std::vector<std::pair<double, int>> along;
    std::vector<int> nodes;
    std::set_union(nodes_[a].begin(), nodes_[a].end(), nodes_[b].begin(), nodes_[b].end(),
                   std::back_inserter(nodes));
    for (const int node : nodes) {
      const Vector3d place = sketch_.nodes.col(node);
      if (std::abs(surface_distance(p, place)) <= tolerance_ &&
          std::abs(surface_distance(q, place)) <= tolerance_)
        along.emplace_back(direction.normalized().dot(place), node);
    }
    add_neighbours(&along, false);
  }

  // Two corners that lack their third edge, at the two ends of it: the same two directions leave
  // both, and the line between them is square to these.
  void add_twin_corners() {
    std::vector<Corner> corners;
    for (int n = 0; n < int(degree_.size()); ++n)
      if (degree_[n] == 2) add_corner(n, &corners);
    for (size_t i = 0; i < corners.size(); ++i)
      for (const double side : {-1.0, 1.0}) {
        const int twin = nearest_twin(corners, int(i), side);
        if (twin <= int(i)) continue;
        const double back = corners[i].normal.dot(corners[twin].normal) > 0 ? -side : side;
        if (nearest_twin(corners, twin, back) == int(i))
          add_twin(std::minmax(corners[i].node, corners[twin].node));
      }
  }
  void add_twin(const std::pair<int, int>& ends) {
    if (joined_.count(ends)) return;
    lines_.emplace(ends, false);
    twins_.insert(ends);
  }
  struct Corner {
    int node;
    Vector3d a, b, normal;
  };
  void add_corner(int node, std::vector<Corner>* corners) const {
    const std::vector<Vector3d> away = away_from(node);
    if (away.size() != 2) return;
    const Vector3d normal = away[0].cross(away[1]);
    if (normal.norm() > kBend) corners->push_back({node, away[0], away[1], normal.normalized()});
  }
  // The nearest corner along the normal of another one's, on one side; -1 if there is none.
  int nearest_twin(const std::vector<Corner>& corners, int index, double side) const {
    const Corner& c = corners[index];
    int best = -1;
    double nearest = HUGE_VAL;
    for (int k = 0; k < int(corners.size()); ++k) {
      const Corner& o = corners[k];
      const Vector3d between = sketch_.nodes.col(o.node) - sketch_.nodes.col(c.node);
      const double along = side * between.dot(c.normal);
      if (k == index || along <= 4 * tolerance_ || along >= nearest) continue;
      if (between.cross(c.normal).norm() > 3 * tolerance_) continue;
      const bool alike = (std::min(c.a.dot(o.a), c.b.dot(o.b)) > kAlike) ||
                         (std::min(c.a.dot(o.b), c.b.dot(o.a)) > kAlike);
      if (!alike) continue;
      nearest = along;
      best = k;
    }
    return best;
  }

  // Between loose ends of arcs of one circle.
  void add_arcs(std::vector<ImpliedStroke>* out) const {
    std::vector<LooseEnd> loose;
    std::set<std::pair<int, int>> there;
    for (int s = 0; s < sketch_.size(); ++s) {
      const Stroke& stroke = sketch_.strokes[s];
      if (stroke.kind != StrokeKind::kArc) continue;
      if (s >= seen_) there.insert(std::minmax(stroke.begin, stroke.end));
      const CircleParameters circle = circle_parameters(sketch_, s);
      if (s >= seen_ || circle.straight) continue;
      if (degree_[stroke.begin] == 1) loose.push_back({stroke.begin, circle, -1});
      if (degree_[stroke.end] == 1) loose.push_back({stroke.end, circle, 1});
    }
    for (const LooseEnd& end : loose) {
      const LooseEnd* next = next_end(loose, end);
      if (!next || !(next_end(loose, *next) == &end)) continue;
      if (!there.insert(std::minmax(end.node, next->node)).second) continue;
      const double half = angle_to(end, *next) / 2;
      const Vector3d from = sketch_.nodes.col(end.node) - end.circle.centre;
      const Vector3d apex =
          end.circle.centre + Eigen::AngleAxisd(end.sense * half, end.circle.normal) * from;
      out->push_back({StrokeKind::kArc, end.node, next->node, {apex}, false});
    }
  }
  // An end of an arc that nothing goes on from; its circle goes on in this sense about its normal.
  struct LooseEnd {
    int node;
    CircleParameters circle;
    int sense;
  };
  // On from an end to another one of its circle [rad], in (0, 2 pi).
  double angle_to(const LooseEnd& end, const LooseEnd& other) const {
    const Vector3d a = sketch_.nodes.col(end.node) - end.circle.centre,
                   b = sketch_.nodes.col(other.node) - end.circle.centre;
    const double angle = end.sense * std::atan2(end.circle.normal.dot(a.cross(b)), a.dot(b));
    return angle > 0 ? angle : angle + 2 * M_PI;
  }
  // The first one that looks back along the same circle.
  const LooseEnd* next_end(const std::vector<LooseEnd>& loose, const LooseEnd& end) const {
    const LooseEnd* best = nullptr;
    for (const LooseEnd& other : loose) {
      const CircleParameters &a = end.circle, &b = other.circle;
      const double turn = a.normal.dot(b.normal);
      if (&other == &end || turn * end.sense * other.sense > -0.999) continue;
      if ((a.centre - b.centre).norm() > 2 * tolerance_ ||
          std::abs(a.radius - b.radius) > 2 * tolerance_)
        continue;
      if (!best || angle_to(end, other) < angle_to(end, *best)) best = &other;
    }
    return best;
  }

  void add_rims(std::vector<ImpliedStroke>* out) const {
    for (int s = 0; s < seen_; ++s) {
      if (sketch_.strokes[s].kind != StrokeKind::kCircle || has_twin(s)) continue;
      const ControlPoints rim = control_points(sketch_, s);
      const Vector3d axis = rim.p[1].normalized();
      for (const SurfaceStrokes& plane : surfaces_) {
        if (plane.surface.kind != SurfaceKind::kPlane) continue;
        if (std::abs(plane.surface.axis.dot(axis)) < 0.999) continue;
        const double along = (plane.surface.origin - rim.p[0]).dot(plane.surface.axis) /
                             axis.dot(plane.surface.axis);
        if (std::abs(along) > 4 * tolerance_)
          out->push_back({StrokeKind::kCircle, -1, -1, {rim.p[0] + along * axis, rim.p[1]}, false});
      }
    }
  }

  // Is there another circle of its radius about its axis?
  bool has_twin(int stroke) const {
    const std::optional<CircleRim> own = circle_rim(sketch_, stroke, tolerance_);
    for (int s = 0; s < sketch_.size(); ++s) {
      if (s == stroke || sketch_.strokes[s].kind != StrokeKind::kCircle) continue;
      const std::optional<CircleRim> rim = circle_rim(sketch_, s, tolerance_);
      if (coaxial(*own, *rim, tolerance_) && std::abs(own->radius - rim->radius) <= 2 * tolerance_)
        return true;
    }
    return false;
  }

  void add_neighbours(std::vector<std::pair<double, int>>* along, bool smooth) {
    std::sort(along->begin(), along->end());
    for (size_t i = 0; i + 1 < along->size(); ++i) {
      const auto [z0, p] = (*along)[i];
      const auto [z1, q] = (*along)[i + 1];
      if (z1 - z0 <= 4 * tolerance_ || degree_[p] > 2 || degree_[q] > 2) continue;
      if (joined_.count(std::minmax(p, q))) continue;
      bool& known = lines_.emplace(std::minmax(p, q), false).first->second;
      known = known || smooth;
    }
  }

  int seen_;  // strokes
  std::vector<int> degree_;
  const Sketch& sketch_;
  const std::vector<SurfaceStrokes>& surfaces_;
  double tolerance_, slide_;
  std::set<std::pair<int, int>> joined_;
  std::vector<std::vector<int>> nodes_;        // of every surface, ascending
  std::map<std::pair<int, int>, bool> lines_;  // are they smooth?
  std::set<std::pair<int, int>> twins_;
};

}  // namespace

std::vector<ImpliedStroke> implied_strokes(const Sketch& seen, const Sketch& completed,
                                           const std::vector<SurfaceStrokes>& surfaces,
                                           double tolerance, double slide) {
  return Inference(seen, completed, surfaces, tolerance, slide).find();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "topology/solid/infer_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

class Inference {
 public:
  Inference(const Sketch& seen, const Sketch& sketch, const std::vector<SurfaceStrokes>& surfaces,
            double tolerance)
      : seen_(seen.size()),
        degree_(node_degrees(seen)),
        sketch_(sketch),
        surfaces_(surfaces),
        tolerance_(tolerance) {
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
    std::vector<ImpliedStroke> out;
    for (const auto& [ends, smooth] : lines_)
      out.push_back({StrokeKind::kLine, ends.first, ends.second, {}, smooth});
    add_rims(&out);
    return out;
  }

 private:
  void add_rulings(int index) {
    const Layout layout(surfaces_[index].surface);
    const std::vector<int>& nodes = nodes_[index];
    std::vector<bool> done(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (done[i]) continue;
      const double u = layout.flat(Vector3d(sketch_.nodes.col(nodes[i]))).x();
      std::vector<std::pair<double, int>> along;
      for (size_t k = i; k < nodes.size(); ++k) {
        const Eigen::Vector2d flat = layout.flat(Vector3d(sketch_.nodes.col(nodes[k])));
        double off = flat.x() - u;
        off -= layout.period() * std::round(off / layout.period());
        if (std::abs(off) > 3 * tolerance_) continue;
        done[k] = true;
        along.emplace_back(flat.y(), nodes[k]);
      }
      add_neighbours(&along, true);
    }
  }

  void add_meeting(int a, int b) {
    const Surface &p = surfaces_[a].surface, &q = surfaces_[b].surface;
    const Vector3d direction = p.axis.cross(q.axis);
    if (direction.norm() < 0.02) return;  // about a degree: where they meet is not known
    std::vector<std::pair<double, int>> along;
    for (const int node : nodes_[a])
      if (std::binary_search(nodes_[b].begin(), nodes_[b].end(), node))
        along.emplace_back(direction.normalized().dot(sketch_.nodes.col(node)), node);
    add_neighbours(&along, false);
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
    const ControlPoints a = control_points(sketch_, stroke);
    const Vector3d axis = a.p[1].normalized();
    for (int s = 0; s < sketch_.size(); ++s) {
      if (s == stroke || sketch_.strokes[s].kind != StrokeKind::kCircle) continue;
      const ControlPoints b = control_points(sketch_, s);
      if (axis.cross(b.p[0] - a.p[0]).norm() <= 2 * tolerance_ &&
          std::abs(a.p[1].norm() - b.p[1].norm()) <= 2 * tolerance_)
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
  double tolerance_;
  std::set<std::pair<int, int>> joined_;
  std::vector<std::vector<int>> nodes_;  // of every surface, ascending
  std::map<std::pair<int, int>, bool> lines_;
};

}  // namespace

std::vector<ImpliedStroke> implied_strokes(const Sketch& seen, const Sketch& completed,
                                           const std::vector<SurfaceStrokes>& surfaces,
                                           double tolerance) {
  return Inference(seen, completed, surfaces, tolerance).find();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "topology/solid/cells.h"
#include "topology/solid/complete.h"
#include "topology/solid/infer_edges.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

struct PlanarLoop {
  Loop loop;
  Vector3d normal;
};

Vector3d point_of(const Sketch& sketch, int stroke, double t) {
  Vector3d position, derivative;
  evaluate_stroke(sketch, stroke, t, &position, &derivative);
  return position;
}

class Copier {
 public:
  Copier(const std::vector<bool>& left, double tolerance, Completed* all)
      : seen_(all->seen),
        degree_(node_degrees(seen_)),
        left_(left),
        tolerance_(tolerance),
        all_(all) {
    for (const Stroke& s : all->sketch.strokes)
      if (!is_closed(s.kind)) joined_.insert(std::minmax(s.begin, s.end));
  }

  bool run() {
    bool copied = false;
    for (const PlanarLoop& loop : loops())
      for (const double depth : depths(loop)) {
        copy(loop, depth);
        copied = true;
      }
    return copied;
  }

 private:
  std::vector<PlanarLoop> loops() const {
    std::map<std::vector<int>, PlanarLoop> out;
    for (int i = 0; i < int(all_->surfaces.size()); ++i) {
      const SurfaceStrokes& plane = all_->surfaces[i];
      if (plane.surface.kind != SurfaceKind::kPlane) continue;
      for (const Cell& cell : cells_of(all_->sketch, all_->polylines, plane, i))
        for (const Loop& loop : cell.loops) {
          std::vector<int> strokes;
          for (const LoopStroke& s : loop) strokes.push_back(s.stroke);
          std::sort(strokes.begin(), strokes.end());
          const bool all_left = std::all_of(strokes.begin(), strokes.end(), [&](int s) {
            return s < seen_.size() && left_[s] && !is_closed(seen_.strokes[s].kind);
          });
          if (all_left) out.emplace(strokes, PlanarLoop{loop, plane.surface.axis});
        }
    }
    std::vector<PlanarLoop> list;
    for (auto& [strokes, loop] : out) list.push_back(std::move(loop));
    return list;
  }

  struct Told {
    double height, weight;
    bool loose;  // by the end of a stroke that nothing else ends in: it may go on unseen
  };

  // Heights over the loop that strokes tell, each once.
  std::vector<double> depths(const PlanarLoop& loop) const {
    std::set<int> own, nodes;
    for (const LoopStroke& s : loop.loop) {
      own.insert(s.stroke);
      nodes.insert({seen_.strokes[s.stroke].begin, seen_.strokes[s.stroke].end});
    }
    std::vector<Told> told;
    for (int s = 0; s < seen_.size(); ++s) {
      if (!left_[s] || own.count(s) || is_closed(seen_.strokes[s].kind)) continue;
      const Stroke& stroke = seen_.strokes[s];
      for (const auto& [here, there] :
           {std::pair(stroke.begin, stroke.end), std::pair(stroke.end, stroke.begin)})
        if (nodes.count(here)) {
          const Vector3d to = seen_.nodes.col(there) - seen_.nodes.col(here);
          const double height = to.dot(loop.normal);
          if (std::abs(height) > 0.999 * to.norm())
            told.push_back({height, tolerance_, degree_[there] == 1});
        }
      const double height = height_below(loop, s);
      if (!std::isnan(height)) told.push_back({height, stroke_length(seen_, s), false});
    }
    return clusters(told);
  }

  // Of a stroke that runs along the loop at one height, or NaN.
  double height_below(const PlanarLoop& loop, int stroke) const {
    constexpr int kPlaces = 16;
    const double plane = loop.normal.dot(seen_.nodes.col(seen_.strokes[loop.loop[0].stroke].begin));
    double low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
    for (int i = 0; i <= kPlaces; ++i) {
      const Vector3d p = point_of(seen_, stroke, double(i) / kPlaces);
      const double height = loop.normal.dot(p) - plane;
      double nearest = HUGE_VAL;
      for (const LoopStroke& s : loop.loop)
        nearest = std::min(nearest,
                           distance_to_stroke(seen_, s.stroke, p - height * loop.normal).distance);
      if (nearest > 3 * tolerance_) return NAN;
      low = std::min(low, height);
      high = std::max(high, height);
      sum += height;
    }
    const bool level =
        high - low <= 2 * tolerance_ && std::min(std::abs(low), std::abs(high)) > 4 * tolerance_;
    return level ? sum / (kPlaces + 1) : NAN;
  }

  // One loose end tells nothing, two that agree do.
  std::vector<double> clusters(std::vector<Told> told) const {
    std::sort(told.begin(), told.end(),
              [](const Told& a, const Told& b) { return a.height < b.height; });
    std::vector<double> out;
    for (size_t i = 0; i < told.size();) {
      double weight = 0, sum = 0;
      int ends = 0;
      const double first = told[i].height;
      for (; i < told.size() && told[i].height - first <= 2 * tolerance_; ++i) {
        weight += told[i].weight;
        sum += told[i].weight * told[i].height;
        ends += told[i].loose ? 1 : 2;
      }
      if (ends > 1) out.push_back(sum / weight);
    }
    return out;
  }

  void copy(const PlanarLoop& loop, double depth) {
    const Vector3d shift = depth * loop.normal;
    std::map<int, int> moved;
    for (size_t i = 0; i < loop.loop.size(); ++i) {
      const LoopStroke &s = loop.loop[i],
                       &before = loop.loop[(i + loop.loop.size() - 1) % loop.loop.size()];
      const int node = s.forward ? seen_.strokes[s.stroke].begin : seen_.strokes[s.stroke].end;
      moved[node] = node_at(seen_.nodes.col(node) + shift);
      const double bend =
          tangent_out(seen_, s.stroke, node).dot(tangent_out(seen_, before.stroke, node));
      connect(node, moved[node], bend < -0.996 ? EdgeOrigin::kSmooth : EdgeOrigin::kCopy);
    }
    for (const LoopStroke& s : loop.loop) {
      const Stroke& stroke = seen_.strokes[s.stroke];
      const int begin = moved[stroke.begin], end = moved[stroke.end];
      if (stroke.kind == StrokeKind::kLine) {
        connect(begin, end, EdgeOrigin::kCopy);
        continue;
      }
      std::vector<Vector3d> handles;
      for (int h = 0; h < num_handles(stroke.kind); ++h)
        handles.push_back(seen_.handles.col(stroke.handle + h) + shift);
      all_->add(EdgeOrigin::kCopy, stroke.kind, begin, end, handles);
    }
  }

  int node_at(const Vector3d& place) {
    Eigen::Index nearest;
    if ((all_->sketch.nodes.colwise() - place).colwise().norm().minCoeff(&nearest) <= tolerance_)
      return int(nearest);
    return all_->sketch.add_node(place);
  }

  void connect(int a, int b, EdgeOrigin origin) {
    if (a != b && joined_.insert(std::minmax(a, b)).second)
      all_->add(origin, StrokeKind::kLine, a, b, {});
  }

  const Sketch& seen_;
  const std::vector<int> degree_;
  const std::vector<bool>& left_;
  double tolerance_;
  Completed* all_;
  std::set<std::pair<int, int>> joined_;
};

}  // namespace

bool copy_loops(const std::vector<bool>& left, double tolerance, double slide,
                Completed* completed) {
  if (!Copier(left, tolerance, completed).run()) return false;
  imply(tolerance, slide, completed);
  return true;
}

}  // namespace sketchsplat

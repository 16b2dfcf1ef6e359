// SPDX-License-Identifier: MIT
#include "pipelines/adjust/standard_hypotheses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sketches/curve/conic.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kParallel = 1 - 1e-6;  // cosine of directions that are one

bool is_round(const Sketch& sketch, int s) {
  const StrokeKind kind = sketch.strokes[s].kind;
  if (kind == StrokeKind::kCircle) return true;
  const bool loop = sketch.strokes[s].begin == sketch.strokes[s].end;
  return kind == StrokeKind::kArc && !loop && !circle_parameters(sketch, s).straight;
}

LengthHypothesis round_length(const Sketch& sketch, const std::vector<int>& strokes, int zero) {
  LengthHypothesis h;
  h.kind = LengthKind::kRadius;
  h.strokes = strokes;
  for (const int s : strokes) {
    if (circle_parameters(sketch, s).angle >= M_PI) h.kind = LengthKind::kDiameter;
    Relation r;
    r.kind = RelationKind::kEqualRadius;
    r.shared = zero;
    r.stroke = s;
    h.relations.push_back(r);
  }
  return h;
}

void add_radii(const Sketch& sketch, const Regularized& regular, int zero,
               std::vector<LengthHypothesis>* out) {
  std::set<int> done;
  const auto add = [&](const std::vector<int>& all) {
    std::vector<int> strokes;
    for (const int s : all)
      if (is_round(sketch, s) && done.insert(s).second) strokes.push_back(s);
    if (!strokes.empty()) out->push_back(round_length(sketch, strokes, zero));
  };
  for (const Regularity& r : regular.kept)
    if (r.kind == RelationKind::kEqualRadius) add(r.strokes);
  for (int s = 0; s < sketch.size(); ++s) add({s});
}

// A shared plane with the points that keep to it.
struct HeldPlane {
  int shared = -1;
  std::set<int> points;
};
using PlanesOfDirection = std::map<int, std::vector<HeldPlane>>;  // by offset

PlanesOfDirection held_planes(const Relations& relations) {
  std::map<int, std::set<int>> points;
  for (const Relation& r : relations.list)
    if (r.kind == RelationKind::kCoplanar) points[r.shared].insert(r.point);
  PlanesOfDirection out;
  for (const auto& [shared, held] : points)
    out[relations.shared[shared].direction].push_back({shared, held});
  for (auto& [direction, planes] : out)
    std::stable_sort(planes.begin(), planes.end(), [&](const HeldPlane& a, const HeldPlane& b) {
      return relations.shared[a.shared].value[0] < relations.shared[b.shared].value[0];
    });
  return out;
}

bool lies_in(const Sketch& sketch, int s, const HeldPlane& plane) {
  const Stroke& stroke = sketch.strokes[s];
  if (is_closed(stroke.kind))
    return plane.points.count(int(sketch.nodes.cols()) + stroke.handle) > 0;
  return plane.points.count(stroke.begin) && plane.points.count(stroke.end);
}

// Of n things in a row: neighbours, and the outermost.
std::vector<std::pair<int, int>> pairs_in_row(int n) {
  std::vector<std::pair<int, int>> out;
  for (int i = 0; i + 1 < n; ++i) out.emplace_back(i, i + 1);
  if (n > 2) out.emplace_back(0, n - 1);
  return out;
}

void add_plane_distances(const Sketch& sketch, const PlanesOfDirection& planes,
                         std::vector<LengthHypothesis>* out) {
  for (const auto& [direction, row] : planes)
    for (const auto& [a, b] : pairs_in_row(int(row.size()))) {
      LengthHypothesis h;
      h.kind = LengthKind::kPlaneDistance;
      for (int s = 0; s < sketch.size(); ++s)
        if (lies_in(sketch, s, row[a]) || lies_in(sketch, s, row[b])) h.strokes.push_back(s);
      Relation r;
      r.kind = RelationKind::kApart;
      r.shared = row[a].shared;
      r.other = row[b].shared;
      h.relations = {r};
      if (!h.strokes.empty()) out->push_back(h);
    }
}

// Is there a direction across which planes hold the lines already?
bool told_by_planes(const Vector3d& across, const Relations& relations,
                    const PlanesOfDirection& planes) {
  return std::any_of(planes.begin(), planes.end(), [&](const auto& row) {
    return row.second.size() > 1 &&
           std::abs(relations.shared[row.first].value.dot(across)) > kParallel;
  });
}

void add_line_distances(const Sketch& sketch, const Relations& relations,
                        const PlanesOfDirection& planes, std::vector<LengthHypothesis>* out) {
  std::map<int, std::vector<int>> parallel;  // lines by direction
  for (const Relation& r : relations.list)
    if (r.kind == RelationKind::kParallel && sketch.strokes[r.stroke].kind == StrokeKind::kLine)
      parallel[r.shared].push_back(r.stroke);
  for (const auto& [direction, lines] : parallel)
    for (const auto& [normal, row] : planes)
      for (const HeldPlane& plane : row) {
        const Vector3d across =
            relations.shared[normal].value.cross(relations.shared[direction].value);
        if (normal == direction || across.squaredNorm() < kParallel * kParallel ||
            told_by_planes(across, relations, planes))
          continue;
        std::vector<std::pair<double, int>> offsets;
        for (const int s : lines)
          if (lies_in(sketch, s, plane))
            offsets.push_back({across.dot(sketch.nodes.col(sketch.strokes[s].begin)), s});
        std::sort(offsets.begin(), offsets.end());
        for (const auto& [a, b] : pairs_in_row(int(offsets.size()))) {
          LengthHypothesis h;
          h.kind = LengthKind::kLineDistance;
          const int s = offsets[a].second, t = offsets[b].second;
          h.strokes = {std::min(s, t), std::max(s, t)};
          Relation r;
          r.kind = RelationKind::kApart;
          r.shared = direction;
          r.point = sketch.strokes[s].begin;
          r.twin = sketch.strokes[t].begin;
          h.relations = {r};
          out->push_back(h);
        }
      }
}

}  // namespace

const char* length_name(LengthKind kind) {
  constexpr const char* kNames[] = {"diameter", "radius", "plane distance", "line distance"};
  return kNames[int(kind)];
}

std::vector<LengthHypothesis> length_hypotheses(const Sketch& sketch, const Regularized& regular,
                                                int zero_radius) {
  std::vector<LengthHypothesis> out;
  add_radii(sketch, regular, zero_radius, &out);
  const PlanesOfDirection planes = held_planes(regular.imposed);
  add_plane_distances(sketch, planes, &out);
  add_line_distances(sketch, regular.imposed, planes, &out);
  return out;
}

}  // namespace sketchsplat

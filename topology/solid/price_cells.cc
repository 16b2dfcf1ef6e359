// SPDX-License-Identifier: MIT
#include "topology/solid/price_cells.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "topology/solid/crossing_cells.h"
#include "topology/solid/find_surfaces.h"

namespace sketchsplat {
namespace {

// Two surfaces of a kind that hold the same strokes give the same cells; but of those that bulge as
// they like.
void drop_doubles(std::vector<Cell>* cells, const std::vector<SurfaceStrokes>& surfaces) {
  std::set<std::pair<bool, std::vector<int>>> seen;
  std::vector<Cell> out;
  for (Cell& cell : *cells) {
    const SurfaceKind kind = surfaces[cell.surface].surface.kind;
    if (surfaces[cell.surface].part) {
      out.push_back(std::move(cell));
      continue;
    }
    std::vector<int> strokes;
    for (const Loop& loop : cell.loops)
      for (const LoopStroke& s : loop) strokes.push_back(s.stroke);
    std::sort(strokes.begin(), strokes.end());
    const bool planar = kind == SurfaceKind::kPlane;
    if (seen.emplace(planar, strokes).second) out.push_back(std::move(cell));
  }
  *cells = std::move(out);
}

// Does something speak for a cell? Of a round surface the part that contours or rims ask for; a
// cone's apex that nobody saw may be anywhere.
bool is_supported(const Cell& cell, const SurfaceStrokes& on) {
  if (!on.part)
    return on.surface.kind != SurfaceKind::kCone || cell.polygons.size() == cell.loops.size();
  const std::vector<Eigen::Vector3d> points = points_within(cell, layout_of(on), 20);
  const auto within = std::count_if(points.begin(), points.end(), on.part);
  return 2 * within > long(points.size());
}

// What it costs to say that a stroke is no edge: its log-odds of being one, within reason.
double unused_price(const Evidence& evidence) {
  // Something else must have made the edgels, on top.
  constexpr double kUnknown = 5, kLeast = 0.5, kMost = 10, kCause = 3;
  if (std::isnan(evidence.confidence)) return kUnknown + kCause;
  const double c = std::clamp(evidence.confidence, 1e-6, 1 - 1e-6);
  return std::clamp(std::log(c / (1 - c)), kLeast, kMost) + kCause;
}

double used_price(EdgeOrigin origin, const SolidOptions& options) {
  switch (origin) {
    case EdgeOrigin::kSeen:
      return 0;
    case EdgeOrigin::kSmooth:
      return options.smooth_price;
    case EdgeOrigin::kCopy:
      return options.copy_price;
    case EdgeOrigin::kFaint:
      break;
  }
  return options.faint_price;
}

double face_price(const Surface& surface, const SolidOptions& options) {
  const bool rare = surface.kind != SurfaceKind::kPlane && surface.kind != SurfaceKind::kCylinder;
  return options.face_price + (rare ? options.rare_price : 0);
}

// Cells that an inferred circle, if it is no edge, leaves as one face.
std::vector<std::pair<std::pair<int, int>, double>> merges(const Completed& all,
                                                           const std::vector<Cell>& cells,
                                                           const SolidOptions& options) {
  std::vector<std::pair<std::pair<int, int>, double>> out;
  for (const auto& [where, pair] : sides_of(cells))
    if (pair.first >= 0 && pair.second >= 0 && all.origin[where.first] != EdgeOrigin::kSeen &&
        is_closed(all.sketch.strokes[where.first].kind))
      out.push_back({pair, face_price(all.surfaces[where.second].surface, options)});
  return out;
}

// Cells of every surface; and of every surface without the strokes that may be others seen twice,
// for these lie on one another, and nobody knows which comes next around a node.
std::vector<Cell> all_cells(const Completed& all, const std::vector<Double>& doubles) {
  std::vector<Cell> out;
  const auto add = [&](const SurfaceStrokes& on, int index) {
    for (Cell& cell : cells_of(all.sketch, all.polylines, on, index))
      if (is_supported(cell, on)) out.push_back(std::move(cell));
  };
  std::set<int> twice;
  for (const Double& d : doubles) twice.insert(d.stroke);
  for (int i = 0; i < int(all.surfaces.size()); ++i) {
    add(all.surfaces[i], i);
    SurfaceStrokes once = all.surfaces[i];
    once.strokes.erase(std::remove_if(once.strokes.begin(), once.strokes.end(),
                                      [&](int s) { return twice.count(s) > 0; }),
                       once.strokes.end());
    if (once.strokes.size() < all.surfaces[i].strokes.size()) add(once, i);
  }
  return out;
}

}  // namespace

std::vector<Double> doubles_of(const Sketch& sketch, const std::vector<bool>& left, double reach) {
  constexpr int kPlaces = 16;
  std::vector<Double> out;
  Eigen::Vector3d p, d;
  for (int s = 0; s < int(left.size()); ++s) {
    if (!left[s]) continue;
    Double stroke{s, {}};
    for (int i = 0; i <= kPlaces; ++i) {
      evaluate_stroke(sketch, s, double(i) / kPlaces, &p, &d);
      std::vector<int> beside;
      for (int other = 0; other < sketch.size(); ++other)
        if (other != s && distance_to_stroke(sketch, other, p).distance <= reach)
          beside.push_back(other);
      stroke.along.insert(beside);
    }
    if (!stroke.along.count({})) out.push_back(stroke);
  }
  return out;
}

CellChoice price_cells(const Completed& all, double tolerance, const SolidOptions& options,
                       const SolidEvidence& evidence, const std::vector<Double>& doubles,
                       EvidenceOfCells* weighed) {
  CellChoice choice;
  choice.doubles = doubles;
  choice.cells = all_cells(all, doubles);
  drop_doubles(&choice.cells, all.surfaces);
  *weighed = weigh_cells(evidence, all.surfaces, choice.cells, largest_extent(all.sketch),
                         options.evidence);
  for (size_t c = 0; c < choice.cells.size(); ++c) {
    const SurfaceStrokes& on = all.surfaces[choice.cells[c].surface];
    choice.cell_price.push_back(face_price(on.surface, options) + weighed->against[c] - on.bonus);
  }
  choice.merges = merges(all, choice.cells, options);
  for (const Meeting& m : weighed->object)
    choice.covers.push_back({m.cells, options.evidence.ray * m.rays});
  choice.exclusive = crossing_cells(all.surfaces, choice.cells, tolerance);
  for (int s = 0; s < all.sketch.size(); ++s) {
    const bool seen = all.origin[s] == EdgeOrigin::kSeen;
    choice.used_price.push_back(used_price(all.origin[s], options));
    choice.unused_price.push_back(seen ? unused_price(all.sketch.evidence[s]) : 0);
  }
  choice.double_price = options.double_price;
  return choice;
}

}  // namespace sketchsplat

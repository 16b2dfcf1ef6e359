// SPDX-License-Identifier: MIT
#include "topology/solid/find_solid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "sketches/curve/curve.h"
#include "topology/faces/find_planes.h"
#include "topology/solid/adjust.h"
#include "topology/solid/assemble.h"
#include "topology/solid/choose.h"
#include "topology/solid/crossing_cells.h"
#include "topology/solid/find_surfaces.h"
#include "topology/solid/infer_edges.h"
#include "topology/solid/match_rims.h"
#include "topology/solid/round_candidates.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;

// Of bent strokes: chords stay within 3e-4 of a circle's radius.
constexpr int kPieces = 128;

// A sketch with the lines that surfaces imply, and which surfaces they lie on.
struct Completed {
  Sketch sketch;
  std::vector<std::vector<int>> now;  // of the strokes that were given, those in their place
  std::vector<Matrix3Xd> polylines;
  std::vector<SurfaceStrokes> surfaces;
  std::vector<bool> inferred, smooth;  // per stroke
};

void add_implied(const std::vector<ImpliedStroke>& implied, Completed* out) {
  for (const ImpliedStroke& s : implied) {
    out->sketch.add_stroke(s.kind, s.begin, s.end, s.handles);
    out->inferred.push_back(true);
    out->smooth.push_back(s.smooth);
  }
  out->polylines = polylines_of(out->sketch, kPieces);
}

// Along a smooth rim a cylinder runs into a sphere or a torus, and nothing else begins there.
void keep_to_rounds(int begin, int end, std::vector<SurfaceStrokes>* surfaces) {
  const auto is_rim = [&](int s) { return s >= begin && s < end; };
  for (SurfaceStrokes& s : *surfaces)
    if (s.surface.kind == SurfaceKind::kPlane || s.surface.kind == SurfaceKind::kCone)
      s.strokes.erase(std::remove_if(s.strokes.begin(), s.strokes.end(), is_rim), s.strokes.end());
}

// Lines make planes known, and these further lines: a slot's straight sides hang on its rulings.
Completed complete(const Sketch& given, const std::vector<ContourLine>& contours,
                   double tolerance) {
  constexpr int kRounds = 3;
  MatchedRims rims = match_rims(given, tolerance);
  const Sketch& sketch = rims.sketch;
  Completed out{sketch, std::move(rims.now), polylines_of(sketch, kPieces), {}, {}, {}};
  out.inferred.assign(sketch.size(), false);
  out.smooth = out.inferred;
  out.surfaces = find_surfaces(sketch, out.polylines, tolerance);
  RoundCandidates round =
      round_candidates(sketch, out.polylines, out.surfaces, contours, tolerance);
  add_implied(round.rims, &out);
  add_implied(rims.rulings, &out);
  for (int k = 0;; ++k) {
    out.surfaces = find_surfaces(out.sketch, out.polylines, tolerance);
    const std::vector<ImpliedStroke> implied =
        implied_strokes(sketch, out.sketch, out.surfaces, tolerance);
    if (implied.empty() || k == kRounds) break;
    add_implied(implied, &out);
  }
  keep_to_rounds(sketch.size(), sketch.size() + int(round.rims.size()), &out.surfaces);
  for (std::vector<SurfaceStrokes>* more : {&round.surfaces, &rims.surfaces})
    for (SurfaceStrokes& s : *more) {
      s.strokes = strokes_on(s.surface, out.polylines, tolerance);
      out.surfaces.push_back(std::move(s));
    }
  return out;
}

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

double face_price(const Surface& surface, const SolidOptions& options) {
  const bool rare = surface.kind != SurfaceKind::kPlane && surface.kind != SurfaceKind::kCylinder;
  return options.face_price + (rare ? options.rare_price : 0);
}

// Cells that an inferred circle, if it is no edge, leaves as one face.
std::vector<std::pair<std::pair<int, int>, double>> merges(const Completed& all,
                                                           const std::vector<Cell>& cells,
                                                           const SolidOptions& options) {
  std::map<std::pair<int, int>, std::pair<int, int>> sides;  // of a stroke on a surface
  for (int c = 0; c < int(cells.size()); ++c)
    for (const Loop& loop : cells[c].loops)
      for (const LoopStroke& s : loop) {
        if (!all.inferred[s.stroke] || !is_closed(all.sketch.strokes[s.stroke].kind)) continue;
        auto& side =
            sides.emplace(std::pair(s.stroke, cells[c].surface), std::pair(-1, -1)).first->second;
        (s.forward ? side.first : side.second) = c;
      }
  std::vector<std::pair<std::pair<int, int>, double>> out;
  for (const auto& [where, pair] : sides)
    if (pair.first >= 0 && pair.second >= 0)
      out.push_back({pair, face_price(all.surfaces[where.second].surface, options)});
  return out;
}

CellChoice price(const Completed& all, double tolerance, const SolidOptions& options,
                 const SolidEvidence& evidence, EvidenceOfCells* weighed) {
  CellChoice choice;
  for (int i = 0; i < int(all.surfaces.size()); ++i)
    for (Cell& cell : cells_of(all.sketch, all.polylines, all.surfaces[i], i))
      if (is_supported(cell, all.surfaces[i])) choice.cells.push_back(std::move(cell));
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
    const double faint = all.smooth[s] ? options.smooth_price : options.faint_price;
    choice.used_price.push_back(all.inferred[s] ? faint : 0);
    choice.unused_price.push_back(all.inferred[s] ? 0 : unused_price(all.sketch.evidence[s]));
  }
  return choice;
}

}  // namespace

SolidSearch find_solid(const Sketch& sketch, const SolidOptions& options,
                       const SolidEvidence& evidence) {
  SolidSearch out;
  const double tolerance = options.tolerance * largest_extent(sketch);
  const Completed all = complete(sketch, evidence.contours, tolerance);
  EvidenceOfCells weighed;
  const CellChoice choice = price(all, tolerance, options, evidence, &weighed);
  out.surfaces = int(all.surfaces.size());
  out.cells = int(choice.cells.size());
  const ChosenCells best = choose_cells(choice, {}, options.nodes);
  for (int s = 0; s < sketch.size(); ++s)
    if (std::any_of(all.now[s].begin(), all.now[s].end(), [&](int k) { return !best.stroke[k]; }))
      out.doubtful.push_back(s);
  out.rays = int(evidence.rays.size());
  out.contradicted = contradicted(weighed, best.cell);
  Solid solid;
  if (!assemble(all.sketch, all.inferred, all.polylines, all.surfaces, choice.cells, best, &solid,
                &out.why))
    return out;
  out.margin = choose_cells(choice, {best}, options.nodes).price - best.price;
  if (!out.doubtful.empty()) {
    out.why = std::to_string(out.doubtful.size()) + " of " + std::to_string(sketch.size()) +
              " curves are no edge of the faces that close";
    return out;
  }
  if (out.contradicted > options.contradicted * out.rays) {
    out.why = "masks show otherwise along " + std::to_string(out.contradicted) + " of " +
              std::to_string(out.rays) + " lines of sight";
    return out;
  }
  if (out.margin < options.margin) {
    out.why = "another choice of faces explains the curves about as well";
    return out;
  }
  adjust(&solid);
  out.solid = std::move(solid);
  return out;
}

}  // namespace sketchsplat

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
#include "topology/solid/common_faces.h"
#include "topology/solid/crossing_cells.h"
#include "topology/solid/find_surfaces.h"
#include "topology/solid/infer_edges.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;

// Of bent strokes: chords stay within 3e-4 of a circle's radius.
constexpr int kPieces = 128;

// A sketch with the lines that surfaces imply, and which surfaces they lie on.
struct Completed {
  Sketch sketch;
  std::vector<Matrix3Xd> polylines;
  std::vector<SurfaceStrokes> surfaces;
  std::vector<bool> inferred, smooth;  // per stroke
};

// Lines make planes known, and these further lines: a slot's straight sides hang on its rulings.
Completed complete(const Sketch& sketch, double tolerance) {
  constexpr int kRounds = 3;
  Completed out{sketch, polylines_of(sketch, kPieces), {}, {}, {}};
  out.inferred.assign(sketch.size(), false);
  out.smooth = out.inferred;
  for (int round = 0;; ++round) {
    out.surfaces = find_surfaces(out.sketch, out.polylines, tolerance);
    const std::vector<ImpliedStroke> implied =
        implied_strokes(sketch, out.sketch, out.surfaces, tolerance);
    if (implied.empty() || round == kRounds) return out;
    for (const ImpliedStroke& s : implied) {
      out.sketch.add_stroke(s.kind, s.begin, s.end, s.handles);
      out.inferred.push_back(true);
      out.smooth.push_back(s.smooth);
    }
    out.polylines = polylines_of(out.sketch, kPieces);
  }
}

// Two surfaces of a kind that hold the same strokes give the same cells.
void drop_doubles(std::vector<Cell>* cells, const std::vector<SurfaceStrokes>& surfaces) {
  std::set<std::pair<bool, std::vector<int>>> seen;
  std::vector<Cell> out;
  for (Cell& cell : *cells) {
    std::vector<int> strokes;
    for (const Loop& loop : cell.loops)
      for (const LoopStroke& s : loop) strokes.push_back(s.stroke);
    std::sort(strokes.begin(), strokes.end());
    const bool planar = surfaces[cell.surface].surface.kind == SurfaceKind::kPlane;
    if (seen.emplace(planar, strokes).second) out.push_back(std::move(cell));
  }
  *cells = std::move(out);
}

// What it costs to say that a stroke is no edge: its log-odds of being one, within reason.
double unused_price(const Evidence& evidence) {
  // Something else must have made the edgels, on top.
  constexpr double kUnknown = 5, kLeast = 0.5, kMost = 10, kCause = 3;
  if (std::isnan(evidence.confidence)) return kUnknown + kCause;
  const double c = std::clamp(evidence.confidence, 1e-6, 1 - 1e-6);
  return std::clamp(std::log(c / (1 - c)), kLeast, kMost) + kCause;
}

CellChoice price(const Completed& all, double tolerance, const SolidOptions& options,
                 const SolidEvidence& evidence, EvidenceOfCells* weighed) {
  CellChoice choice;
  for (int i = 0; i < int(all.surfaces.size()); ++i)
    for (Cell& cell : cells_of(all.sketch, all.polylines, all.surfaces[i], i))
      choice.cells.push_back(std::move(cell));
  drop_doubles(&choice.cells, all.surfaces);
  *weighed = weigh_cells(evidence, all.surfaces, choice.cells, largest_extent(all.sketch),
                         options.evidence);
  for (const double against : weighed->against)
    choice.cell_price.push_back(options.face_price + against);
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

// What speaks against the best choice; empty if nothing does.
std::string doubt(const SolidSearch& found, int strokes, const SolidOptions& options) {
  if (!found.doubtful.empty())
    return std::to_string(found.doubtful.size()) + " of " + std::to_string(strokes) +
           " curves are no edge of the faces that close";
  if (found.contradicted > options.contradicted * found.rays)
    return "masks show otherwise along " + std::to_string(found.contradicted) + " of " +
           std::to_string(found.rays) + " lines of sight";
  if (found.margin < options.margin)
    return "another choice of faces explains the curves about as well";
  return "";
}

// Is there a stroke on the surface that no face explains? What it does there nobody knows.
bool holds_doubtful(const Completed& all, const std::vector<int>& doubtful, const Surface& s) {
  for (const SurfaceStrokes& of : all.surfaces) {
    const Surface& t = of.surface;
    if (t.kind != s.kind || t.origin != s.origin || t.axis != s.axis || t.radius != s.radius)
      continue;
    for (const int stroke : doubtful)
      if (std::binary_search(of.strokes.begin(), of.strokes.end(), stroke)) return true;
  }
  return false;
}

// Faces of the best choice that the second-best one has, too, and that leave no stroke open.
std::optional<Solid> sure_faces(const Solid& best, const Solid& second, const Completed& all,
                                const std::vector<int>& doubtful) {
  const Solid common = common_faces(best, second);
  std::vector<bool> explained;
  for (const SolidFace& face : common.faces)
    explained.push_back(!holds_doubtful(all, doubtful, common.surfaces[face.surface]));
  Solid shell = keep_faces(common, explained);
  if (shell.faces.empty()) return std::nullopt;
  adjust(&shell);
  return shell;
}

}  // namespace

SolidSearch find_solid(const Sketch& sketch, const SolidOptions& options,
                       const SolidEvidence& evidence) {
  SolidSearch out;
  const double tolerance = options.tolerance * largest_extent(sketch);
  const Completed all = complete(sketch, tolerance);
  EvidenceOfCells weighed;
  const CellChoice choice = price(all, tolerance, options, evidence, &weighed);
  out.surfaces = int(all.surfaces.size());
  out.cells = int(choice.cells.size());
  const ChosenCells best = choose_cells(choice, {}, options.nodes);
  for (int s = 0; s < sketch.size(); ++s)
    if (!best.stroke[s]) out.doubtful.push_back(s);
  out.rays = int(evidence.rays.size());
  out.contradicted = contradicted(weighed, best.cell);
  const auto boundary = [&](const ChosenCells& chosen, Solid* solid, std::string* why) {
    return assemble(all.sketch, all.inferred, all.polylines, all.surfaces, choice.cells, chosen,
                    solid, why);
  };
  Solid solid;
  if (!boundary(best, &solid, &out.why)) return out;
  out.faces = int(solid.faces.size());
  const ChosenCells second = choose_cells(choice, {best}, options.nodes);
  out.margin = second.price - best.price;
  out.why = doubt(out, sketch.size(), options);
  if (!out.why.empty()) {
    std::string none;
    Solid other;
    if (out.contradicted <= options.contradicted * out.rays && boundary(second, &other, &none))
      out.shell = sure_faces(solid, other, all, out.doubtful);
    return out;
  }
  adjust(&solid);
  out.solid = std::move(solid);
  return out;
}

}  // namespace sketchsplat

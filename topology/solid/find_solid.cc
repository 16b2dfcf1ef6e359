// SPDX-License-Identifier: MIT
#include "topology/solid/find_solid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "topology/solid/adjust.h"
#include "topology/solid/assemble.h"
#include "topology/solid/choose.h"
#include "topology/solid/complete.h"
#include "topology/solid/find_surfaces.h"
#include "topology/solid/keep_faces.h"
#include "topology/solid/price_cells.h"

namespace sketchsplat {
namespace {

// Faces on whose surfaces every stroke is explained: what another one does there nobody knows.
Solid without_left(const Solid& solid, const Completed& all, const std::vector<bool>& left) {
  std::vector<bool> explained;
  for (const SolidFace& face : solid.faces) {
    const std::vector<int>& strokes = all.surfaces[face.surface].strokes;
    explained.push_back(std::none_of(strokes.begin(), strokes.end(),
                                     [&](int s) { return s < int(left.size()) && left[s]; }));
  }
  return keep_faces(solid, explained);
}

// One search: with edges that surfaces imply, or with copies of loops and strokes seen twice, too.
class Search {
 public:
  Search(const Sketch& sketch, double tolerance, double slide, const SolidOptions& options,
         const SolidEvidence& evidence)
      : sketch_(sketch),
        tolerance_(tolerance),
        slide_(slide),
        options_(options),
        evidence_(evidence),
        all_(complete(sketch, evidence.contours, tolerance, slide, options.most_surfaces)) {}

  SolidSearch plain() { return run(std::vector<bool>(all_.seen.size())); }

  // `plain` was tried, and left strokes over, but not nearly all: is there something else to try?
  bool has_more(const SolidSearch& plain) {
    if (plain.doubtful.empty() || is_hopeless(plain)) return false;
    const bool copied = copy_loops(left_, tolerance_, slide_, &all_);
    return copied || !doubles_of(all_.sketch, left_, 3 * tolerance_).empty();
  }
  SolidSearch with_copies() { return run(left_); }
  // Any stroke may be others seen twice, even one that bounded a face.
  SolidSearch with_doubles() { return run(std::vector<bool>(all_.seen.size(), true)); }

  // What can be said where no choice closes, or several do: of the cells that were tried last.
  // `each`: asks of each face beside an inferred edge whether the strokes can do without.
  void find_shell(bool each, SolidSearch* out) {
    if (undecided_) return;
    if (!out->doubtful.empty()) open_edges();
    const ChosenCells best = choose_cells(choice_, {}, options_.nodes);
    if (contradicted(weighed_, best.cell) > options_.contradicted * evidence_.rays.size()) return;
    for (int s = 0; s < all_.seen.size(); ++s)
      left_[s] = !best.stroke[s] && !best.twice[s] && !best.open[s];
    if (2 * std::count(left_.begin(), left_.end(), true) > all_.seen.size()) return;
    ChosenCells sure = best;
    sure.open.assign(all_.sketch.size(), true);
    Solid solid;
    std::string why;
    if (!assemble(all_, choice_.cells, sure, &solid, &why)) return;
    out->faces = int(solid.faces.size());
    keep_common(best, choose_cells(choice_, {best}, options_.nodes), &sure.cell);
    for (size_t c = 0; each && c < sure.cell.size(); ++c)
      if (sure.cell[c] && borders_inferred(choice_.cells[c]))
        keep_common(best, best_without(int(c)), &sure.cell);
    for (const int c : unseen_tapers(best)) sure.cell[c] = false;
    if (!assemble(all_, choice_.cells, sure, &solid, &why)) return;
    solid = without_left(solid, all_, left_);
    if (solid.faces.empty()) return;
    out->as_seen = solid.edges;
    adjust(&solid);
    out->shell = std::move(solid);
  }

 private:
  // Strokes may border one face.
  void open_edges() {
    constexpr double kLess = 1;  // [nat] than of a stroke that is none
    choice_.open_price.assign(all_.sketch.size(), HUGE_VAL);
    for (int s = 0; s < all_.seen.size(); ++s)
      choice_.open_price[s] = std::min(options_.open_price, choice_.unused_price[s] - kLess);
  }

  // Cones that may be steps, as far as is seen.
  std::vector<int> unseen_tapers(const ChosenCells& best) const {
    std::vector<int> out;
    for (int c = 0; c < int(best.cell.size()) && !evidence_.sights.empty(); ++c)
      if (best.cell[c] &&
          all_.surfaces[choice_.cells[c].surface].surface.kind == SurfaceKind::kCone &&
          cameras_at_worst(evidence_, all_.surfaces, choice_.cells, best.cell, c,
                           options_.evidence.near * largest_extent(sketch_)) <
              options_.taper_cameras)
        out.push_back(c);
    return out;
  }

  bool borders_inferred(const Cell& cell) const {
    for (const Loop& loop : cell.loops)
      for (const LoopStroke& s : loop)
        if (all_.origin[s.stroke] != EdgeOrigin::kSeen) return true;
    return false;
  }

  ChosenCells best_without(int cell) const {
    constexpr double kNever = 1e4;
    CellChoice choice = choice_;
    choice.cell_price[cell] += kNever;
    return choose_cells(choice, {}, options_.nodes);
  }

  // Without the cells that a choice which is about as good does without.
  void keep_common(const ChosenCells& best, const ChosenCells& other,
                   std::vector<bool>* sure) const {
    if (other.price - best.price >= options_.margin) return;
    for (size_t c = 0; c < sure->size(); ++c) (*sure)[c] = (*sure)[c] && other.cell[c];
  }

  SolidSearch run(const std::vector<bool>& left) {
    SolidSearch out;
    try {
      choose(left, &out);
    } catch (const UndecidedChoice& e) {
      out.why = e.what();
      undecided_ = true;
    }
    return out;
  }

  // `left` by an earlier choice: strokes that may be others seen twice.
  void choose(const std::vector<bool>& left, SolidSearch* found) {
    SolidSearch& out = *found;
    CellChoice& choice = choice_;
    out.surfaces = int(all_.surfaces.size());
    if (out.surfaces > options_.most_surfaces) throw UndecidedChoice("too many faces are possible");
    choice = price_cells(all_, tolerance_, options_, evidence_,
                         doubles_of(all_.sketch, left, 3 * tolerance_), &weighed_);
    out.cells = int(choice.cells.size());
    if (int(choice.exclusive.size()) > options_.most_exclusive)
      throw UndecidedChoice("too many faces are possible");
    const ChosenCells best = choose_cells(choice, {}, options_.nodes);
    note_left(best, &out);
    out.rays = int(evidence_.rays.size());
    out.contradicted = contradicted(weighed_, best.cell);
    Solid solid;
    if (!assemble(all_, choice.cells, best, &solid, &out.why)) return;
    out.faces = int(solid.faces.size());
    if (!is_hopeless(out))
      out.margin = choose_cells(choice, {best}, options_.nodes).price - best.price;
    out.why = objection(out);
    if (out.why.empty() && !unseen_tapers(best).empty())
      out.why = "too few cameras see all of a tapered face to tell it from a stepped one";
    if (!out.why.empty()) return;
    std::vector<int> edge_of;
    out.solid = keep_faces(solid, std::vector<bool>(solid.faces.size(), true), &edge_of);
    note_edges(edge_of, &out);
  }

  // What became of the strokes that were given. `edge_of`: of those that they were completed to.
  void note_edges(const std::vector<int>& edge_of, SolidSearch* out) const {
    out->edge_of.assign(sketch_.size(), -1);
    for (int s = 0; s < sketch_.size(); ++s)
      for (const int now : all_.now[s])
        if (out->edge_of[s] < 0) out->edge_of[s] = edge_of[now];
  }

  // More masks than a few that are ragged.
  bool contradicts(const SolidSearch& found) const {
    return found.contradicted > options_.contradicted * found.rays;
  }

  void note_left(const ChosenCells& best, SolidSearch* out) {
    left_.assign(all_.seen.size(), false);
    for (int s = 0; s < all_.seen.size(); ++s) left_[s] = !best.stroke[s] && !best.twice[s];
    for (int s = 0; s < sketch_.size(); ++s)
      if (std::any_of(all_.now[s].begin(), all_.now[s].end(), [&](int k) { return left_[k]; }))
        out->doubtful.push_back(s);
    out->twice = int(std::count(best.twice.begin(), best.twice.end(), true));
  }

  bool is_hopeless(const SolidSearch& found) const {
    return double(found.doubtful.size()) > options_.hopeless * sketch_.size();
  }

  // Why a choice is not good enough; empty if it is.
  std::string objection(const SolidSearch& found) const {
    if (!found.doubtful.empty())
      return std::to_string(found.doubtful.size()) + " of " + std::to_string(sketch_.size()) +
             " curves are no edge of the faces that close";
    if (contradicts(found))
      return "masks show otherwise along " + std::to_string(found.contradicted) + " of " +
             std::to_string(found.rays) + " lines of sight";
    if (found.margin < options_.margin)
      return "another choice of faces explains the curves about as well";
    return "";
  }

  const Sketch& sketch_;
  double tolerance_, slide_;
  const SolidOptions& options_;
  const SolidEvidence& evidence_;
  Completed all_;
  EvidenceOfCells weighed_;
  CellChoice choice_;       // that was tried last
  std::vector<bool> left_;  // per stroke that is seen: it bounds no face of the last choice
  bool undecided_ = false;  // the last choice was too large
};

// Largest distance of a place inside of a stroke that is seen from where the stroke was; ends may
// slide along.
double farthest_move(const Sketch& before, const Solid& solid) {
  const Sketch& after = solid.edges;
  constexpr int kPlaces = 8;
  double most = 0;
  Eigen::Vector3d p, d;
  for (int s = 0; s < after.size(); ++s)
    for (int i = 1; !solid.inferred[s] && i < kPlaces; ++i) {
      evaluate_stroke(after, s, double(i) / kPlaces, &p, &d);
      most = std::max(most, distance_to_stroke(before, s, p).distance);
    }
  return most;
}

}  // namespace

SolidSearch find_solid(const Sketch& sketch, const SolidOptions& options,
                       const SolidEvidence& evidence) {
  const double tolerance = options.tolerance * largest_extent(sketch);
  // Thin walls ask for a fine tolerance, curves that err for a coarse one.
  std::vector<Search> searches;
  searches.reserve(2);
  std::vector<SolidSearch> found;
  for (const double share : {1.0, 1.0 / 3}) {
    searches.emplace_back(sketch, share * tolerance, 3 * tolerance, options, evidence);
    found.push_back(searches.back().plain());
    if (found.back().solid || found.back().surfaces > options.many_surfaces) break;
  }
  const bool many = found.front().surfaces > options.many_surfaces;
  std::vector<Search*> more;
  for (size_t i = 0; i < searches.size() && !many && !found.back().solid; ++i)
    if (searches[i].has_more(found[i])) {
      found.push_back(searches[i].with_copies());
      more.push_back(&searches[i]);
    }
  for (size_t i = 0; i < more.size() && !found.back().solid; ++i)
    found.push_back(more[i]->with_doubles());
  SolidSearch& last = found.back().solid ? found.back() : found.front();
  if (last.solid) {
    last.as_seen = last.solid->edges;
    adjust(&*last.solid);
    if (farthest_move(last.as_seen, *last.solid) > 3 * tolerance) {
      last.solid.reset();
      last.why = "curves would have to move far to lie on their faces";
    }
  } else {
    try {
      searches.front().find_shell(!many, &last);
    } catch (const UndecidedChoice&) {
      last.shell.reset();
    }
  }
  return std::move(last);
}

}  // namespace sketchsplat

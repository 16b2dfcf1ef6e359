// SPDX-License-Identifier: MIT
#include "eval/inspect/association.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "datasets/types/parallel.h"
#include "eval/inspect/edge_samples.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kFound = 0.9, kSome = 0.1;  // shares of an edge's length
constexpr int kLeastPlaces = 9;              // an edge
constexpr double kSpacing = 1.0 / 300;       // [extents] of measured samples
constexpr int kLeastSamples = 12;            // a measured stroke
constexpr double kClaim = 0.2;  // share of a stroke that makes it part of an edge, or of the edge
constexpr double kOwn = 0.5;    // share of a stroke on nominal edges below which it is none
const double kSameWay = std::cos(25 * M_PI / 180);
// Beyond the end of a stroke the way to it is no longer square to the edge.
constexpr double kAskew = 0.3;

std::vector<EdgePlace> places_of(const Nominal& nominal, const NominalEdge& edge, double spacing) {
  std::vector<EdgePlace> out;
  const int wanted = std::max(kLeastPlaces, int(std::ceil(edge.length / spacing)) + 1);
  for (const int s : edge.strokes) {
    const double length = stroke_length(nominal.sketch, s);
    const bool closed = is_closed(nominal.sketch.strokes[s].kind);
    const int pieces =
        std::max(2, int(std::lround(wanted * length / edge.length)) - (closed ? 0 : 1));
    std::vector<double> fractions;
    for (int i = 0; i < pieces + (closed ? 0 : 1); ++i) fractions.push_back(double(i) / pieces);
    for (const double t : arc_length_parameters(nominal.sketch, s, fractions)) {
      EdgePlace p;
      Vector3d d;
      evaluate_stroke(nominal.sketch, s, t, &p.nominal, &d);
      p.tangent = d.stableNormalized();
      p.length = length / double(fractions.size());
      out.push_back(p);
    }
  }
  return out;
}

// Which measured strokes may belong to an edge: enough of the stroke, or of the edge, lies where
// no other edge is nearer.
class Claims {
 public:
  Claims(const Sketch& measured, const Nominal& nominal, double reach)
      : of_edge_(nominal.edges.size()), beside_(measured.size()) {
    const EdgeSamples samples = sample_edges(nominal.sketch, kSpacing * nominal.extent, 8);
    const SampleGrid grid(samples, reach);
    const EdgeSamples mine = sample_edges(measured, kSpacing * nominal.extent, kLeastSamples);
    for (int s = 0; s < measured.size(); ++s) {
      std::map<int, double> length_on;
      double total = 0, on = 0;
      for (int i = mine.first[s]; i < mine.first[s + 1]; ++i) {
        total += mine.length[i];
        const int near = grid.nearest(mine.position.col(i), mine.tangent.col(i), reach, kSameWay);
        if (near < 0) continue;
        on += mine.length[i];
        length_on[nominal.edge_of_stroke[samples.stroke[near]]] += mine.length[i];
      }
      beside_[s] = total > 0 ? on / total : 0;
      lengths_.push_back(total);
      for (const auto& [edge, length] : length_on)
        if (length > kClaim * std::min(total, nominal.edges[edge].length))
          of_edge_[edge].push_back(s);
    }
  }

  const std::vector<int>& of_edge(int edge) const { return of_edge_[edge]; }
  double beside(int stroke) const { return beside_[stroke]; }
  double length(int stroke) const { return lengths_[stroke]; }

 private:
  std::vector<std::vector<int>> of_edge_;
  std::vector<double> beside_, lengths_;
};

// The nearest of these strokes beside a place.
void find_measured(const Sketch& measured, const std::vector<int>& strokes, double reach,
                   EdgePlace* place) {
  double least = reach;
  for (const int s : strokes) {
    const ClosestPoint c = distance_to_stroke(measured, s, place->nominal);
    if (!(c.distance < least)) continue;
    Vector3d p, d;
    evaluate_stroke(measured, s, c.t, &p, &d);
    if (std::abs(d.stableNormalized().dot(place->tangent)) < kSameWay) continue;
    const Vector3d gap = p - place->nominal;
    const double along = std::abs(gap.dot(place->tangent));
    if (along > kAskew * gap.norm() && along > 0.5 * place->length) continue;
    least = c.distance;
    place->stroke = s;
    place->t = c.t;
    place->measured = p;
    place->deviation = gap - place->tangent * place->tangent.dot(gap);
  }
}

void judge(const AssociateOptions& options, EdgeMatch* match) {
  double total = 0, found = 0, visible = 0, needed = 0;
  std::set<int> strokes;
  for (const EdgePlace& p : match->places) {
    const bool is_visible = p.seen_by < 0 || p.seen_by >= options.least_views;
    total += p.length;
    if (is_visible) visible += p.length;
    if (p.stroke >= 0) found += p.length, strokes.insert(p.stroke);
    if (is_visible && p.stroke >= 0) needed += p.length;
  }
  match->strokes.assign(strokes.begin(), strokes.end());
  match->found = found / total;
  match->visible = visible / total;
  if (match->visible < kSome && match->found < kSome)
    match->presence = Presence::kNotVisible;
  else if (found >= kFound * total || (visible > 0 && needed >= kFound * visible))
    match->presence = Presence::kFound;
  else
    match->presence = match->found >= kSome ? Presence::kPartly : Presence::kMissing;
}

}  // namespace

const char* presence_name(Presence presence) {
  constexpr const char* kNames[] = {"found", "partly", "missing", "not visible"};
  return kNames[int(presence)];
}

std::vector<std::vector<EdgePlace>> nominal_places(const Nominal& nominal, double spacing) {
  std::vector<std::vector<EdgePlace>> out;
  for (const NominalEdge& e : nominal.edges)
    out.push_back(places_of(nominal, e, spacing * nominal.extent));
  return out;
}

std::vector<EdgePlace> places_beside(const EdgeMatch& match, int stroke, int most) {
  std::vector<EdgePlace> all, few;
  for (const EdgePlace& p : match.places)
    if (p.stroke == stroke) all.push_back(p);
  const int count = std::min(most, int(all.size()));
  for (int i = 0; i < count; ++i)
    few.push_back(all[count > 1 ? i * (all.size() - 1) / size_t(count - 1) : 0]);
  return few;
}

Association associate(const Sketch& measured, const Nominal& nominal,
                      const AssociateOptions& options,
                      const std::vector<std::vector<int>>& seen_by) {
  const double reach = options.reach * nominal.extent;
  const Claims claims(measured, nominal, reach);
  std::vector<std::vector<EdgePlace>> places = nominal_places(nominal, options.spacing);
  Association out;
  const int n = int(nominal.edges.size());
  out.edges.resize(n);
  parallel_for(n, 1, [&](int e) {
    EdgeMatch& match = out.edges[e];
    match.places = std::move(places[e]);
    for (size_t i = 0; i < match.places.size(); ++i) {
      if (!seen_by.empty()) match.places[i].seen_by = seen_by[e][i];
      find_measured(measured, claims.of_edge(e), reach, &match.places[i]);
    }
    judge(options, &match);
  });
  for (int s = 0; s < measured.size(); ++s)
    if (claims.beside(s) < kOwn) out.extras.push_back({s, claims.length(s), claims.beside(s)});
  return out;
}

}  // namespace sketchsplat

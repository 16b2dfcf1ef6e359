// SPDX-License-Identifier: MIT
#include "topology/solid/complete.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "topology/faces/find_planes.h"
#include "topology/solid/match_rims.h"
#include "topology/solid/round_candidates.h"

namespace sketchsplat {
namespace {

// Of bent strokes: chords stay within 3e-4 of a circle's radius.
constexpr int kPieces = 128;
// Lines make planes known, and these further lines: a slot's straight sides hang on its rulings.
constexpr int kRounds = 3;

// An end of an open stroke that nothing else ends in.
struct LooseEnd {
  int stroke, node;
};

std::vector<LooseEnd> loose_ends(const Sketch& sketch) {
  const std::vector<int> degree = node_degrees(sketch);
  std::vector<LooseEnd> out;
  for (int s = 0; s < sketch.size(); ++s) {
    const Stroke& stroke = sketch.strokes[s];
    if (is_closed(stroke.kind)) continue;
    if (degree[stroke.begin] == 1) out.push_back({s, stroke.begin});
    if (degree[stroke.end] == 1) out.push_back({s, stroke.end});
  }
  return out;
}

// Where the end of one stroke lies along another one, shortly before its end; NaN if it does not.
double overlap(const Sketch& sketch, const LooseEnd& end, const LooseEnd& other, double tolerance) {
  constexpr double kShort = 0.25;
  const ClosestPoint at = distance_to_stroke(sketch, other.stroke, sketch.nodes.col(end.node));
  const double before = sketch.strokes[other.stroke].begin == other.node ? at.t : 1 - at.t;
  return at.distance <= tolerance && before > 0 && before < kShort ? at.t : NAN;
}

// Two strokes that run past one another, each as the other one goes on, end where one of them did.
void cut_overlaps(double tolerance, Sketch* sketch) {
  const std::vector<LooseEnd> loose = loose_ends(*sketch);
  std::set<int> done;
  for (const LooseEnd& end : loose)
    for (const LooseEnd& other : loose) {
      if (end.stroke == other.stroke || done.count(end.node) || done.count(other.node)) continue;
      const double t = overlap(*sketch, end, other, tolerance);
      if (std::isnan(t) || std::isnan(overlap(*sketch, other, end, tolerance))) continue;
      Stroke& cut = sketch->strokes[other.stroke];
      const bool at_begin = cut.begin == other.node;
      const ControlPoints whole = control_points(*sketch, other.stroke);
      const ControlPoints piece =
          at_begin ? subcurve(cut.kind, whole, t, 1) : subcurve(cut.kind, whole, 0, t);
      for (int h = 0; h < num_handles(cut.kind); ++h)
        sketch->handles.col(cut.handle + h) = piece.p[h + 1];
      (at_begin ? cut.begin : cut.end) = end.node;
      done.insert({end.node, other.node});
    }
}

// An end that lies in the node of others shares it.
void weld(const LooseEnd& end, double tolerance, Sketch* sketch) {
  const Eigen::Vector3d place = sketch->nodes.col(end.node);
  Stroke& stroke = sketch->strokes[end.stroke];
  int& own = stroke.begin == end.node ? stroke.begin : stroke.end;
  const int far = other_end(stroke, end.node);
  for (const Stroke& s : sketch->strokes)
    for (const int node : {s.begin, s.end})
      if (node >= 0 && node != end.node && node != far &&
          (sketch->nodes.col(node) - place).norm() <= tolerance) {
        own = node;
        return;
      }
}

// A line that ends loose shortly before a plane of other strokes, or behind it, ends in it.
void extend_to_planes(double tolerance, double reach, Sketch* sketch) {
  const std::vector<Eigen::Matrix3Xd> polylines = polylines_of(*sketch, kPieces);
  const std::vector<PlaneStrokes> planes = find_planes(*sketch, polylines, tolerance);
  for (const LooseEnd& end : loose_ends(*sketch)) {
    if (sketch->strokes[end.stroke].kind != StrokeKind::kLine) continue;
    const Eigen::Vector3d direction = tangent_out(*sketch, end.stroke, end.node);
    double nearest = reach;
    const Eigen::Vector3d place = sketch->nodes.col(end.node);
    for (const PlaneStrokes& p : planes) {
      const double across = direction.dot(p.plane.normal);
      if (std::abs(across) < 0.5 || p.strokes.size() < 3) continue;
      const double along = (p.plane.origin - place).dot(p.plane.normal) / across;
      if (std::abs(along) >= std::abs(nearest)) continue;
      nearest = along;
    }
    if (std::abs(nearest) >= reach) continue;
    sketch->nodes.col(end.node) = place + nearest * direction;
    weld(end, tolerance, sketch);
  }
}

// Along a smooth rim a cylinder runs into a sphere or a torus, and nothing else begins there.
void keep_to_rounds(int begin, int end, std::vector<SurfaceStrokes>* surfaces) {
  const auto is_rim = [&](int s) { return s >= begin && s < end; };
  for (SurfaceStrokes& s : *surfaces)
    if (s.surface.kind == SurfaceKind::kPlane || s.surface.kind == SurfaceKind::kCone)
      s.strokes.erase(std::remove_if(s.strokes.begin(), s.strokes.end(), is_rim), s.strokes.end());
}

}  // namespace

void Completed::add(const EdgeOrigin& from, StrokeKind kind, int begin, int end,
                    const std::vector<Eigen::Vector3d>& handles) {
  sketch.add_stroke(kind, begin, end, handles);
  origin.push_back(from);
}

void Completed::add(const ImpliedStroke& s) {
  const EdgeOrigin faint = s.twin ? EdgeOrigin::kCopy : EdgeOrigin::kFaint;
  add(s.smooth ? EdgeOrigin::kSmooth : faint, s.kind, s.begin, s.end, s.handles);
}

void imply(double tolerance, double slide, Completed* all) {
  for (int round = 0;; ++round) {
    all->polylines = polylines_of(all->sketch, kPieces);
    all->surfaces = find_surfaces(all->sketch, all->polylines, tolerance);
    if (int(all->surfaces.size()) > all->most_surfaces) return;
    const std::vector<ImpliedStroke> implied =
        implied_strokes(all->seen, all->sketch, all->surfaces, tolerance, slide);
    if (implied.empty() || round == kRounds) break;
    for (const ImpliedStroke& s : implied) all->add(s);
  }
  keep_to_rounds(all->seen.size(), all->seen.size() + all->rims, &all->surfaces);
  for (SurfaceStrokes s : all->more) {
    s.strokes = strokes_on(s.surface, all->polylines, tolerance);
    all->surfaces.push_back(std::move(s));
  }
}

Completed complete(const Sketch& seen, const std::vector<ContourLine>& contours, double tolerance,
                   double slide, int most_surfaces) {
  Completed out;
  out.most_surfaces = most_surfaces;
  Sketch cut = seen;
  cut_overlaps(tolerance, &cut);
  extend_to_planes(tolerance, slide, &cut);
  MatchedRims matched = match_rims(cut, tolerance);
  out.seen = std::move(matched.sketch);
  out.now = std::move(matched.now);
  out.sketch = out.seen;
  out.origin.assign(out.seen.size(), EdgeOrigin::kSeen);
  out.polylines = polylines_of(out.sketch, kPieces);
  out.surfaces = find_surfaces(out.sketch, out.polylines, tolerance);
  if (int(out.surfaces.size()) > most_surfaces) return out;
  RoundCandidates round =
      round_candidates(out.sketch, out.polylines, out.surfaces, contours, tolerance);
  out.rims = int(round.rims.size());
  for (const auto* implied : {&round.rims, &matched.rulings})
    for (const ImpliedStroke& s : *implied) out.add(s);
  for (std::vector<SurfaceStrokes>* more : {&round.surfaces, &matched.surfaces})
    for (SurfaceStrokes& s : *more) out.more.push_back(std::move(s));
  imply(tolerance, slide, &out);
  return out;
}

}  // namespace sketchsplat

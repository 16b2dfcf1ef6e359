// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "topology/joint.h"
#include "topology/passes.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

bool near_box(const Vector3d& p, const CurveSamples& samples, double reach) {
  // Between its samples a curve leaves their box by a little.
  reach += 0.02 * samples.length;
  return ((p - samples.high).array() <= reach).all() && ((samples.low - p).array() <= reach).all();
}

// Share of the shorter curve's length that lies on the longer one; 0 as soon as it cannot be
// `least`.
double shared_length(const Piece& shorter, const Piece& longer, double distance, double angle_deg,
                     double least) {
  const CurveSamples& own = shorter.samples;
  const double least_cosine = std::cos(angle_deg * M_PI / 180);
  const int n = int(own.weight.size());
  double missing = 0;
  for (int i = 0; i < n; ++i) {
    const int k = i * 13 % n;  // all over the curve, so that most pairs are done after a few
    const Vector3d q = own.position.col(k);
    bool on = near_box(q, longer.samples, distance);
    if (on) {
      const Closest p = closest_point(longer.curve, longer.samples, q);
      on = p.distance <= distance && std::abs(p.tangent.dot(own.tangent.col(k))) >= least_cosine;
    }
    if (!on) missing += own.weight[k] / own.length;
    if (missing > 1 - least + 1e-9) return 0;
  }
  return 1 - missing;
}

// Where the samples of the shorter curve are on the longer one.
struct Places {
  VectorXd t;  // nearest parameter
  VectorXd s;  // arc length there; beyond an end it goes on with the distance from that end
};
Places places_on(const Piece& longer, const CurveSamples& own) {
  const VectorXd lengths = arc_lengths(longer.samples);
  const int n = int(own.weight.size());
  Places c{VectorXd(n), VectorXd(n)};
  for (int k = 0; k < n; ++k) {
    const Closest p = closest_point(longer.curve, longer.samples, own.position.col(k));
    c.t[k] = p.t;
    const double x = p.t * kPieces;
    const int i = std::min(int(x), kPieces - 1);
    c.s[k] = lengths[i] + (x - i) * (lengths[i + 1] - lengths[i]);
    const double beyond = std::abs((own.position.col(k) - p.position).dot(p.tangent));
    if (!longer.curve.closed() && p.t <= 0) c.s[k] -= beyond;
    if (!longer.curve.closed() && p.t >= 1) c.s[k] += beyond;
  }
  return c;
}

std::optional<PlainCurve> refit(StrokeKind kind, const Piece& longer, const Piece& shorter,
                                const Places& c) {
  const std::vector<Run> runs = {run_of(longer), run_of(shorter)};
  const bool closed = longer.curve.closed();
  const int n = int(longer.samples.weight.size());
  switch (kind) {
    case StrokeKind::kLine:
      return refit_line(runs);
    case StrokeKind::kArc:
      return refit_arc(runs, 0);
    case StrokeKind::kEllipticArc:
      return refit_elliptic_arc(runs, 0);
    case StrokeKind::kCircle:
      return closed ? refit_circle(joined(runs)) : std::nullopt;
    case StrokeKind::kBezier: {
      VectorXd s(n + c.s.size());
      s << arc_lengths(longer.samples), c.s;
      return closed ? std::nullopt : refit_bezier(joined(runs), s);
    }
    case StrokeKind::kEllipse: {
      VectorXd t(n + c.t.size());
      t << VectorXd::LinSpaced(n, 0, 1), c.t;
      return closed ? refit_ellipse(joined(runs), t) : std::nullopt;
    }
  }
  return std::nullopt;
}

// The old end nearest to where the union ends; one that other strokes share is preferred.
int end_node(const Draft& draft, const std::vector<int>& degrees, int a, int b, const Vector3d& at,
             double tolerance) {
  int best = -1;
  double least = INFINITY;
  for (int piece : {a, b})
    for (int node : {draft.pieces[piece].begin, draft.pieces[piece].end}) {
      if (node < 0) continue;
      double d = (draft.nodes[node] - at).norm();
      if (others_at(draft, degrees, node, a, b) > 0) d -= tolerance;
      if (d < least) {
        least = d;
        best = node;
      }
    }
  return best;
}

std::optional<Merge> propose(const Draft& draft, const std::vector<int>& degrees, int a, int b,
                             const TopologyOptions& options) {
  const double tolerance = options.overlap_px * options.footprint;
  const Piece& pa = draft.pieces[a];
  const Piece& pb = draft.pieces[b];
  const bool a_longer = pa.samples.length >= pb.samples.length;
  const Piece& longer = a_longer ? pa : pb;
  const Piece& shorter = a_longer ? pb : pa;
  const double share =
      shared_length(shorter, longer, tolerance, options.overlap_angle_deg, options.overlap_share);
  if (!(share >= options.overlap_share - 1e-9)) return std::nullopt;
  const JointLimits limits{
      tolerance, options.overlap_angle_deg,
      longer.samples.length + (1 - share) * shorter.samples.length + 2 * tolerance};
  const bool first = longer.support() >= shorter.support();
  const StrokeKind better = (first ? longer : shorter).curve.kind;
  const StrokeKind other = (first ? shorter : longer).curve.kind;
  const Places places = places_on(longer, shorter.samples);
  for (StrokeKind kind : {better, other}) {
    const auto fit = refit(kind, longer, shorter, places);
    if (!fit) continue;
    int begin = -1, end = -1;
    if (!fit->closed()) {
      begin = end_node(draft, degrees, a, b, fit->begin(), tolerance);
      end = end_node(draft, degrees, a, b, fit->end(), tolerance);
    }
    auto m = settle(draft, degrees, a, b, *fit, begin, end, limits);
    if (!m) continue;
    m->cost += 1 - share;
    return m;
  }
  return std::nullopt;
}

}  // namespace

PassResult merge_overlaps(const Sketch& sketch, const TopologyOptions& options) {
  Draft draft(sketch);
  merge_pairs(propose, options.overlap_px * options.footprint, options, &draft);
  return draft.finish();
}

}  // namespace sketchsplat

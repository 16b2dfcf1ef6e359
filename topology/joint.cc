// SPDX-License-Identifier: MIT
#include "topology/joint.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

Evidence merged(const Piece& a, const Piece& b) {
  const double wa = a.samples.length / (a.samples.length + b.samples.length), wb = 1 - wa;
  Evidence e;
  e.opacity = wa * a.evidence.opacity + wb * b.evidence.opacity;
  e.support_views = std::max(a.evidence.support_views, b.evidence.support_views);
  e.rms_px = std::sqrt(wa * a.evidence.rms_px * a.evidence.rms_px +
                       wb * b.evidence.rms_px * b.evidence.rms_px);
  e.sigma = wa * a.evidence.sigma + wb * b.evidence.sigma;
  return e;
}

void apply(const Merge& m, Draft* draft) {
  const Evidence evidence = merged(draft->pieces[m.a], draft->pieces[m.b]);
  draft->pieces[m.b].alive = false;
  draft->pieces[m.b].into = m.a;
  draft->pieces[m.a].evidence = evidence;
  draft->replace(m.a, m.curve, m.begin, m.end);
  ++draft->changes;
}

bool boxes_within(const CurveSamples& a, const CurveSamples& b, double reach) {
  // Between its samples a curve leaves their box by a little.
  const double slack = reach + 0.02 * std::min(a.length, b.length);
  return ((a.low - b.high).array() <= slack).all() && ((b.low - a.high).array() <= slack).all();
}

// Largest distance of a piece's samples from the curve; infinite if a tangent disagrees.
double deviation(const PlainCurve& curve, const CurveSamples& samples, const Piece& piece,
                 const JointLimits& limits) {
  const double least = std::cos(limits.angle_deg * M_PI / 180);
  double worst = 0;
  for (int k = 0; k < piece.samples.position.cols(); ++k) {
    const Closest c = closest_point(curve, samples, piece.samples.position.col(k));
    const double cosine = std::abs(c.tangent.dot(piece.samples.tangent.col(k)));
    const bool defined = c.tangent.norm() > 0.5 && piece.samples.tangent.col(k).norm() > 0.5;
    if (!(c.distance <= limits.distance) || (defined && cosine < least)) return INFINITY;
    worst = std::max(worst, c.distance);
  }
  return worst;
}

std::vector<Merge> proposals(Propose propose, double reach, const TopologyOptions& options,
                             const Draft& draft) {
  const std::vector<int> degrees = draft.degrees();
  std::vector<Merge> found;
  for (int a = 0; a < draft.size(); ++a) {
    if (!draft.pieces[a].alive) continue;
    for (int b = a + 1; b < draft.size(); ++b) {
      if (!draft.pieces[b].alive) continue;
      if (!boxes_within(draft.pieces[a].samples, draft.pieces[b].samples, reach)) continue;
      if (auto m = propose(draft, degrees, a, b, options)) found.push_back(*m);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Merge& x, const Merge& y) { return x.cost < y.cost; });
  return found;
}

}  // namespace

int others_at(const Draft& draft, const std::vector<int>& degrees, int node, int a, int b) {
  int n = degrees[node];
  for (int piece : {a, b}) {
    n -= draft.pieces[piece].begin == node;
    n -= draft.pieces[piece].end == node;
  }
  return n;
}

std::optional<Merge> settle(const Draft& draft, const std::vector<int>& degrees, int a, int b,
                            const PlainCurve& fit, int begin, int end, const JointLimits& limits) {
  Merge m;
  m.a = a;
  m.b = b;
  m.curve = fit;
  if (!fit.closed()) {
    m.begin = begin;
    m.end = end;
    Vector3d p0 = fit.begin(), p1 = fit.end();
    if (begin == end) p0 = p1 = (p0 + p1) / 2;
    if (others_at(draft, degrees, begin, a, b) > 0) p0 = draft.nodes[begin];
    if (others_at(draft, degrees, end, a, b) > 0) p1 = draft.nodes[end];
    m.curve = move_ends(fit, p0, p1);
  }
  if (!is_sound(m.curve)) return std::nullopt;
  const CurveSamples samples = sample_curve(m.curve);
  if (!(samples.length <= limits.max_length)) return std::nullopt;
  const double d = std::max(deviation(m.curve, samples, draft.pieces[a], limits),
                            deviation(m.curve, samples, draft.pieces[b], limits));
  if (!(d <= limits.distance)) return std::nullopt;
  m.cost = limits.distance > 0 ? d / limits.distance : 0;
  return m;
}

Run run_of(const Piece& piece) {
  return {piece.samples.position, piece.samples.weight * piece.trust()};
}

Run reversed(const Run& run) { return {run.position.rowwise().reverse(), run.weight.reverse()}; }

Eigen::VectorXd arc_lengths(const CurveSamples& samples) {
  // The end samples carry half the weight of their step, the others half of either side.
  const Eigen::VectorXd& w = samples.weight;
  Eigen::VectorXd s(w.size());
  double sum = 0;
  for (int k = 0; k < w.size(); ++k) {
    const bool edge = k == 0 || k == w.size() - 1;
    s[k] = edge ? (k == 0 ? 0 : samples.length) : sum + w[k] / 2;
    sum += w[k];
  }
  return s;
}

void merge_pairs(Propose propose, double reach, const TopologyOptions& options, Draft* draft) {
  for (bool any = true; any;) {
    any = false;
    std::vector<bool> touched(draft->size());
    for (const Merge& m : proposals(propose, reach, options, *draft)) {
      if (touched[m.a] || touched[m.b]) continue;
      // Merges before this one may have changed what else ends there.
      const auto again = propose(*draft, draft->degrees(), m.a, m.b, options);
      if (!again) continue;
      apply(*again, draft);
      touched[m.a] = touched[m.b] = any = true;
    }
  }
}

}  // namespace sketchsplat

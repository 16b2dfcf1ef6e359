// SPDX-License-Identifier: MIT
#include "topology/core/joint.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "topology/core/description.h"

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
  Eigen::Matrix3Xd points(3, draft->pieces[m.a].points.cols() + draft->pieces[m.b].points.cols());
  points << draft->pieces[m.a].points, draft->pieces[m.b].points;
  draft->pieces[m.a].points = points;
  draft->replace(m.a, m.curve, m.begin, m.end);
  ++draft->changes;
}

bool boxes_within(const CurveSamples& a, const CurveSamples& b, double reach) {
  // Between its samples a curve leaves their box by a little.
  const double slack = reach + 0.02 * std::min(a.length, b.length);
  return ((a.low - b.high).array() <= slack).all() && ((b.low - a.high).array() <= slack).all();
}

// How many nodes of two pieces are of no use once one curve between two of them, or a closed one,
// takes their place.
int nodes_lost(const Draft& draft, const std::vector<int>& degrees, const Merge& m) {
  std::set<int> nodes;
  for (int piece : {m.a, m.b})
    for (int node : {draft.pieces[piece].begin, draft.pieces[piece].end})
      if (node >= 0 && node != m.begin && node != m.end &&
          others_at(draft, degrees, node, m.a, m.b) == 0)
        nodes.insert(node);
  return int(nodes.size());
}

// [nat] by which the description grows.
double growth(const Draft& draft, const std::vector<int>& degrees, const Merge& m,
              const TopologyOptions& options) {
  const Piece &a = draft.pieces[m.a], &b = draft.pieces[m.b];
  const int parameters =
      own_parameters(m.curve.kind) - own_parameters(a.curve.kind) - own_parameters(b.curve.kind);
  return options.price * parameters - options.node_price * nodes_lost(draft, degrees, m) +
         misfit(m.curve, a.points, options) + misfit(m.curve, b.points, options) -
         misfit(a.curve, a.points, options) - misfit(b.curve, b.points, options);
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
                            const PlainCurve& fit, int begin, int end, double max_length,
                            const TopologyOptions& options) {
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
  if (!(sample_curve(m.curve).length <= max_length)) return std::nullopt;
  m.cost = growth(draft, degrees, m, options);
  if (!(m.cost < 0)) return std::nullopt;
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

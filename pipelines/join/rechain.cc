// SPDX-License-Identifier: MIT
#include "pipelines/join/rechain.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/parallel.h"
#include "pipelines/survey/observe.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kGain = 1;  // [nat] below which nothing changes

// One stroke of a chain, and whether the chain runs through it backwards.
struct Link {
  int stroke = -1;
  bool backward = false;
};
struct Chain {
  std::vector<Link> links;
  bool closed = false;
};

// An end of a stroke: where it is and which way it leaves the stroke.
struct End {
  Vector3d point, outward;
  int node = -1;
  bool open = false;  // may be continued
};

// Ends 2 s and 2 s + 1 are the begin and the end of stroke s.
std::vector<End> ends_of(const Sketch& sketch) {
  const std::vector<int> degree = node_degrees(sketch);
  std::vector<End> ends(2 * sketch.size());
  for (int s = 0; s < sketch.size(); ++s) {
    const Stroke& stroke = sketch.strokes[s];
    if (is_closed(stroke.kind) || stroke.begin == stroke.end) continue;
    for (int k = 0; k < 2; ++k) {
      End& e = ends[2 * s + k];
      Vector3d d;
      evaluate_stroke(sketch, s, k, &e.point, &d);
      e.outward = (k == 0 ? -1 : 1) * d.normalized();
      e.node = k == 0 ? stroke.begin : stroke.end;
      e.open = degree[e.node] <= 2 && e.outward.allFinite();
    }
  }
  return ends;
}

// How well two ends continue one another: their distance, or infinity.
double continuation(const End& x, const End& y, const std::vector<int>& degree, double gap,
                    double cosine) {
  if (!x.open || !y.open) return INFINITY;
  if (x.node != y.node && (degree[x.node] > 1 || degree[y.node] > 1)) return INFINITY;
  const Vector3d step = y.point - x.point;
  const double distance = step.norm();
  if (distance > gap || x.outward.dot(-y.outward) < cosine) return INFINITY;
  const double aside = (step - step.dot(x.outward) * x.outward).norm();
  return aside <= 0.25 * gap + 0.2 * distance ? distance : INFINITY;
}

// The end that continues each end; -1 if none does, or if the choice is not mutual.
std::vector<int> partners(const Sketch& sketch, const std::vector<End>& ends, double gap,
                          double cosine) {
  const std::vector<int> degree = node_degrees(sketch);
  const int n = int(ends.size());
  std::vector<int> best(n, -1);
  for (int i = 0; i < n; ++i) {
    double least = INFINITY;
    for (int j = 0; j < n; ++j) {
      if (j / 2 == i / 2) continue;
      const double d = continuation(ends[i], ends[j], degree, gap, cosine);
      if (d < least) least = d, best[i] = j;
    }
  }
  std::vector<int> mutual(n, -1);
  for (int i = 0; i < n; ++i)
    if (best[i] >= 0 && best[best[i]] == i) mutual[i] = best[i];
  return mutual;
}

std::vector<Chain> chains_of(const Sketch& sketch, const std::vector<int>& partner) {
  std::vector<Chain> chains;
  std::vector<char> used(sketch.size());
  const auto walk = [&](int start, Chain* chain) {  // `start`: the end that the chain begins with
    int in = start;
    while (true) {
      used[in / 2] = 1;
      chain->links.push_back({in / 2, in % 2 == 1});
      const int next = partner[in ^ 1];
      if (next < 0) return;
      if (used[next / 2]) {
        chain->closed = next == start;
        return;
      }
      in = next;
    }
  };
  for (bool loops : {false, true})
    for (int s = 0; s < sketch.size(); ++s) {
      if (used[s] || is_closed(sketch.strokes[s].kind)) continue;
      if (!loops && partner[2 * s] >= 0 && partner[2 * s + 1] >= 0) continue;
      chains.emplace_back();
      walk(loops || partner[2 * s] < 0 ? 2 * s : 2 * s + 1, &chains.back());
    }
  return chains;
}

// Where the edgels of all views put the samples of a stroke, in the order of the chain.
struct Places {
  std::vector<Vector3d> point, tangent;
  std::vector<double> distance;  // from the stroke
};
Places placed(const Observation& o, const Link& link, double footprint) {
  Places out;
  const Measured m = measure(o, link.stroke, footprint);
  const int first = o.layout.first[link.stroke], n = int(m.placed.size());
  for (int j = 0; j < n; ++j) {
    const int k = link.backward ? n - 1 - j : j;
    if (!m.placed[k]) continue;
    out.point.push_back(m.point.col(k));
    out.tangent.push_back(o.samples.tangent.col(first + k));
    out.distance.push_back((m.point.col(k) - o.samples.position.col(first + k)).norm());
  }
  return out;
}

// A chain as one run of points, and the length of its present description.
struct ChainRun {
  Matrix3Xd point, tangent;
  double cost = 0;
};
ChainRun run_of(const Sketch& sketch, const Observation& o, const Chain& chain, double sigma,
                double footprint, const SegmentOptions& options) {
  ChainRun run;
  std::vector<Vector3d> points, tangents;
  for (const Link& link : chain.links) {
    const Places m = placed(o, link, footprint);
    points.insert(points.end(), m.point.begin(), m.point.end());
    tangents.insert(tangents.end(), m.tangent.begin(), m.tangent.end());
    run.cost +=
        description_length(Eigen::Map<const Eigen::VectorXd>(m.distance.data(), m.distance.size()),
                           sigma, sketch.strokes[link.stroke].kind, options);
  }
  for (size_t k = 0; k + 1 < chain.links.size(); ++k)
    run.cost += joint_cost(sketch.strokes[chain.links[k].stroke].kind,
                           sketch.strokes[chain.links[k + 1].stroke].kind, options);
  run.point.resize(3, points.size());
  run.tangent.resize(3, points.size());
  for (size_t i = 0; i < points.size(); ++i)
    run.point.col(i) = points[i], run.tangent.col(i) = tangents[i];
  return run;
}

// The pieces that say the same in fewer words; empty if there are none.
std::vector<RunPiece> shorter(const Sketch& sketch, const Observation& o, const Chain& chain,
                              double sigma, double footprint, const SegmentOptions& options) {
  const bool plain =
      chain.links.size() == 1 && sketch.strokes[chain.links[0].stroke].kind == StrokeKind::kLine;
  if (plain) return {};
  const ChainRun run = run_of(sketch, o, chain, sigma, footprint, options);
  if (run.point.cols() < 2 * options.min_points) return {};
  std::vector<RunPiece> pieces =
      cut_run(run.point, run.tangent, chain.closed, sigma, footprint, options);
  double cost = 0;
  for (const RunPiece& piece : pieces) {
    if (!piece.fit.ok()) return {};
    cost += piece.cost;
  }
  if (pieces.empty() || !(cost < run.cost - kGain)) return {};
  return pieces;
}

// Of a fit that is tied to nodes near its ends. The handles of an elliptic arc belong to its ends:
// it keeps its ellipse.
std::vector<Vector3d> handles_between(const RunFit& fit, const Vector3d& begin,
                                      const Vector3d& end) {
  if (fit.kind != StrokeKind::kEllipticArc) return fit.handles;
  ControlPoints c;
  c.p = {fit.begin, fit.handles[0], fit.handles[1], fit.end}, c.count = 4;
  c = elliptic_arc_between(c, begin, end);
  return {c.p[1], c.p[2]};
}

// Copies strokes with their nodes into a new sketch.
class Rebuilder {
 public:
  explicit Rebuilder(const Sketch& from) : from_(from), node_(from.nodes.cols(), -1) {}

  int node(int old) {
    if (node_[old] < 0) node_[old] = out.add_node(from_.nodes.col(old));
    return node_[old];
  }
  void copy(int s) {
    const Stroke& stroke = from_.strokes[s];
    std::vector<Vector3d> handles;
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      handles.push_back(from_.handles.col(stroke.handle + h));
    const bool closed = is_closed(stroke.kind);
    const int b = closed ? -1 : node(stroke.begin), e = closed ? -1 : node(stroke.end);
    out.add_stroke(stroke.kind, b, e, handles, from_.evidence[s]);
  }
  void describe(const Chain& chain, const std::vector<RunPiece>& pieces) {
    const int n = int(pieces.size());
    const auto is_open = [&](int k) { return !is_closed(pieces[k].fit.kind); };
    const Link &head = chain.links.front(), &tail = chain.links.back();
    const Stroke &a = from_.strokes[head.stroke], &z = from_.strokes[tail.stroke];
    // Joint k lies before piece k. A closed piece has no ends.
    std::vector<int> joints(n, -1);
    const auto joint = [&](int k) {
      if (!chain.closed && k == 0) return node(head.backward ? a.end : a.begin);
      if (!chain.closed && k == n) return node(tail.backward ? z.begin : z.end);
      int& made = joints[k % n];
      if (made >= 0) return made;
      const RunFit &before = pieces[(k + n - 1) % n].fit, &after = pieces[k % n].fit;
      const bool both = !is_closed(before.kind) && !is_closed(after.kind);
      made = out.add_node(both                     ? Vector3d(0.5 * (before.end + after.begin))
                          : is_closed(before.kind) ? after.begin
                                                   : before.end);
      return made;
    };
    for (int k = 0; k < n; ++k) {
      const RunFit& fit = pieces[k].fit;
      if (!is_open(k)) {
        out.add_stroke(fit.kind, -1, -1, fit.handles);
        continue;
      }
      const int begin = joint(k), end = joint(k + 1);
      out.add_stroke(fit.kind, begin, end,
                     handles_between(fit, out.nodes.col(begin), out.nodes.col(end)));
    }
  }
  Sketch out;

 private:
  const Sketch& from_;
  std::vector<int> node_;
};

}  // namespace

Rechained rechain(const Sketch& sketch, const EdgeWorld& world, const SegmentOptions& segment,
                  const RechainOptions& options) {
  const Observation o = observe_places(sketch, world);
  const double sigma = place_sigma_px(o, options.sigma_px) * world.footprint;
  const std::vector<End> ends = ends_of(sketch);
  const std::vector<Chain> chains =
      chains_of(sketch, partners(sketch, ends, options.gap_px * world.footprint,
                                 std::cos(options.turn_deg * M_PI / 180)));
  std::vector<std::vector<RunPiece>> pieces(chains.size());
  parallel_for(int(chains.size()), 1, [&](int c) {
    pieces[c] = shorter(sketch, o, chains[c], sigma, world.footprint, segment);
  });
  Rechained result;
  Rebuilder rebuild(sketch);
  for (int s = 0; s < sketch.size(); ++s)
    if (is_closed(sketch.strokes[s].kind)) rebuild.copy(s);
  for (size_t c = 0; c < chains.size(); ++c) {
    if (pieces[c].empty()) {
      for (const Link& link : chains[c].links) rebuild.copy(link.stroke);
      continue;
    }
    rebuild.describe(chains[c], pieces[c]);
    ++result.changes;
  }
  result.sketch = rebuild.out;
  return result;
}

}  // namespace sketchsplat

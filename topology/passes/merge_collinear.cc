// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "topology/core/description.h"
#include "topology/core/joint.h"
#include "topology/core/passes.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// One end of a piece.
struct End {
  int piece;
  bool at_end;
};

int node_of(const Draft& draft, End e) {
  return e.at_end ? draft.pieces[e.piece].end : draft.pieces[e.piece].begin;
}
const Vector3d& point_of(const Draft& draft, End e) { return draft.nodes[node_of(draft, e)]; }
End opposite(End e) { return {e.piece, !e.at_end}; }

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double l2 = (b - a).squaredNorm();
  const double t = l2 > 0 ? std::clamp((p - a).dot(b - a) / l2, 0.0, 1.0) : 0;
  return (a + t * (b - a) - p).norm();
}

struct Context {
  const Draft& draft;
  const std::vector<int>& degrees;
  const TopologyOptions& options;
  int a, b;
  double px(double n) const { return n * options.footprint; }
  const Piece& piece(int i) const { return draft.pieces[i]; }
};

// True if nothing else ends where x and y would vanish, nor in the gap between them.
bool is_free(const Context& c, End x, End y) {
  const int nx = node_of(c.draft, x), ny = node_of(c.draft, y);
  if (others_at(c.draft, c.degrees, nx, c.a, c.b) > 0) return false;
  if (others_at(c.draft, c.degrees, ny, c.a, c.b) > 0) return false;
  const Vector3d &px = c.draft.nodes[nx], &py = c.draft.nodes[ny];
  const bool gap = (py - px).norm() <= c.px(c.options.gap_px);
  const int far_x = node_of(c.draft, opposite(x)), far_y = node_of(c.draft, opposite(y));
  for (int n = 0; n < int(c.draft.nodes.size()); ++n) {
    if (n == nx || n == ny || n == far_x || n == far_y || c.degrees[n] == 0) continue;
    const Vector3d& p = c.draft.nodes[n];
    const double d =
        gap ? distance_to_segment(p, px, py) : std::min((p - px).norm(), (p - py).norm());
    if (d <= c.px(c.options.endpoint_px)) return false;
  }
  return true;
}

// A bound on the union, which might else go round the other way.
double longest(const Context& c, int gaps) {
  return c.piece(c.a).samples.length + c.piece(c.b).samples.length +
         (gaps + 1) * c.px(c.options.gap_px);
}

// Ties a fit to the far ends of the two pieces; x and y are the ends that vanish.
std::optional<Merge> tie(const Context& c, PlainCurve fit, End x, End y) {
  const End u = opposite(x), v = opposite(y);
  if (fit.closed()) {
    // Closed by two gaps: the far ends vanish too.
    if (!is_free(c, u, v)) return std::nullopt;
    return settle(c.draft, c.degrees, c.a, c.b, fit, -1, -1, longest(c, 2), c.options);
  }
  const Vector3d pu = point_of(c.draft, u), pv = point_of(c.draft, v);
  const double as_is = (fit.begin() - pu).norm() + (fit.end() - pv).norm();
  const double swapped = (fit.begin() - pv).norm() + (fit.end() - pu).norm();
  if (swapped < as_is) fit = backwards(fit);
  return settle(c.draft, c.degrees, c.a, c.b, fit, node_of(c.draft, u), node_of(c.draft, v),
                longest(c, 1), c.options);
}

std::optional<Merge> join_lines(const Context& c) {
  const bool a_longer = c.piece(c.a).samples.length >= c.piece(c.b).samples.length;
  const int longer = a_longer ? c.a : c.b, shorter = a_longer ? c.b : c.a;
  const PlainCurve &l = c.piece(longer).curve, &s = c.piece(shorter).curve;
  const double length = (l.end() - l.begin()).norm();
  const Vector3d axis = (l.end() - l.begin()) / length;
  const Vector3d d0 = s.begin() - l.begin(), d1 = s.end() - l.begin();
  const double x0 = d0.dot(axis), x1 = d1.dot(axis);
  const double offset = std::max((d0 - axis * x0).norm(), (d1 - axis * x1).norm());
  if (!(offset <= c.px(c.options.offset_px))) return std::nullopt;
  const double low = std::min(x0, x1), high = std::max(x0, x1);
  const double gap = std::max(low - length, -high);
  if (gap > c.px(c.options.gap_px)) return std::nullopt;
  if (low >= 0 && high <= length) return std::nullopt;  // drawn twice: not ours
  const bool after = high - length > -low;  // which end of the longer line is passed by more
  const End x{longer, after}, y{shorter, after ? x1 < x0 : x1 > x0};
  if (!is_free(c, x, y)) return std::nullopt;
  const auto fit = refit_line({run_of(c.piece(c.a)), run_of(c.piece(c.b))});
  return fit ? tie(c, *fit, x, y) : std::nullopt;
}

// Pairs of ends (one of either piece), nearest first.
std::vector<std::pair<End, End>> facing_ends(const Context& c) {
  std::vector<std::pair<End, End>> out;
  for (bool x : {false, true})
    for (bool y : {false, true}) out.push_back({{c.a, x}, {c.b, y}});
  std::stable_sort(out.begin(), out.end(), [&](const auto& p, const auto& q) {
    return (point_of(c.draft, p.first) - point_of(c.draft, p.second)).norm() <
           (point_of(c.draft, q.first) - point_of(c.draft, q.second)).norm();
  });
  return out;
}

// True if an end of one piece is so near to the other that they may continue one another.
bool touch(const Context& c) {
  for (int own : {c.a, c.b}) {
    const Piece &p = c.piece(own), &q = c.piece(own == c.a ? c.b : c.a);
    for (const Vector3d& end : {p.curve.begin(), p.curve.end()})
      if (closest_point(q.curve, q.samples, end).distance <= c.px(c.options.gap_px)) return true;
  }
  return false;
}

std::optional<Merge> join_arcs(const Context& c) {
  if (!touch(c)) return std::nullopt;
  const auto fit = refit_arc({run_of(c.piece(c.a)), run_of(c.piece(c.b))}, c.px(c.options.gap_px));
  if (!fit) return std::nullopt;
  // The ends of the union must come from different pieces, else one arc lies on the other.
  const auto pairs = facing_ends(c);
  std::pair<End, End> lost = pairs[0];
  if (!fit->closed()) {
    double least = INFINITY;
    for (const auto& p : pairs) {
      const Vector3d u = point_of(c.draft, opposite(p.first));
      const Vector3d v = point_of(c.draft, opposite(p.second));
      const double d = std::min((u - fit->begin()).norm() + (v - fit->end()).norm(),
                                (v - fit->begin()).norm() + (u - fit->end()).norm());
      if (d < least) {
        least = d;
        lost = p;
      }
    }
    if (!(least <= c.px(c.options.gap_px))) return std::nullopt;
  }
  if (!is_free(c, lost.first, lost.second)) return std::nullopt;
  return tie(c, *fit, lost.first, lost.second);
}

// Arc length from the end x of one piece to the begin y of the next, negative if they overlap;
// NaN if they do not continue one another.
double step_between(const Context& c, End x, End y) {
  const Piece &a = c.piece(x.piece), &b = c.piece(y.piece);
  const Vector3d px = point_of(c.draft, x), py = point_of(c.draft, y);
  const Vector3d tx = outward_tangent(a.curve, x.at_end), ty = outward_tangent(b.curve, y.at_end);
  const double gap = (py - px).norm();
  if (gap <= c.px(c.options.gap_px)) {
    // Coarse: the tangents of both are compared with the fit later on.
    if (tx.dot(-ty) < 0.8) return NAN;
    return (py - px).dot(tx) >= 0 ? gap : -gap;
  }
  const Closest on_b = closest_point(b.curve, b.samples, px);
  const Closest on_a = closest_point(a.curve, a.samples, py);
  const double offset = c.px(c.options.offset_px);
  if (on_a.distance > offset || on_b.distance > offset) return NAN;
  const double inside_a = x.at_end ? 1 - on_a.t : on_a.t;
  const double inside_b = y.at_end ? 1 - on_b.t : on_b.t;
  // Out of a into b: both run the same way where they overlap.
  if (tx.dot(on_b.tangent) * (y.at_end ? -1 : 1) < 0.8) return NAN;
  if (inside_a > 0.9 || inside_b > 0.9) return NAN;
  return -std::min(inside_a * a.samples.length, inside_b * b.samples.length);
}

std::optional<Merge> continue_curve(const Context& c, End x, End y, double step, StrokeKind kind) {
  const Piece &a = c.piece(x.piece), &b = c.piece(y.piece);
  const Run ra = x.at_end ? run_of(a) : reversed(run_of(a));
  const Run rb = y.at_end ? reversed(run_of(b)) : run_of(b);
  std::optional<PlainCurve> fit;
  if (kind == StrokeKind::kBezier) {
    VectorXd sa = arc_lengths(a.samples), sb = arc_lengths(b.samples);
    if (!x.at_end) sa = (a.samples.length - sa.reverse().array()).eval();
    if (y.at_end) sb = (b.samples.length - sb.reverse().array()).eval();
    VectorXd s(sa.size() + sb.size());
    s << sa, sb.array() + a.samples.length + step;
    fit = refit_bezier(joined({ra, rb}), s);
  } else if (kind == StrokeKind::kEllipticArc) {
    fit = refit_elliptic_arc({ra, rb}, c.px(c.options.gap_px));
  } else {
    fit = refit_arc({ra, rb}, c.px(c.options.gap_px));
  }
  return fit ? tie(c, *fit, x, y) : std::nullopt;
}

std::optional<Merge> join_curves(const Context& c) {
  if (!touch(c)) return std::nullopt;
  // An arc, or what one of the two is.
  std::vector<StrokeKind> kinds = {StrokeKind::kArc};
  for (StrokeKind kind : {StrokeKind::kEllipticArc, StrokeKind::kBezier})
    if (c.piece(c.a).curve.kind == kind || c.piece(c.b).curve.kind == kind) kinds.push_back(kind);
  std::optional<Merge> best;
  for (const auto& [x, y] : facing_ends(c)) {
    const double step = step_between(c, x, y);
    if (std::isnan(step) || !is_free(c, x, y)) continue;
    for (StrokeKind kind : kinds) {
      const auto m = continue_curve(c, x, y, step, kind);
      if (m && (!best || m->cost < best->cost)) best = m;
    }
  }
  return best;
}

std::optional<Merge> propose(const Draft& draft, const std::vector<int>& degrees, int a, int b,
                             const TopologyOptions& options) {
  const Piece &pa = draft.pieces[a], &pb = draft.pieces[b];
  if (pa.curve.closed() || pb.curve.closed()) return std::nullopt;
  if (pa.begin == pa.end || pb.begin == pb.end) return std::nullopt;
  const Context c{draft, degrees, options, a, b};
  if (pa.curve.kind == StrokeKind::kLine && pb.curve.kind == StrokeKind::kLine)
    return join_lines(c);
  if (pa.curve.kind == StrokeKind::kArc && pb.curve.kind == StrokeKind::kArc) return join_arcs(c);
  return join_curves(c);
}

}  // namespace

PassResult merge_collinear(const Sketch& sketch, const TopologyOptions& options,
                           const StrokePoints& points) {
  Draft draft(sketch, points.empty() ? drawn_points(sketch, options) : points);
  merge_pairs(propose, options.gap_px * options.footprint, options, &draft);
  return draft.finish();
}

}  // namespace sketchsplat

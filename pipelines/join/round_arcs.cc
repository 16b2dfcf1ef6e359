// SPDX-License-Identifier: MIT
#include "pipelines/join/round_arcs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/fit/ellipse_run.h"
#include "sketches/fit/fit.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kPoints = 32;  // along a stroke, for a fit to more than one

// Of a closed curve, by its parameter: from `begin` in [0, 1) on.
struct Span {
  double begin, length;
};

// What two spans leave of a closed curve.
std::vector<Span> rest_of(Span a, Span b) {
  const auto from = [](double begin, double end) { return end - begin - std::floor(end - begin); };
  std::vector<Span> out;
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, a)}) {
    const double end = p.begin + p.length;
    if (from(q.begin, end) >= q.length)
      out.push_back({end, std::min(from(end, p.begin), from(end, q.begin))});
  }
  return out;
}

class Rounder {
 public:
  Rounder(const Sketch& sketch, const EdgeWorld& world, const RoundOptions& options,
          Described* described)
      : s_(sketch),
        world_(world),
        options_(options),
        cost_(described->cost),
        points_(described->points),
        alive_(sketch.size(), true) {}

  void round_arcs();
  void round_facing_arcs();
  void round_elliptic_arcs();
  void ellipses_to_circles();
  void absorb_doubles();
  Sketch finish() {
    StrokePoints kept;
    for (int i = 0; i < s_.size(); ++i)
      if (alive_[i]) kept.push_back(points_[i]);
    points_ = std::move(kept);
    return keep_strokes(s_, alive_);
  }
  int rounded() const { return rounded_; }

 private:
  bool is_open(int i) const { return alive_[i] && !is_closed(s_.strokes[i].kind); }
  int node_of(int stroke, bool at_end) const {
    return at_end ? s_.strokes[stroke].end : s_.strokes[stroke].begin;
  }
  // What it does to the description [nat] that strokes a and b, which may be the same, become a
  // closed one; `gap` is what it costs to go on between their loose ends.
  double growth(int a, int b, double gap, const PlainCurve& curve) const {
    const std::set<int> parts = {a, b};
    double sum = gap + misfit(curve, points_of(points_, parts), cost_) +
                 cost_.price * own_parameters(curve.kind);
    std::set<int> nodes;
    for (int i : parts) {
      const Stroke& s = s_.strokes[i];
      sum -= misfit(plain_curve(s_, i), points_[i], cost_);
      sum -= cost_.price * own_parameters(s.kind);
      if (!is_closed(s.kind)) nodes.insert({s.begin, s.end});
    }
    return sum - cost_.node_price * double(nodes.size());
  }
  void replace(int a, int b, const PlainCurve& curve) {
    alive_[a] = alive_[b] = false;
    alive_.push_back(true);
    points_.push_back(points_of(points_, {a, b}));
    const std::vector<Vector3d> handles(curve.p.begin(), curve.p.begin() + curve.size());
    s_.add_stroke(curve.kind, -1, -1, handles, Evidence(s_.evidence[a]));
  }
  double rest_cost(const PlainCurve& curve, const Matrix3Xd& points, double share) const;
  void round_ellipse(int a, bool a_back, int b, bool b_back);
  void round_facing(int a, int b);
  Span span_on(const PlainCurve& circle, const CurveSamples& samples, int arc) const;

  Sketch s_;
  const EdgeWorld& world_;
  const RoundOptions& options_;
  const DescriptionCost& cost_;
  StrokePoints& points_;
  std::vector<bool> alive_;
  int rounded_ = 0;
};

void Rounder::round_arcs() {
  const std::vector<int> degree = node_degrees(s_);
  for (int i = 0; i < s_.size(); ++i) {
    const Stroke stroke = s_.strokes[i];
    if (!is_open(i) || stroke.kind != StrokeKind::kArc) continue;
    if (degree[stroke.begin] != 1 || degree[stroke.end] != 1) continue;
    const CircleParameters c = circle_parameters(s_, i);
    if (c.straight || c.angle < options_.least_turn * 2 * M_PI) continue;
    const double gap = (2 * M_PI - c.angle) * c.radius;
    const double t1 = 2 * M_PI / c.angle;
    const double cost =
        gap_cost(stroke.kind, control_points(s_, i), 1, t1, gap, world_, options_.gap);
    const PlainCurve circle = circle_of_arc(plain_curve(s_, i));
    if (!(growth(i, i, cost, circle) < 0)) continue;
    replace(i, i, circle);
    ++rounded_;
  }
}

// Most of an ellipse, or of a circle, in one arc or in two that go on from one another, is all of
// it.
void Rounder::round_elliptic_arcs() {
  const std::vector<int> degree = node_degrees(s_);
  for (int a = 0; a < s_.size(); ++a)
    for (int b = a; b < s_.size(); ++b) {
      const auto is_part = [&](int i) {
        const StrokeKind kind = s_.strokes[i].kind;
        return is_open(i) &&
               (kind == StrokeKind::kEllipticArc || (a != b && kind == StrokeKind::kArc));
      };
      if (!is_part(a) || !is_part(b)) continue;
      const Stroke &sa = s_.strokes[a], &sb = s_.strokes[b];
      if (a == b && (degree[sa.begin] != 1 || degree[sa.end] != 1)) continue;
      // Two must share one node and nobody else any.
      const bool a_end = sa.end == sb.begin || sa.end == sb.end;
      const bool b_end = sb.end == sa.begin || sb.end == sa.end;
      if (a != b && (node_of(a, a_end) != node_of(b, b_end) || degree[node_of(a, a_end)] != 2 ||
                     degree[node_of(a, !a_end)] != 1 || degree[node_of(b, !b_end)] != 1))
        continue;
      round_ellipse(a, !a_end, b, b_end);
    }
}

void Rounder::round_ellipse(int a, bool a_back, int b, bool b_back) {
  Matrix3Xd points(3, a == b ? kPoints : 2 * kPoints - 1);
  Vector3d d;
  for (int k = 0; k < points.cols(); ++k) {
    const double t = double(k % (kPoints - 1)) / (kPoints - 1);
    const bool first = k < kPoints - 1 || (a == b && k == kPoints - 1);
    const double u = k == points.cols() - 1 ? 1 : t;
    Vector3d p;
    evaluate_stroke(s_, first ? a : b, (first ? a_back : b_back) ? 1 - u : u, &p, &d);
    points.col(k) = p;
  }
  const EllipseRun fit = ellipse_along(points);
  const double gap = 2 * M_PI - fit.sweep();
  if (!fit.ok || fit.sweep() < options_.least_turn * 2 * M_PI || gap < -0.2) return;
  PlainCurve ellipse, circle;
  ellipse.kind = StrokeKind::kEllipse;
  ellipse.p = {fit.centre, fit.p, fit.q, Vector3d::Zero()};
  const CircleFit round = fit_circle(points);
  circle.kind = StrokeKind::kCircle;
  circle.p[0] = round.centre, circle.p[1] = round.radius * round.normal;
  const double share = std::max(0.0, gap) / (2 * M_PI);
  double least = 0;
  PlainCurve best;
  for (const PlainCurve& curve : {ellipse, circle}) {
    if (!is_sound(curve)) continue;
    const double here = growth(a, b, rest_cost(curve, points, share), curve);
    if (here < least) least = here, best = curve;
  }
  if (!(least < 0)) return;
  replace(a, b, best);
  ++rounded_;
}

// What it costs that a closed curve goes on over a `share` of it from the last of the points, which
// run along it.
double Rounder::rest_cost(const PlainCurve& curve, const Matrix3Xd& points, double share) const {
  if (!(share > 0)) return 0;
  const CurveSamples samples = sample_curve(curve);
  const Closest last = closest_point(curve, samples, points.rightCols(1));
  const Vector3d way = points.rightCols(1) - points.col(points.cols() - 2);
  ControlPoints c;
  std::copy_n(curve.p.begin(), c.count = curve.size(), c.p.begin());
  const double end = last.t + (last.tangent.dot(way) > 0 ? share : -share);
  return gap_cost(curve.kind, c, last.t, end, share * samples.length, world_, options_.gap);
}

// Two arcs of one circle that share no node are all of it, where an edge may run through both gaps.
void Rounder::round_facing_arcs() {
  const std::vector<int> degree = node_degrees(s_);
  const auto is_loose = [&](int i) {
    return is_open(i) && s_.strokes[i].kind == StrokeKind::kArc &&
           degree[s_.strokes[i].begin] == 1 && degree[s_.strokes[i].end] == 1;
  };
  const int n = s_.size();
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b)
      if (is_loose(a) && is_loose(b)) round_facing(a, b);
}

void Rounder::round_facing(int a, int b) {
  Matrix3Xd points(3, 2 * kPoints);
  Vector3d p, d;
  for (int k = 0; k < points.cols(); ++k) {
    evaluate_stroke(s_, k < kPoints ? a : b, double(k % kPoints) / (kPoints - 1), &p, &d);
    points.col(k) = p;
  }
  const CircleFit fit = fit_circle(points);
  PlainCurve circle;
  circle.kind = StrokeKind::kCircle;
  circle.p[0] = fit.centre, circle.p[1] = fit.radius * fit.normal;
  if (!is_sound(circle) || !(growth(a, b, 0, circle) < 0)) return;
  const CurveSamples samples = sample_curve(circle);
  const Span of_a = span_on(circle, samples, a), of_b = span_on(circle, samples, b);
  if (of_a.length + of_b.length < options_.least_turn) return;
  ControlPoints c;
  std::copy_n(circle.p.begin(), c.count = circle.size(), c.p.begin());
  double gaps = 0;
  for (const Span& gap : rest_of(of_a, of_b))
    gaps += gap_cost(circle.kind, c, gap.begin, gap.begin + gap.length, gap.length * samples.length,
                     world_, options_.gap);
  if (!(growth(a, b, gaps, circle) < 0)) return;
  replace(a, b, circle);
  ++rounded_;
}

Span Rounder::span_on(const PlainCurve& circle, const CurveSamples& samples, int arc) const {
  double t[3];
  Vector3d p, d;
  for (int k = 0; k < 3; ++k) {
    evaluate_stroke(s_, arc, k / 2.0, &p, &d);
    t[k] = closest_point(circle, samples, p).t;
  }
  const double middle = t[1] - t[0] - std::floor(t[1] - t[0]);
  const double end = t[2] - t[0] - std::floor(t[2] - t[0]);
  return middle < end ? Span{t[0], end} : Span{t[2], 1 - end};
}

// An ellipse that the images cannot tell from a circle is one.
void Rounder::ellipses_to_circles() {
  for (int i = 0; i < s_.size(); ++i) {
    if (!alive_[i] || s_.strokes[i].kind != StrokeKind::kEllipse) continue;
    const ControlPoints c = control_points(s_, i);
    const EllipseAxes axes = principal_axes(c.p[1], c.p[2]);
    const double a = axes.major.norm(), b = axes.minor.norm();
    PlainCurve circle;
    circle.kind = StrokeKind::kCircle;
    circle.p[0] = c.p[0];
    circle.p[1] = (a + b) / 2 * axes.major.cross(axes.minor).normalized();
    if (growth(i, i, 0, circle) < 0) replace(i, i, circle);
  }
}

// A stroke with loose ends may be a piece of a closed one, drawn twice.
void Rounder::absorb_doubles() {
  const std::vector<int> degree = node_degrees(s_);
  const auto is_loose = [&](int i) {
    return is_open(i) && degree[s_.strokes[i].begin] == 1 && degree[s_.strokes[i].end] == 1;
  };
  for (int closed = 0; closed < s_.size(); ++closed)  // what takes in another one comes last
    for (int i = 0; i < s_.size() && alive_[closed]; ++i) {
      if (!is_closed(s_.strokes[closed].kind) || !is_loose(i)) continue;
      const PlainCurve curve = plain_curve(s_, closed);
      if (!(growth(closed, i, 0, curve) < 0)) continue;
      replace(closed, i, curve);
      ++rounded_;
    }
}

}  // namespace

Sketch round_arcs(const Sketch& sketch, const EdgeWorld& world, const RoundOptions& options,
                  Described* described, int* rounded) {
  Rounder rounder(sketch, world, options, described);
  rounder.round_facing_arcs();  // first: each alone could be all of it, too
  rounder.round_arcs();
  rounder.round_elliptic_arcs();
  rounder.ellipses_to_circles();
  rounder.absorb_doubles();
  *rounded = rounder.rounded();
  return rounder.finish();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/close_graph.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "edges/match.h"
#include "sketches/closest.h"
#include "sketches/conic.h"
#include "sketches/curve.h"
#include "sketches/ellipse_run.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kStepPx = 0.5;    // along a loose end
constexpr double kShortestPx = 5;  // strokes shorter than this have no direction to go on in
constexpr double kRoundPx = 0.5;   // between an ellipse and its circle
constexpr int kFewestSure = 6;     // sightings of a gap that tell something

// Cubics do not say how they go on, and short arcs of ellipses hardly.
bool is_shy(StrokeKind kind) {
  return kind == StrokeKind::kBezier || kind == StrokeKind::kEllipticArc;
}

// Points on a curve between two parameters, two pixels apart, with tangents.
CurvePoints points_between(StrokeKind kind, const ControlPoints& c, double t0, double t1,
                           double length, double footprint) {
  CurvePoints out;
  const int n = std::max(1, int(length / (2 * footprint)));
  out.position.resize(3, n);
  out.tangent.resize(3, n);
  for (int k = 0; k < n; ++k) {
    Vector3d p, d;
    evaluate_curve<double>(kind, c.p.data(), t0 + (t1 - t0) * (k + 0.5) / n, &p, &d);
    out.position.col(k) = p;
    out.tangent.col(k) = d.normalized();
  }
  out.first = {0, n};
  return out;
}

// May there be an edge here, as far as the views can tell?
bool is_possible(const CurvePoints& gap, const EdgeWorld& world, double length,
                 const CloseOptions& options) {
  if (world.hull.empty()) return length <= options.reach_px * world.footprint;
  MatchOptions match;
  match.reach_px = 1.5;
  match.min_run = 0;
  match.exclusive = false;
  const Matches matches = match_samples(world, gap, match);
  int sure = 0, seen = 0;
  for (int i = 0; i < gap.position.cols(); ++i)
    for (size_t v = 0; v < world.views.size(); ++v) {
      if (!world.hull.surely_visible(gap.position.col(i), world.views[v].center_in_world()))
        continue;
      ++sure;
      for (int m = matches.first[i]; m < matches.first[i + 1]; ++m)
        seen += matches.matches[m].view == int(v);
    }
  return sure < kFewestSure || seen >= options.least_seen * sure;
}

// The sketch while strokes come, go and are split.
class Graph {
 public:
  Graph(const Sketch& sketch, const EdgeWorld& world, const CloseOptions& options)
      : s_(sketch), world_(world), options_(options), alive_(sketch.size(), true) {}

  void round_arcs();
  void round_elliptic_arcs();
  void bridge_lines();
  void join_ends();
  Closed finish() {
    result_.sketch = keep_strokes(s_, alive_);
    return result_;
  }

 private:
  struct Meeting {
    int stroke = -1;
    double along = 0;  // [px] that the end goes on
    Vector3d place;
  };

  double px(double n) const { return n * world_.footprint; }
  std::vector<int> degrees() const {
    std::vector<int> degree(s_.nodes.cols());
    for (int i = 0; i < s_.size(); ++i)
      if (is_open(i)) ++degree[s_.strokes[i].begin], ++degree[s_.strokes[i].end];
    return degree;
  }
  bool is_open(int i) const { return alive_[i] && !is_closed(s_.strokes[i].kind); }
  int node_of(int stroke, bool at_end) const {
    return at_end ? s_.strokes[stroke].end : s_.strokes[stroke].begin;
  }
  void set_node(int stroke, bool at_end, int node) {
    (at_end ? s_.strokes[stroke].end : s_.strokes[stroke].begin) = node;
  }
  int add(StrokeKind kind, int begin, int end, const std::vector<Vector3d>& handles,
          const Evidence& evidence) {
    alive_.push_back(true);
    return s_.add_stroke(kind, begin, end, handles, evidence);
  }
  void round_ellipse(int a, bool a_back, int b, bool b_back);
  bool bridge(int a, bool a_end, int b, bool b_end);
  ControlPoints reaching(int stroke, const std::vector<int>& degree) const;
  Meeting first_meeting(int stroke, bool at_end) const;
  void meet(int stroke, bool at_end, const Meeting& meeting);
  void move_end(int stroke, bool at_end, const Vector3d& place);
  int split(int stroke, double t);

  Sketch s_;
  const EdgeWorld& world_;
  const CloseOptions& options_;
  std::vector<bool> alive_;
  Closed result_;
};

void Graph::round_arcs() {
  const std::vector<int> degree = degrees();
  for (int i = 0; i < s_.size(); ++i) {
    const Stroke stroke = s_.strokes[i];
    if (!is_open(i) || stroke.kind != StrokeKind::kArc) continue;
    if (degree[stroke.begin] != 1 || degree[stroke.end] != 1) continue;
    const CircleParameters c = circle_parameters(s_, i);
    if (c.straight || c.angle < options_.least_turn * 2 * M_PI) continue;
    const double gap = (2 * M_PI - c.angle) * c.radius;
    const double t1 = 2 * M_PI / c.angle;
    if (!is_possible(
            points_between(stroke.kind, control_points(s_, i), 1, t1, gap, world_.footprint),
            world_, gap, options_))
      continue;
    alive_[i] = false;
    add(StrokeKind::kCircle, -1, -1, {c.centre, c.normal * c.radius}, s_.evidence[i]);
    ++result_.rounded;
  }
}

// Most of an ellipse, or of a circle, in one arc or in two that go on from one another, is all of
// it.
void Graph::round_elliptic_arcs() {
  const std::vector<int> degree = degrees();
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
  // An ellipse that is round to half a pixel is a circle.
  for (int i = 0; i < s_.size(); ++i) {
    if (!alive_[i] || s_.strokes[i].kind != StrokeKind::kEllipse) continue;
    const ControlPoints c = control_points(s_, i);
    const EllipseAxes axes = principal_axes(c.p[1], c.p[2]);
    const double a = axes.major.norm(), b = axes.minor.norm();
    if ((a - b) / 2 > px(kRoundPx)) continue;
    alive_[i] = false;
    const Vector3d normal = axes.major.cross(axes.minor).normalized();
    add(StrokeKind::kCircle, -1, -1, {c.p[0], (a + b) / 2 * normal}, Evidence(s_.evidence[i]));
  }
}

void Graph::round_ellipse(int a, bool a_back, int b, bool b_back) {
  constexpr int kPoints = 32;
  Eigen::Matrix3Xd points(3, a == b ? kPoints : 2 * kPoints - 1);
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
  if (!fit.ok || fit.distance.maxCoeff() > px(1)) return;
  if (fit.sweep() < options_.least_turn * 2 * M_PI || gap < -0.2) return;
  if (gap > 0) {
    ControlPoints rest;
    rest.p[0] = fit.centre, rest.p[1] = fit.p, rest.p[2] = fit.q;
    const double t0 = fit.angle[points.cols() - 1] / (2 * M_PI), t1 = t0 + gap / (2 * M_PI);
    const double length = gap * 0.5 * (fit.p.norm() + fit.q.norm());  // about
    if (!is_possible(points_between(StrokeKind::kEllipse, rest, t0, t1, length, world_.footprint),
                     world_, length, options_))
      return;
  }
  alive_[a] = alive_[b] = false;
  ++result_.rounded;
  add(StrokeKind::kEllipse, -1, -1, {fit.centre, fit.p, fit.q}, Evidence(s_.evidence[a]));
}

// Joins two lines through a gap if they are one.
bool Graph::bridge(int a, bool a_end, int b, bool b_end) {
  const int near_a = node_of(a, a_end), near_b = node_of(b, b_end);
  const int far_a = node_of(a, !a_end), far_b = node_of(b, !b_end);
  const Vector3d p = s_.nodes.col(far_a), q = s_.nodes.col(far_b);
  const Vector3d x = s_.nodes.col(near_a), y = s_.nodes.col(near_b);
  const Vector3d axis = (q - p).normalized();
  const auto aside = [&](const Vector3d& v) { return (v - p - axis.dot(v - p) * axis).norm(); };
  if (aside(x) > px(options_.bridge_px) || aside(y) > px(options_.bridge_px)) return false;
  const double sx = axis.dot(x - p), sy = axis.dot(y - p), sq = axis.dot(q - p);
  if (!(0 < sx && sx < sy && sy < sq)) return false;
  // Each piece must point at the other: a short one says little, so its error grows with the gap.
  const double gap = sy - sx;
  for (const auto& [from, to, other] : {std::tuple(p, x, y), std::tuple(q, y, x)}) {
    const Vector3d d = (to - from).normalized();
    const Vector3d miss = other - to - d.dot(other - to) * d;
    if (miss.norm() > px(options_.bridge_px) * (1 + gap / (to - from).norm())) return false;
  }
  ControlPoints line;
  line.p[0] = x, line.p[1] = y, line.count = 2;
  if (!is_possible(points_between(StrokeKind::kLine, line, 0, 1, gap, world_.footprint), world_,
                   gap, options_))
    return false;
  alive_[a] = alive_[b] = false;
  const Evidence& e = s_.evidence[(x - p).norm() > (q - y).norm() ? a : b];
  add(StrokeKind::kLine, far_a, far_b, {}, Evidence(e));
  ++result_.bridged;
  return true;
}

void Graph::bridge_lines() {
  for (bool again = true; again;) {
    again = false;
    const std::vector<int> degree = degrees();
    struct Pair {
      double gap;
      int a, b;
      bool a_end, b_end;
    };
    std::vector<Pair> pairs;
    for (int a = 0; a < s_.size(); ++a)
      for (int b = a + 1; b < s_.size(); ++b) {
        if (!is_open(a) || !is_open(b)) continue;
        if (s_.strokes[a].kind != StrokeKind::kLine || s_.strokes[b].kind != StrokeKind::kLine)
          continue;
        for (bool x : {false, true})
          for (bool y : {false, true}) {
            const int m = node_of(a, x), n = node_of(b, y);
            if (degree[m] == 1 && degree[n] == 1)
              pairs.push_back({(s_.nodes.col(m) - s_.nodes.col(n)).norm(), a, b, x, y});
          }
      }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& u, const Pair& v) { return u.gap < v.gap; });
    for (const Pair& p : pairs)
      if (alive_[p.a] && alive_[p.b] && bridge(p.a, p.a_end, p.b, p.b_end)) again = true;
  }
}

// A stroke that goes on beyond its loose ends, too.
ControlPoints Graph::reaching(int stroke, const std::vector<int>& degree) const {
  const Stroke& s = s_.strokes[stroke];
  const ControlPoints c = control_points(s_, stroke);
  if (is_closed(s.kind) || is_shy(s.kind)) return c;
  const double length = stroke_length(s_, stroke);
  const double more = std::min(px(options_.reach_px) / length, 0.5);
  return subcurve(s.kind, c, degree[s.begin] == 1 ? -more : 0, degree[s.end] == 1 ? 1 + more : 1);
}

// Where a loose end, going on along its curve or back, first meets another stroke.
Graph::Meeting Graph::first_meeting(int stroke, bool at_end) const {
  Meeting best;
  const double length = stroke_length(s_, stroke);
  const double back = std::min(px(options_.reach_px) / 2, length / 4);
  const Stroke& own = s_.strokes[stroke];
  const double ahead = is_shy(own.kind) ? std::min(px(options_.reach_px) / 2, 0.1 * length)
                                        : std::min(px(options_.reach_px), 0.5 * length);
  const ControlPoints curve = control_points(s_, stroke);
  const int steps = int((ahead + back) / px(kStepPx));
  const std::vector<int> degree = degrees();
  for (int other = 0; other < s_.size(); ++other) {
    if (other == stroke || !alive_[other]) continue;
    const ControlPoints c = reaching(other, degree);
    const auto miss = [&](double along, Vector3d* place, Vector3d* way) {
      const double t = at_end ? 1 + along / length : -along / length;
      evaluate_curve<double>(own.kind, curve.p.data(), t, place, way);
      return closest_on_curve(s_.strokes[other].kind, c.p.data(), *place);
    };
    Meeting here;
    double least = px(options_.aside_px);
    for (int k = 0; k <= steps; ++k) {
      const double along = -back + k * px(kStepPx);
      Vector3d place, way, p, tangent;
      const ClosestPoint q = miss(along, &place, &way);
      if (k == 0 && q.distance > px(4 * options_.reach_px)) break;  // far away
      if (!(q.distance < least)) continue;
      evaluate_curve<double>(s_.strokes[other].kind, c.p.data(), q.t, &p, &tangent);
      const double cosine = std::abs(way.normalized().dot(tangent.normalized()));
      if (cosine > std::cos(options_.least_deg * M_PI / 180)) continue;
      least = q.distance;
      here = {other, along / world_.footprint, q.position};
    }
    if (here.stroke >= 0 && (best.stroke < 0 || std::abs(here.along) < std::abs(best.along)))
      best = here;
  }
  return best;
}

// The stroke follows its end; an arc keeps its circle or ellipse.
void Graph::move_end(int stroke, bool at_end, const Vector3d& place) {
  Stroke& own = s_.strokes[stroke];
  const ClosestPoint q = distance_to_stroke(s_, stroke, place);
  double t = q.t;
  if (own.kind == StrokeKind::kArc || own.kind == StrokeKind::kEllipticArc) {
    // closest_on_curve stops at the ends: go on by arc length.
    Vector3d p, speed;
    evaluate_stroke(s_, stroke, at_end ? 1 : 0, &p, &speed);
    if (at_end && t >= 1) t = 1 + q.distance / speed.norm();
    if (!at_end && t <= 0) t = -q.distance / speed.norm();
    const ControlPoints c = at_end ? subcurve(own.kind, control_points(s_, stroke), 0, t)
                                   : subcurve(own.kind, control_points(s_, stroke), t, 1);
    for (int h = 0; h < num_handles(own.kind); ++h) s_.handles.col(own.handle + h) = c.p[1 + h];
  }
  s_.nodes.col(node_of(stroke, at_end)) = place;
}

// New node in the middle of an open stroke, which becomes two.
int Graph::split(int stroke, double t) {
  const Stroke own = s_.strokes[stroke];
  const ControlPoints c = control_points(s_, stroke);
  const ControlPoints a = subcurve(own.kind, c, 0, t), b = subcurve(own.kind, c, t, 1);
  const int node = s_.add_node(a.p[a.count - 1]);
  const Evidence e = s_.evidence[stroke];
  alive_[stroke] = false;
  add(own.kind, own.begin, node, {a.p.begin() + 1, a.p.begin() + a.count - 1}, e);
  add(own.kind, node, own.end, {b.p.begin() + 1, b.p.begin() + b.count - 1}, e);
  ++result_.split;
  return node;
}

void Graph::meet(int stroke, bool at_end, const Meeting& m) {
  ++result_.joined;
  move_end(stroke, at_end, m.place);
  const Stroke& other = s_.strokes[m.stroke];
  if (is_closed(other.kind)) return;  // it has no node; the end lies on it
  const double length = stroke_length(s_, m.stroke);
  const double reach = px(options_.reach_px);
  const bool at_far_end =
      (s_.nodes.col(other.end) - m.place).norm() < (s_.nodes.col(other.begin) - m.place).norm();
  const int node = at_far_end ? other.end : other.begin;
  const bool loose = degrees()[node] == 1;
  const ClosestPoint on = distance_to_stroke(s_, m.stroke, m.place);
  // A loose end follows; one where others meet is not moved by this one.
  const bool beyond = on.t < 1e-6 || on.t > 1 - 1e-6;
  if (beyond ||
      (s_.nodes.col(node) - m.place).norm() <=
          (loose ? std::min(1.5 * reach, 0.4 * length) : std::min(reach / 2, length / 6))) {
    if (loose)
      move_end(m.stroke, at_far_end, m.place);
    else
      move_end(stroke, at_end, s_.nodes.col(node));
    set_node(stroke, at_end, node);
    return;
  }
  if (stroke_length(s_, stroke) < 2 * reach) return;  // too short to cut another one
  set_node(stroke, at_end, split(m.stroke, on.t));
}

void Graph::join_ends() {
  for (int i = 0; i < s_.size(); ++i)
    for (bool at_end : {false, true}) {
      if (!is_open(i) || stroke_length(s_, i) < px(kShortestPx)) continue;
      if (degrees()[node_of(i, at_end)] != 1) continue;
      const Meeting m = first_meeting(i, at_end);
      if (m.stroke < 0) continue;
      const int far = node_of(i, !at_end);
      const Stroke& other = s_.strokes[m.stroke];
      // Neither folds a stroke nor doubles another one.
      if (!is_closed(other.kind) && (other.begin == far || other.end == far)) {
        const double place = (s_.nodes.col(far) - m.place).norm();
        if (place < px(options_.reach_px)) continue;
      }
      meet(i, at_end, m);
    }
}

}  // namespace

Closed close_graph(const Sketch& sketch, const EdgeWorld& world, const CloseOptions& options) {
  Graph graph(sketch, world, options);
  graph.round_arcs();
  graph.round_elliptic_arcs();
  graph.bridge_lines();
  graph.join_ends();
  return graph.finish();
}

}  // namespace sketchsplat

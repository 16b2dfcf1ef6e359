// SPDX-License-Identifier: MIT
#include "pipelines/join/close_graph.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipelines/join/round_arcs.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kStepPx = 0.5;  // along a loose end
// All places of a stroke err together: what it costs to move an end aside is bounded by this
// standard deviation of the stroke as a whole [px].
constexpr double kWholePx = 0.25;
constexpr double kShortestPx = 5;  // strokes shorter than this have no direction to go on in

// Cubics do not say how they go on, and short arcs of ellipses hardly.
bool is_shy(StrokeKind kind) {
  return kind == StrokeKind::kBezier || kind == StrokeKind::kEllipticArc;
}

// Points of a curve before and after a parameter.
std::array<Matrix3Xd, 2> shared_out(const PlainCurve& curve, double t, const Matrix3Xd& points) {
  const CurveSamples samples = sample_curve(curve);
  std::array<Matrix3Xd, 2> out = {Matrix3Xd(3, 0), Matrix3Xd(3, 0)};
  for (int i = 0; i < points.cols(); ++i) {
    Matrix3Xd& part = out[closest_point(curve, samples, points.col(i)).t > t];
    part.conservativeResize(3, part.cols() + 1);
    part.rightCols(1) = points.col(i);
  }
  return out;
}

// The sketch while strokes come, go and are split.
class Graph {
 public:
  Graph(const Sketch& sketch, const Described& described, const EdgeWorld& world,
        const CloseOptions& options)
      : s_(sketch),
        points_(described.points),
        cost_(described.cost),
        world_(&world),
        options_(&options),
        alive_(sketch.size(), true) {}

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

  double px(double n) const { return n * world_->footprint; }
  PlainCurve curve(int stroke) const { return plain_curve(s_, stroke); }
  double misfit_of(int stroke) const { return misfit(curve(stroke), points_[stroke], cost_); }
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
          const Evidence& evidence, const Matrix3Xd& points) {
    alive_.push_back(true);
    points_.push_back(points);
    return s_.add_stroke(kind, begin, end, handles, evidence);
  }
  bool bridge(int a, bool a_end, int b, bool b_end);
  ControlPoints reaching(int stroke, const std::vector<int>& degree) const;
  Meeting first_meeting(int stroke, bool at_end) const;
  void meet(int stroke, bool at_end, const Meeting& meeting);
  double added_cost(int stroke, const PlainCurve& longer) const;
  double aside_cost(int stroke, bool at_end, const Vector3d& place) const;
  double growth(int stroke, const Meeting& meeting, const Graph& met) const;
  void move_end(int stroke, bool at_end, const Vector3d& place);
  int split(int stroke, double t);

  Sketch s_;
  StrokePoints points_;
  DescriptionCost cost_;
  const EdgeWorld* world_;
  const CloseOptions* options_;
  std::vector<bool> alive_;
  Closed result_;
};

// Joins two lines through a gap if they are one.
bool Graph::bridge(int a, bool a_end, int b, bool b_end) {
  const int near_a = node_of(a, a_end), near_b = node_of(b, b_end);
  const int far_a = node_of(a, !a_end), far_b = node_of(b, !b_end);
  const Vector3d p = s_.nodes.col(far_a), q = s_.nodes.col(far_b);
  const Vector3d x = s_.nodes.col(near_a), y = s_.nodes.col(near_b);
  const Vector3d axis = (q - p).normalized();
  const auto aside = [&](const Vector3d& v) { return (v - p - axis.dot(v - p) * axis).norm(); };
  if (aside(x) > px(options_->bridge_px) || aside(y) > px(options_->bridge_px)) return false;
  const double sx = axis.dot(x - p), sy = axis.dot(y - p), sq = axis.dot(q - p);
  if (!(0 < sx && sx < sy && sy < sq)) return false;
  ControlPoints rest;
  rest.p[0] = x, rest.p[1] = y, rest.count = 2;
  PlainCurve line;
  line.p[0] = p, line.p[1] = q;
  const Matrix3Xd points = points_of(points_, {a, b});
  const double growth = misfit(line, points, cost_) - misfit_of(a) - misfit_of(b) -
                        2 * cost_.node_price +
                        gap_cost(StrokeKind::kLine, rest, 0, 1, sy - sx, *world_, options_->gap);
  if (!(growth < 0)) return false;
  alive_[a] = alive_[b] = false;
  const Evidence& e = s_.evidence[(x - p).norm() > (q - y).norm() ? a : b];
  add(StrokeKind::kLine, far_a, far_b, {}, Evidence(e), points);
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
  const double more = std::min(px(options_->reach_px) / length, 0.5);
  return subcurve(s.kind, c, degree[s.begin] == 1 ? -more : 0, degree[s.end] == 1 ? 1 + more : 1);
}

// Where a loose end, going on along its curve or back, first meets another stroke.
Graph::Meeting Graph::first_meeting(int stroke, bool at_end) const {
  Meeting best;
  const double length = stroke_length(s_, stroke);
  const double back = std::min(px(options_->reach_px) / 2, length / 4);
  const Stroke& own = s_.strokes[stroke];
  const double ahead = is_shy(own.kind) ? std::min(px(options_->reach_px) / 2, 0.1 * length)
                                        : std::min(px(options_->reach_px), 0.5 * length);
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
    double least = px(options_->aside_px);
    for (int k = 0; k <= steps; ++k) {
      const double along = -back + k * px(kStepPx);
      Vector3d place, way, p, tangent;
      const ClosestPoint q = miss(along, &place, &way);
      if (k == 0 && q.distance > px(4 * options_->reach_px)) break;  // far away
      if (!(q.distance < least)) continue;
      evaluate_curve<double>(s_.strokes[other].kind, c.p.data(), q.t, &p, &tangent);
      const double cosine = std::abs(way.normalized().dot(tangent.normalized()));
      if (cosine > std::cos(options_->least_deg * M_PI / 180)) continue;
      least = q.distance;
      here = {other, along / world_->footprint, q.position};
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
  const auto parts = shared_out(curve(stroke), t, points_[stroke]);
  alive_[stroke] = false;
  add(own.kind, own.begin, node, {a.p.begin() + 1, a.p.begin() + a.count - 1}, e, parts[0]);
  add(own.kind, node, own.end, {b.p.begin() + 1, b.p.begin() + b.count - 1}, e, parts[1]);
  ++result_.split;
  return node;
}

void Graph::meet(int stroke, bool at_end, const Meeting& m) {
  ++result_.joined;
  move_end(stroke, at_end, m.place);
  const Stroke& other = s_.strokes[m.stroke];
  if (is_closed(other.kind)) return;  // it has no node; the end lies on it
  const double length = stroke_length(s_, m.stroke);
  const double reach = px(options_->reach_px);
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

// What it costs [nat] that a stroke goes on beyond where it ended.
double Graph::added_cost(int stroke, const PlainCurve& longer) const {
  const CurveSamples samples = sample_curve(longer);
  double cost = 0;
  for (bool at_end : {false, true}) {
    const Closest old = closest_point(longer, samples, s_.nodes.col(node_of(stroke, at_end)));
    const double share = at_end ? 1 - old.t : old.t;
    if (!(share * samples.length > px(kStepPx))) continue;
    ControlPoints c;
    std::copy_n(longer.p.begin(), c.count = longer.size(), c.p.begin());
    cost += gap_cost(longer.kind, c, at_end ? old.t : 0, at_end ? 1 : old.t, share * samples.length,
                     *world_, options_->gap);
  }
  return cost;
}

// What it costs at most that an end is there: how far that is from the way it goes on.
double Graph::aside_cost(int stroke, bool at_end, const Vector3d& place) const {
  Vector3d p, d;
  evaluate_stroke(s_, stroke, at_end, &p, &d);
  const Vector3d step = place - p, way = d.normalized();
  const double aside = (step - step.dot(way) * way).norm() / px(kWholePx);
  return aside * aside / 2;
}

// What it does to the description [nat] that the end of a stroke meets another one. A node on a
// curve is one number where a loose end is three.
double Graph::growth(int stroke, const Meeting& m, const Graph& met) const {
  std::vector<PlainCurve> curves = {met.curve(stroke)};
  const bool split = met.s_.size() > s_.size();
  for (int i = split ? s_.size() : m.stroke; i < (split ? met.s_.size() : m.stroke + 1); ++i)
    curves.push_back(met.curve(i));
  const double worse = misfit(curves, points_of(points_, {stroke, m.stroke}), cost_) -
                       misfit_of(stroke) - misfit_of(m.stroke);
  double moved = 0;
  for (int i : {stroke, m.stroke})
    for (bool at_end : {false, true})
      if (!is_closed(s_.strokes[i].kind) && met.alive_[i])
        moved += aside_cost(i, at_end, met.s_.nodes.col(met.node_of(i, at_end)));
  double sum = std::min(worse, moved);
  sum += added_cost(stroke, curves[0]);
  if (!split && !is_closed(s_.strokes[m.stroke].kind)) sum += added_cost(m.stroke, curves[1]);
  const bool shared = !split && !is_closed(s_.strokes[m.stroke].kind);
  return sum - cost_.node_price * (shared ? 1 : 2.0 / 3);
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
        if (place < px(options_->reach_px)) continue;
      }
      Graph met = *this;
      met.meet(i, at_end, m);
      if (growth(i, m, met) < 0) *this = std::move(met);
    }
}

}  // namespace

Closed close_graph(const Sketch& sketch, const EdgeWorld& world, const Prices& prices,
                   const CloseOptions& options) {
  Described described = describe(sketch, world, prices);
  int rounded = 0;
  const Sketch rounder = round_arcs(sketch, world, options.round, &described, &rounded);
  Graph graph(rounder, described, world, options);
  graph.bridge_lines();
  graph.join_ends();
  Closed closed = graph.finish();
  closed.rounded = rounded;
  return closed;
}

int count_loose_ends(const Sketch& sketch, double reach) {
  const std::vector<int> degree = node_degrees(sketch);
  int count = 0;
  for (int n = 0; n < sketch.nodes.cols(); ++n) {
    bool held = degree[n] != 1;
    for (int i = 0; i < sketch.size() && !held; ++i)
      held = is_closed(sketch.strokes[i].kind) &&
             distance_to_stroke(sketch, i, sketch.nodes.col(n)).distance <= reach;
    count += !held;
  }
  return count;
}

}  // namespace sketchsplat

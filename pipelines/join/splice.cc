// SPDX-License-Identifier: MIT
#include "pipelines/join/splice.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sketches/curve/closest.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kMost = 0.75;  // share of a stroke that an overlap may be: more is a duplicate

struct LooseEnd {
  int stroke = -1;
  bool at_end = false;
};

// Two ends, and the way between them.
struct Splice {
  LooseEnd a, b;
  double length = 0;
};

class Splicer {
 public:
  Splicer(const Sketch& sketch, const EdgeWorld& world, const Prices& prices,
          const SpliceOptions& options)
      : world_(world), prices_(prices), options_(options), degree_(node_degrees(sketch)) {
    result_.sketch = sketch;
    for (int i = 0; i < sketch.size(); ++i) length_.push_back(stroke_length(sketch, i));
  }

  Spliced run() {
    for (const Splice& s : by_length(&Splicer::overlap))
      if (is_loose(s.a) && is_loose(s.b) && overlap(s.a, s.b) >= 0) cut(s.a, s.b);
    for (const Splice& s : by_length(&Splicer::gap))
      if (is_loose(s.a) && is_loose(s.b)) bridge(s.a, s.b);
    return result_;
  }

 private:
  using Measure = double (Splicer::*)(const LooseEnd&, const LooseEnd&) const;

  const Stroke& stroke(const LooseEnd& e) const { return result_.sketch.strokes[e.stroke]; }
  int node(const LooseEnd& e) const { return e.at_end ? stroke(e).end : stroke(e).begin; }
  bool is_loose(const LooseEnd& e) const { return degree_[node(e)] == 1; }
  // The place of an end, and the unit tangent with which it leaves its stroke.
  void leave(const LooseEnd& e, Vector3d* place, Vector3d* outward) const {
    Vector3d d;
    evaluate_stroke(result_.sketch, e.stroke, e.at_end, place, &d);
    *outward = (e.at_end ? 1 : -1) * d.normalized();
  }

  std::vector<Splice> by_length(Measure measure) const {
    std::vector<LooseEnd> ends;
    for (int i = 0; i < int(length_.size()); ++i)
      for (const bool at_end : {false, true})
        if (!is_closed(result_.sketch.strokes[i].kind) && is_loose({i, at_end}))
          ends.push_back({i, at_end});
    std::vector<Splice> found;
    for (size_t x = 0; x < ends.size(); ++x)
      for (size_t y = x + 1; y < ends.size(); ++y) {
        if (ends[x].stroke == ends[y].stroke) continue;
        const double length = (this->*measure)(ends[x], ends[y]);
        if (length >= 0) found.push_back({ends[x], ends[y], length});
      }
    std::stable_sort(found.begin(), found.end(),
                     [](const Splice& u, const Splice& v) { return u.length < v.length; });
    return found;
  }

  // Where on the stroke of `on` the end `e` lies, if inside and running the same way.
  bool lies_on(const LooseEnd& e, const LooseEnd& on, double* t) const {
    Vector3d place, outward, p, d;
    leave(e, &place, &outward);
    const ClosestPoint q = distance_to_stroke(result_.sketch, on.stroke, place);
    if (q.distance > options_.aside_px * world_.footprint) return false;
    const double share = on.at_end ? 1 - q.t : q.t;
    if (!(share > 1e-9 && share < kMost)) return false;
    evaluate_stroke(result_.sketch, on.stroke, q.t, &p, &d);
    const Vector3d inward = (on.at_end ? -1 : 1) * d.normalized();
    *t = q.t;
    return inward.dot(outward) >= std::cos(options_.turn_deg * M_PI / 180);
  }

  // Length of the chord of what two ends share, or -1.
  double overlap(const LooseEnd& a, const LooseEnd& b) const {
    double ta, tb;
    const double chord =
        (result_.sketch.nodes.col(node(a)) - result_.sketch.nodes.col(node(b))).norm();
    if (chord > length_[a.stroke] || chord > length_[b.stroke]) return -1;
    return lies_on(a, b, &tb) && lies_on(b, a, &ta) ? chord : -1;
  }

  // The stroke as it is if it ends at the parameter t, in this place.
  PlainCurve trimmed(const LooseEnd& e, double t, const Vector3d& place) const {
    PlainCurve curve = plain_curve(result_.sketch, e.stroke);
    const ControlPoints whole = control_points(result_.sketch, e.stroke);
    ControlPoints c =
        e.at_end ? subcurve(curve.kind, whole, 0, t) : subcurve(curve.kind, whole, t, 1);
    if (curve.kind == StrokeKind::kEllipticArc)
      c = elliptic_arc_between(c, e.at_end ? c.p[0] : place, e.at_end ? place : c.p[3]);
    c.p[e.at_end ? c.count - 1 : 0] = place;
    std::copy_n(c.p.begin(), c.count, curve.p.begin());
    return curve;
  }

  void trim(const LooseEnd& e, const PlainCurve& curve, int to) {
    Stroke& own = result_.sketch.strokes[e.stroke];
    for (int h = 0; h < num_handles(own.kind); ++h)
      result_.sketch.handles.col(own.handle + h) = curve.p[1 + h];
    (e.at_end ? own.end : own.begin) = to;
  }

  // What the images say, asked for when it is first needed.
  const Described& described() {
    if (!described_) described_ = describe(result_.sketch, world_, prices_);
    return *described_;
  }

  // Both end in the middle of what they share, if that takes fewer words: it is one node less.
  void cut(const LooseEnd& a, const LooseEnd& b) {
    double ta = 0, tb = 0;
    lies_on(a, b, &tb), lies_on(b, a, &ta);
    ta = 0.5 * (ta + a.at_end);
    Vector3d p, d;
    evaluate_stroke(result_.sketch, a.stroke, ta, &p, &d);
    const ClosestPoint foot = distance_to_stroke(result_.sketch, b.stroke, p);
    const Vector3d joint = 0.5 * (p + foot.position);
    const PlainCurve to_a = trimmed(a, ta, joint), to_b = trimmed(b, foot.t, joint);

    const auto& [cost, points] = described();
    double growth = -cost.node_price;
    for (int s : {a.stroke, b.stroke})
      growth += misfit({to_a, to_b}, points[s], cost) -
                misfit(plain_curve(result_.sketch, s), points[s], cost);
    if (!(growth < 0)) return;
    const int node_of_both = result_.sketch.add_node(joint);
    degree_.push_back(2);
    degree_[node(a)] = degree_[node(b)] = 0;
    trim(a, to_a, node_of_both);
    trim(b, to_b, node_of_both);
    ++result_.overlaps;
  }

  ControlPoints way_between(const LooseEnd& a, const LooseEnd& b) const {
    Vector3d p, u, q, v;
    leave(a, &p, &u), leave(b, &q, &v);
    const double third = (q - p).norm() / 3;
    ControlPoints c;
    c.p = {p, p + third * u, q + third * v, q}, c.count = 4;
    return c;
  }

  // Width of the gap between two ends that face one another, or -1.
  double gap(const LooseEnd& a, const LooseEnd& b) const {
    if (stroke(a).kind == StrokeKind::kLine && stroke(b).kind == StrokeKind::kLine) return -1;
    Vector3d p, u, q, v;
    leave(a, &p, &u), leave(b, &q, &v);
    const double width = (q - p).norm();
    if (!(width > 0 && width <= std::min(length_[a.stroke], length_[b.stroke]))) return -1;
    const double least = std::cos(options_.bend_deg * M_PI / 180) * width;
    return u.dot(q - p) < least || v.dot(p - q) < least ? -1 : width;
  }

  // A cubic goes over the gap if what the views see there pays for it.
  void bridge(const LooseEnd& a, const LooseEnd& b) {
    const ControlPoints c = way_between(a, b);
    const double seen = gap_cost(StrokeKind::kBezier, c, 0, 1, gap(a, b), world_, options_.gap);
    if (!(seen + prices_.parameter * own_parameters(StrokeKind::kBezier) < 0)) return;
    ++degree_[node(a)], ++degree_[node(b)];
    result_.sketch.add_stroke(StrokeKind::kBezier, node(a), node(b), {c.p[1], c.p[2]});
    ++result_.gaps;
  }

  const EdgeWorld& world_;
  const Prices& prices_;
  const SpliceOptions& options_;
  std::optional<Described> described_;
  std::vector<int> degree_;
  std::vector<double> length_;  // of the strokes as they were
  Spliced result_;
};

}  // namespace

Spliced splice(const Sketch& sketch, const EdgeWorld& world, const Prices& prices,
               const SpliceOptions& options) {
  Spliced spliced = Splicer(sketch, world, prices, options).run();
  // Nodes that were cut off are nobody's.
  spliced.sketch = keep_strokes(spliced.sketch, std::vector<bool>(spliced.sketch.size(), true));
  return spliced;
}

}  // namespace sketchsplat

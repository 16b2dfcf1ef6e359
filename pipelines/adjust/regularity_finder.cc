// SPDX-License-Identifier: MIT
#include "pipelines/adjust/regularity_finder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sketches/curve/curve.h"

namespace sketchsplat {

using Eigen::Vector3d;
using Candidate = RegularityCandidate;

bool RegularityFinder::is_conic(int i) const {
  const StrokeKind kind = sketch().strokes[i].kind;
  return kind == StrokeKind::kArc || kind == StrokeKind::kCircle || kind == StrokeKind::kEllipse;
}

// The least squares skip a loop through one node.
bool RegularityFinder::is_usable(int i) const {
  const Stroke& stroke = sketch().strokes[i];
  return is_closed(stroke.kind) || stroke.begin != stroke.end;
}

// The ends of a stroke, with `inner` also the inner points of a cubic; the centre of a closed one.
std::set<int> RegularityFinder::points_of(int i, bool inner) const {
  const Stroke& s = sketch().strokes[i];
  const int handle = int(sketch().nodes.cols()) + s.handle;
  if (is_closed(s.kind)) return {handle};
  if (inner && s.kind == StrokeKind::kBezier) return {s.begin, s.end, handle, handle + 1};
  return {s.begin, s.end};
}

bool RegularityFinder::holds_all(const std::set<int>& held, int i, bool inner) const {
  const std::set<int> points = points_of(i, inner);
  return std::includes(held.begin(), held.end(), points.begin(), points.end());
}

Vector3d RegularityFinder::place_of(int point) const {
  const int nodes = int(sketch().nodes.cols());
  return point < nodes ? sketch().nodes.col(point) : sketch().handles.col(point - nodes);
}

// Takes a relation if it pays. Does it hold, taken or known already?
bool RegularityFinder::share(const Relation& relation, double range, double naming) {
  std::vector<Relation> one = {relation};
  const RelationTrial trial = weigher_.weigh(&one, range, naming);
  if (trial.pays()) weigher_.take(one, trial, true);
  return trial.pays() || !trial.news;
}

// Takes a relation that defines a quantity, which costs nothing.
void RegularityFinder::define(const Relation& relation, double range) {
  std::vector<Relation> one = {relation};
  weigher_.take(one, weigher_.weigh(&one, range, 0), false);
}

// Remembers who keeps to a quantity.
void RegularityFinder::hold(int shared, const Relation& r) {
  held_.resize(std::max<size_t>(held_.size(), weigher_.num_shared()));
  held_[shared].insert(r.stroke >= 0 ? r.stroke : r.point);
  if (r.twin >= 0) held_[shared].insert(r.twin);
}

// Is the quantity known well enough to be recognised in another place?
bool RegularityFinder::is_sure(const Candidate& c) const {
  return c.sigma < c.range * std::exp(-weigher_.options().price);
}

// A stroke and its own direction; sigma in rad.
Candidate RegularityFinder::along(int stroke) {
  Candidate c;
  c.value = stroke_direction(sketch(), stroke);
  const double length = stroke_length(sketch(), stroke);
  c.range = (is_conic(stroke) ? length / 2 : length) / weigher_.unit();
  c.relation.kind = RelationKind::kParallel;
  c.relation.stroke = stroke;
  c.relation.scale = c.range;
  Vector3d x, y;
  frame_of<double>(c.value, &x, &y);
  c.relation.across << x.transpose(), y.transpose();
  c.sigma = weigher_.ask(c.relation, {SharedKind::kDirection, -1, c.value}).sigma / c.range;
  return c;
}

static void sort_by_sigma(std::vector<Candidate>* c) {
  std::stable_sort(c->begin(), c->end(),
                   [](const Candidate& a, const Candidate& b) { return a.sigma < b.sigma; });
}

void RegularityFinder::find_directions() {
  std::vector<Candidate> candidates;
  for (int i = 0; i < sketch().size(); ++i) {
    if (!is_usable(i) || stroke_direction(sketch(), i).isZero()) continue;
    const Candidate c = along(i);
    if (c.sigma < std::exp(-weigher_.options().price)) candidates.push_back(c);
  }
  sort_by_sigma(&candidates);
  for (Candidate& c : candidates) {
    Direction* nearest = nullptr;
    double cosine = 0;
    for (Direction& d : directions_) {
      const double here = std::abs(weigher_.shared(d.shared).value.dot(c.value));
      if (here > cosine) cosine = here, nearest = &d;
    }
    if (nearest && std::acos(std::min(1.0, cosine)) < kGate * (c.sigma + nearest->sigma)) {
      c.relation.shared = nearest->shared;
      c.relation.sign = weigher_.shared(nearest->shared).value.dot(c.value) < 0 ? -1 : 1;
      if (share(c.relation, c.range, std::log(double(directions_.size())))) {
        nearest->strokes.push_back(c.relation.stroke);
        nearest->useful = true;
        continue;
      }
    }
    Direction d;
    d.shared = weigher_.add_shared({SharedKind::kDirection, -1, c.value}, 1);
    d.sigma = c.sigma;
    d.strokes = {c.relation.stroke};
    c.relation.shared = d.shared;
    c.relation.sign = 1;
    define(c.relation, c.range);
    directions_.push_back(d);
  }
}

void RegularityFinder::find_right_angles() {
  const auto right_angle = [&](const Direction& a, const Direction& b) {
    Relation r;
    r.kind = RelationKind::kPerpendicular;
    r.shared = a.shared, r.other = b.shared;
    r.scale = weigher_.extent() / weigher_.unit();
    return r;
  };
  const auto cosine = [&](const Direction& a, const Direction& b) {
    return std::abs(weigher_.shared(a.shared).value.dot(weigher_.shared(b.shared).value));
  };
  const int n = int(directions_.size());
  std::vector<std::pair<int, int>> pairs, right;
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b)
      if (directions_[a].useful && directions_[b].useful) pairs.emplace_back(a, b);
  for (const auto& [a, b] : pairs) {
    const Direction &u = directions_[a], &v = directions_[b];
    if (cosine(u, v) > kGate * (u.sigma + v.sigma)) continue;
    const Relation r = right_angle(u, v);
    if (share(r, r.scale, std::log(double(pairs.size())))) right.emplace_back(a, b);
  }
  // The direction of one stroke alone may complete a frame.
  for (Direction& d : directions_) {
    if (d.useful) continue;
    for (const auto& [a, b] : right) {
      const Direction &u = directions_[a], &v = directions_[b];
      if (cosine(u, d) > kGate * (u.sigma + d.sigma)) continue;
      if (cosine(v, d) > kGate * (v.sigma + d.sigma)) continue;
      std::vector<Relation> two = {right_angle(u, d), right_angle(v, d)};
      const RelationTrial trial =
          weigher_.weigh(&two, two[0].scale, std::log(double(right.size())));
      if (!trial.pays()) continue;
      weigher_.take(two, trial, true);
      d.useful = true;
      break;
    }
  }
}

// Candidates that lie together share a quantity: the surest one defines it, others join.
void RegularityFinder::group(std::vector<Candidate> candidates, const SharedQuantity& blank) {
  sort_by_sigma(&candidates);
  const double naming = std::log(std::max(1.0, double(candidates.size())));
  std::vector<bool> taken(candidates.size(), false);
  for (size_t a = 0; a < candidates.size(); ++a) {
    if (taken[a]) continue;
    std::vector<size_t> near;
    for (size_t b = a + 1; b < candidates.size(); ++b) {
      const double distance = (candidates[b].value - candidates[a].value).norm() / weigher_.unit();
      if (!taken[b] && distance < kGate * (candidates[a].sigma + candidates[b].sigma))
        near.push_back(b);
    }
    if (near.empty()) continue;
    SharedQuantity quantity = blank;
    quantity.value = candidates[a].value;
    const int shared = weigher_.add_shared(quantity, weigher_.extent());
    candidates[a].relation.shared = shared;
    define(candidates[a].relation, candidates[a].range);
    hold(shared, candidates[a].relation);
    for (size_t b : near) {
      candidates[b].relation.shared = shared;
      taken[b] = share(candidates[b].relation, candidates[b].range, naming);
      if (taken[b]) hold(shared, candidates[b].relation);
    }
  }
}

// Nodes, inner points of cubics and centres of conics about the direction; value: offset along it.
std::vector<Candidate> RegularityFinder::points_across(const Direction& direction) {
  std::set<int> points;
  for (int i = 0; i < sketch().size(); ++i)
    if (is_usable(i) && !is_closed(sketch().strokes[i].kind)) points.merge(points_of(i, true));
  for (int i : direction.strokes)
    if (is_closed(sketch().strokes[i].kind)) points.merge(points_of(i, true));
  std::vector<Candidate> out;
  const Vector3d normal = weigher_.shared(direction.shared).value;
  const SharedQuantity plane = {SharedKind::kPlane, direction.shared, Vector3d::Zero()};
  for (int p : points) {
    Candidate c;
    c.relation.kind = RelationKind::kCoplanar;
    c.relation.point = p;
    c.relation.scale = 1 / weigher_.unit();
    c.value[0] = normal.dot(place_of(p) - weigher_.relations().origin);
    c.sigma = weigher_.ask(c.relation, plane).sigma;
    c.range = weigher_.extent() / weigher_.unit();
    if (is_sure(c)) out.push_back(c);
  }
  return out;
}

void RegularityFinder::find_planes() {
  for (const Direction& d : directions_)
    if (d.useful) group(points_across(d), {SharedKind::kPlane, d.shared, Vector3d::Zero()});
}

void RegularityFinder::find_axes() {
  for (const Direction& d : directions_) {
    std::vector<Candidate> candidates;
    const Vector3d along = weigher_.shared(d.shared).value;
    Vector3d x, y;
    frame_of<double>(along, &x, &y);
    for (int i : d.strokes) {
      if (!is_conic(i)) continue;
      Candidate c;
      c.relation.kind = RelationKind::kCoaxial;
      c.relation.stroke = i;
      c.relation.across << x.transpose(), y.transpose();
      c.relation.scale = 1 / weigher_.unit();
      c.range = weigher_.extent() / weigher_.unit();
      const RelationWeigher::Own own =
          weigher_.ask(c.relation, {SharedKind::kAxis, d.shared, Vector3d::Zero()});
      c.sigma = own.sigma;
      // The residual is the centre across the axis, which starts in the origin here.
      c.value = (own.residual[0] * x + own.residual[1] * y) * weigher_.unit();
      if (is_sure(c)) candidates.push_back(c);
    }
    group(candidates, {SharedKind::kAxis, d.shared, Vector3d::Zero()});
  }
}

void RegularityFinder::find_radii() {
  std::vector<Candidate> candidates;
  for (int i = 0; i < sketch().size(); ++i) {
    const StrokeKind kind = sketch().strokes[i].kind;
    if (!is_usable(i) || (kind != StrokeKind::kArc && kind != StrokeKind::kCircle)) continue;
    Candidate c;
    c.relation.kind = RelationKind::kEqualRadius;
    c.relation.stroke = i;
    c.relation.scale = 1 / weigher_.unit();
    const RelationWeigher::Own own =
        weigher_.ask(c.relation, {SharedKind::kRadius, -1, Vector3d::Zero()});
    c.value[0] = own.residual[0] * weigher_.unit();
    c.range = own.residual[0];
    c.sigma = own.sigma;
    if (is_sure(c)) candidates.push_back(c);
  }
  group(candidates, {SharedKind::kRadius, -1, Vector3d::Zero()});
}

void RegularityFinder::find(int stages) {
  if (stages > 0) find_directions();
  if (stages > 1) find_right_angles();
  if (stages > 2) find_planes();
  if (stages > 3) find_axes();
  if (stages > 4) find_radii();
  if (stages > 5) find_mirrors();
  if (stages > 6) find_tangents();
}

Relations RegularityFinder::kept() const {
  Relations out = weigher_.relations();
  out.list.clear();
  for (const Relation& r : weigher_.relations().list)
    if (r.shared < 0 || weigher_.is_used(r.shared)) out.list.push_back(r);
  return out;
}

std::vector<Regularity> RegularityFinder::regularities() const {
  std::vector<Regularity> out;
  const auto add = [&](RelationKind kind, std::set<int> strokes) {
    if (strokes.size() > 1) out.push_back({kind, {strokes.begin(), strokes.end()}});
  };
  const auto along = [&](int shared) -> const std::vector<int>& {
    return std::find_if(directions_.begin(), directions_.end(),
                        [&](const Direction& d) { return d.shared == shared; })
        ->strokes;
  };
  for (int q = 0; q < weigher_.num_shared(); ++q) {
    if (!weigher_.is_used(q)) continue;
    const SharedQuantity& shared = weigher_.shared(q);
    if (shared.kind == SharedKind::kDirection) {
      add(RelationKind::kParallel, {along(q).begin(), along(q).end()});
    } else if (shared.kind == SharedKind::kPlane) {
      // A mirror holds ends and centres; all points of strokes that lie in a plane, and only conics
      // about its normal do.
      const bool mirror = mirrors_.count(q) > 0;
      const std::vector<int>& about = along(shared.direction);
      std::set<int> strokes;
      for (int i = 0; i < sketch().size(); ++i)
        if (holds_all(held_[q], i, !mirror) &&
            (mirror || !is_conic(i) || std::count(about.begin(), about.end(), i) > 0))
          strokes.insert(i);
      add(mirror ? RelationKind::kSymmetric : RelationKind::kCoplanar, strokes);
    } else {
      add(shared.kind == SharedKind::kAxis ? RelationKind::kCoaxial : RelationKind::kEqualRadius,
          held_[q]);
    }
  }
  for (const std::set<int>& pair : tangents_) add(RelationKind::kTangent, pair);
  for (const Relation& r : weigher_.relations().list) {
    if (r.kind != RelationKind::kPerpendicular) continue;
    std::set<int> strokes;
    for (int q : {r.shared, r.other}) strokes.insert(along(q).begin(), along(q).end());
    add(r.kind, strokes);
  }
  return out;
}

}  // namespace sketchsplat

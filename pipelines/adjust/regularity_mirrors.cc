// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "pipelines/adjust/polish_tangent.h"
#include "pipelines/adjust/regularity_finder.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kNearPx = 1;  // [px] by which mirrored points may miss one another at first
constexpr int kFewestPairs = 2;
constexpr int kMostPairs = 12;  // that are weighed at once

}  // namespace

// The plane across a direction that mirrors most pairs of points.
RegularityFinder::Mirror RegularityFinder::best_mirror(const Direction& direction) {
  const Vector3d n = weigher_.shared(direction.shared).value;
  Vector3d x, y;
  frame_of<double>(n, &x, &y);
  struct Placed {
    int point;
    Vector3d at;  // along x, y and the direction [px]
  };
  std::set<int> ends;  // and centres
  for (int i = 0; i < sketch().size(); ++i)
    if (is_usable(i)) ends.merge(points_of(i, false));
  std::vector<Placed> points;
  for (const int p : ends) {
    const Vector3d d = (place_of(p) - weigher_.relations().origin) / weigher_.unit();
    points.push_back({p, {x.dot(d), y.dot(d), n.dot(d)}});
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const Placed& a, const Placed& b) { return a.at.x() < b.at.x(); });
  struct Pair {
    double offset;  // [px] of the middle
    int a, b;
  };
  std::vector<Pair> pairs;
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t j = i + 1; j < points.size(); ++j) {
      const Vector3d way = points[j].at - points[i].at;
      if (way.x() > kNearPx) break;
      if (std::abs(way.y()) > kNearPx || std::abs(way.z()) < 2 * kNearPx) continue;
      pairs.push_back(
          {0.5 * (points[i].at.z() + points[j].at.z()), points[i].point, points[j].point});
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.offset < b.offset; });
  size_t best = 0, most = 0;
  for (size_t i = 0, end = 0; i < pairs.size(); ++i) {
    while (end < pairs.size() && pairs[end].offset <= pairs[i].offset + kNearPx) ++end;
    if (end - i > most) best = i, most = end - i;
  }
  Mirror mirror;
  mirror.candidates = int(pairs.size());
  if (most == 0) return mirror;
  mirror.offset = pairs[best + most / 2].offset * weigher_.unit();
  for (size_t i = best; i < best + most; ++i) {
    Relation r;
    r.kind = RelationKind::kSymmetric;
    r.point = pairs[i].a, r.twin = pairs[i].b;
    r.across << x.transpose(), y.transpose();
    r.scale = 1 / weigher_.unit();
    const RelationWeigher::Own own =
        weigher_.ask(r, {SharedKind::kPlane, direction.shared, Vector3d(mirror.offset, 0, 0)});
    if (own.residual.norm() < kGate * own.sigma) mirror.pairs.push_back(r);
  }
  return mirror;
}

void RegularityFinder::find_mirrors() {
  for (const Direction& d : directions_) {
    if (!d.useful) continue;
    Mirror mirror = best_mirror(d);
    if (int(mirror.pairs.size()) < kFewestPairs) continue;
    const double range = weigher_.extent() / weigher_.unit();
    const double naming = std::log(double(mirror.candidates));
    // The plane itself has to be stated: one pair alone does not pay for it.
    const int shared = weigher_.add_shared(
        {SharedKind::kPlane, d.shared, Vector3d(mirror.offset, 0, 0)}, weigher_.extent());
    for (Relation& r : mirror.pairs) r.shared = shared;
    const size_t first = std::min<size_t>(mirror.pairs.size(), kMostPairs);
    std::vector<Relation> some(mirror.pairs.begin(), mirror.pairs.begin() + first);
    const RelationTrial trial = weigher_.weigh(&some, range, naming);
    if (!trial.pays()) continue;
    weigher_.take(some, trial, true);
    mirrors_.insert(shared);
    for (const Relation& r : some) hold(shared, r);
    for (size_t i = first; i < mirror.pairs.size(); ++i)
      if (share(mirror.pairs[i], range, naming)) hold(shared, mirror.pairs[i]);
  }
}

void RegularityFinder::find_tangents() {
  const double price = weigher_.options().price;
  for (Relation& r : tangent_relations(sketch(), weigher_.options().tangent_angle)) {
    r.scale = std::min(stroke_length(sketch(), r.stroke) / 2, stroke_length(sketch(), r.partner)) /
              weigher_.unit();
    // It is expected: that it agrees is no chance, however vague it is.
    if (share(r, r.scale, -2 * (price + kTangentLogOdds)))
      tangents_.push_back({r.stroke, r.partner});
  }
}

}  // namespace sketchsplat

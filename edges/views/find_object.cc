// SPDX-License-Identifier: MIT
#include "edges/views/find_object.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "datasets/neighbours/kd_tree.h"
#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "edges/views/cell_groups.h"
#include "edges/views/convex_hull.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Plane = Eigen::Hyperplane<double, 3>;

constexpr double kLinePx = 30;    // [px] along its tangent, within which others bear a point out
constexpr double kLineViews = 6;  // beyond the fewest, that these and the point have together
constexpr double kTablePx = 2;    // [px] of points on the table
constexpr double kPrintPx = 6;    // [px] over the table, up to where a point may be print on it
constexpr double kGapPx = 24;     // [px] seen from above, that parts the object from other things,
constexpr double kGap =
    0.12;  // in diameters of the object, if that is more: large things fall apart
constexpr double kFootPx = 4;            // [px] around the object's points, on the table
constexpr double kAbovePx = 20;          // [px] the same above it, where nothing else is near
constexpr double kLeastOnTable = 0.1;    // of the points, that lie on a plane for it to be a table
constexpr int kTrials = 3000;            // planes through three points
constexpr int kMostPoints = 3000;        // that judge them
constexpr double kSameDirection = 0.96;  // cosine
constexpr double kNear = 0.25;  // of what the cameras look at: how far from its middle things count
constexpr double kBelow = 4;    // points that lie on a plane make up for one far below it
constexpr double kMostBelow = 0.1;  // of the points, far below a table

struct Judged {
  double score = 0;
  int on = 0, below = 0;
};

Judged judge(const Plane& plane, const std::vector<Vector3d>& points, double tolerance) {
  Judged j;
  for (const Vector3d& p : points) {
    const double d = plane.signedDistance(p);
    j.on += std::abs(d) < tolerance;
    j.below += d < -3 * tolerance;
  }
  j.score = j.on - kBelow * j.below;
  return j;
}

// Least squares through the points near a plane.
Plane refined(const Plane& plane, const std::vector<Vector3d>& points, double tolerance) {
  Vector3d mean = Vector3d::Zero();
  int n = 0;
  for (const Vector3d& p : points)
    if (plane.absDistance(p) < tolerance) mean += p, ++n;
  mean /= std::max(1, n);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points)
    if (plane.absDistance(p) < tolerance) spread += (p - mean) * (p - mean).transpose();
  const auto es = eigen_symmetric(spread);
  Vector3d normal = es.vectors.col(0);
  if (normal.dot(plane.normal()) < 0) normal = -normal;
  return Plane(normal, mean);
}

std::vector<Vector3d> every_nth(const std::vector<Vector3d>& points) {
  std::vector<Vector3d> out;
  const double step = std::max(1.0, double(points.size()) / kMostPoints);
  for (double i = 0; i < double(points.size()); i += step) out.push_back(points[size_t(i)]);
  return out;
}

std::optional<Plane> find_table(const std::vector<Vector3d>& all,
                                const std::vector<Vector3d>& cameras, double footprint, int seed) {
  const std::vector<Vector3d> points = every_nth(all);
  const int n = int(points.size());
  if (n < 20) return std::nullopt;
  const double tolerance = kTablePx * footprint;
  std::mt19937 rng(1u + seed);
  Plane best;
  Judged most;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Vector3d &a = points[rng() % n], &b = points[rng() % n], &c = points[rng() % n];
    Vector3d normal = (b - a).cross(c - a);
    if (!(normal.norm() > 1e-3 * (b - a).norm() * (c - a).norm())) continue;
    normal.normalize();
    if (normal.dot(cameras.front() - a) < 0) normal = -normal;
    const Plane plane(normal, a);
    if (std::any_of(cameras.begin(), cameras.end(),
                    [&](const Vector3d& x) { return plane.signedDistance(x) <= 0; }))
      continue;
    const Judged j = judge(plane, points, tolerance);
    if (j.score > most.score) most = j, best = plane;
  }
  if (!(most.score > 0)) return std::nullopt;
  for (int k = 0; k < 3; ++k) best = refined(best, points, tolerance);
  most = judge(best, points, tolerance);
  if (most.on < kLeastOnTable * n || most.below > kMostBelow * n) return std::nullopt;
  return best;
}

std::vector<Vector3d> in_space(const std::vector<Vector2d>& places) {
  std::vector<Vector3d> out;
  for (const Vector2d& p : places) out.emplace_back(p.x(), p.y(), 0);
  return out;
}

// The group with the most places near the middle, and those with any among known ones.
std::vector<char> groups_of_object(const std::vector<Vector2d>& places,
                                   const std::vector<int>& group, int count, const Vector2d& middle,
                                   double near, const std::vector<Vector2d>& known) {
  std::vector<double> weight(count);
  std::vector<char> own(count, 0);
  const std::vector<Vector2d> among = convex_hull(known);
  for (size_t i = 0; i < places.size(); ++i) {
    weight[group[i]] += std::exp(-0.5 * (places[i] - middle).squaredNorm() / (near * near));
    if (is_inside(among, places[i])) own[group[i]] = 1;
  }
  own[std::max_element(weight.begin(), weight.end()) - weight.begin()] = 1;
  return own;
}

// Of the places, those of some groups and of all groups that lie, step by step, nearer to them than
// a gap; and at last those of groups around all that.
std::vector<Vector2d> grown(const std::vector<Vector2d>& places, const std::vector<int>& group,
                            std::vector<char> own, double footprint, double least_gap) {
  std::vector<Vector2d> taken;
  for (bool more = true; more;) {
    more = false;
    taken.clear();
    Eigen::AlignedBox2d box;
    for (size_t i = 0; i < places.size(); ++i)
      if (own[group[i]]) taken.push_back(places[i]), box.extend(places[i]);
    const double gap = std::max(kGapPx * footprint, least_gap * box.sizes().norm());
    for (size_t i = 0; i < places.size(); ++i) {
      if (own[group[i]] || box.exteriorDistance(places[i]) > gap) continue;
      more |= own[group[i]] = std::any_of(taken.begin(), taken.end(), [&](const Vector2d& p) {
        return (p - places[i]).squaredNorm() < gap * gap;
      });
    }
  }
  const std::vector<Vector2d> inner = convex_hull(taken);
  for (int g = 0; g < int(own.size()); ++g) {
    if (own[g]) continue;
    std::vector<Vector2d> others;
    for (size_t i = 0; i < places.size(); ++i)
      if (group[i] == g) others.push_back(places[i]);
    const std::vector<Vector2d> outer = convex_hull(others);
    // Things do not stand within each other: it is the foot of what is known, or its rim.
    if (outer.size() > 2 && std::all_of(inner.begin(), inner.end(), [&](const Vector2d& corner) {
          return is_inside(outer, corner);
        }))
      taken.insert(taken.end(), others.begin(), others.end());
  }
  return taken;
}

// Positions of the points that others on the same line bear out.
std::vector<Vector3d> borne_out(const std::vector<EdgePoint>& points, double footprint,
                                int min_views) {
  const double reach = kLinePx * footprint, aside = kTablePx * footprint;
  Eigen::Matrix3Xd positions(3, points.size());
  for (size_t i = 0; i < points.size(); ++i) positions.col(i) = points[i].position;
  const KdTree tree(positions);
  const auto bears_out = [&](const EdgePoint& p, const EdgePoint& q) {
    const Vector3d d = q.position - p.position;
    return d.cross(p.tangent).norm() < aside && std::abs(p.tangent.dot(q.tangent)) > kSameDirection;
  };
  std::vector<Vector3d> out;
  for (const EdgePoint& p : points) {
    int others = -1;  // it meets itself
    double views = 0;
    for (const int j : tree.within(p.position, reach))
      if (bears_out(p, points[j])) ++others, views += points[j].views - min_views;
    if (others > 0 && views >= kLineViews) out.push_back(p.position);
  }
  return out;
}

// Height over the table from which on a point is none of its print, whose heights vary as those of
// most points near the table do: at least a pixel, `most` at the most.
double highest_print(const Plane& table, const std::vector<Vector3d>& points, double pixel,
                     double most) {
  constexpr double kSigmas = 5;
  std::vector<double> heights;
  for (const Vector3d& p : points)
    if (table.absDistance(p) < most) heights.push_back(table.absDistance(p));
  return std::clamp(kSigmas * normal_sigma(std::move(heights)), std::min(pixel, most), most);
}

Eigen::AlignedBox3d box_of(const std::vector<Vector3d>& points, double margin) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) {
    box.extend(Vector3d(p - Vector3d::Constant(margin)));
    box.extend(Vector3d(p + Vector3d::Constant(margin)));
  }
  return box;
}

}  // namespace

bool ObjectRegion::contains(const Vector3d& point) const {
  if (box.isEmpty()) return true;
  if (!box.contains(point)) return false;
  if (!table) return true;
  const bool on_table = table->signedDistance(point) < above;
  return is_inside(on_table ? outline_on_table : outline, frame * point);
}

ObjectRegion wider(ObjectRegion region, double by) {
  region.box.min().array() -= by;
  region.box.max().array() += by;
  for (std::vector<Vector2d>* polygon : {&region.outline, &region.outline_on_table})
    *polygon = convex_hull(widened(*polygon, by));
  return region;
}

ObjectRegion region_around(const std::vector<Vector3d>& places, double margin,
                           const ObjectRegion& before) {
  ObjectRegion region = before;
  region.box = box_of(places, margin);
  if (!region.table) return region;
  std::vector<Vector2d> seen_from_above;
  for (const Vector3d& p : places) seen_from_above.push_back(region.frame * p);
  region.outline = convex_hull(widened(seen_from_above, margin));
  return region;
}

ObjectRegion find_object(const std::vector<EdgePoint>& all, const std::vector<Vector3d>& cameras,
                         const Vector3d& middle, double reach, double footprint,
                         const RegionOptions& options) {
  ObjectRegion region;
  const double margin = kFootPx * footprint;
  const std::vector<Vector3d> points = borne_out(all, footprint, options.min_views);
  if (points.empty() || cameras.empty()) return region;
  // Without a table nothing tells things from the object: all points may be of it.
  std::vector<Vector3d> any;
  for (const EdgePoint& p : all) any.push_back(p.position);
  region.box = box_of(any, kAbovePx * footprint);
  const std::optional<Plane> table = find_table(points, cameras, footprint, options.seed);
  if (!table) return region;
  const Vector3d x = table->normal().unitOrthogonal();
  region.frame << x.transpose(), table->normal().cross(x).transpose();

  std::vector<Vector2d> places;
  for (const Vector3d& p : points)
    if (table->signedDistance(p) > kPrintPx * footprint) places.push_back(region.frame * p);
  int count = 0;
  const std::vector<int> group = groups_of(in_space(places), 0.5 * kGapPx * footprint, &count);
  if (count == 0) return region;
  std::vector<Vector2d> known;
  for (const Vector3d& p : options.known) known.push_back(region.frame * p);
  const std::vector<char> start =
      groups_of_object(places, group, count, region.frame * middle, kNear * reach, known);
  const std::vector<Vector2d> own = grown(places, group, start, footprint, kGap);
  region.table = table;
  region.above = highest_print(*table, points, footprint, kPrintPx * footprint);
  region.outline = convex_hull(widened(own, kAbovePx * footprint));
  region.outline_on_table = convex_hull(widened(own, margin));
  const std::vector<Vector2d> sure =
      convex_hull(widened(grown(places, group, start, footprint, 0), margin));
  std::vector<Vector3d> inside;
  for (const Vector3d& p : points) {
    const Vector2d place = region.frame * p;
    const bool stands = table->signedDistance(p) > kPrintPx * footprint;
    if (!stands || !is_inside(region.outline, place)) continue;
    if (is_inside(sure, place)) region.edges.push_back(p);
    inside.push_back(p);
    inside.push_back(table->projection(p));  // it stands there, whether that is seen or not
  }
  region.box = box_of(inside, kAbovePx * footprint);
  return region;
}

}  // namespace sketchsplat

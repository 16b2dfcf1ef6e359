// SPDX-License-Identifier: MIT
#include "edges/surfels/start/edge_planes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "datasets/types/dense.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kPlanePx = 1;         // [pixel footprints] from a point to its plane
constexpr double kPlaneDeg = 6;        // [deg] between a tangent and the plane
constexpr double kPartDeg = 25;        // [deg] least turn between the two planes of an edge
constexpr double kLeastNew = 0.5;      // share of a plane's points that no other planes explain
constexpr int kFewestPoints = 12;      // that make a plane; and
constexpr double kLeastShare = 0.006;  // of all points
constexpr int kTries = 6000;           // pairs of points that are drawn
constexpr int kMostPlanes = 48;        // at most 64
constexpr int kMostDistinct = 400;     // planes to choose from
constexpr int kNearest = 8;            // rank of the nearest partner
constexpr double kSame = 0.99, kShared = 0.7;    // cosine, and share of the points, of one plane
constexpr double kWithinPx = 12, kBesidePx = 3;  // [pixel footprints] what lies around a point
// Score of a plane all of whose tangents are parallel, for that of one with edges of two
// directions.
constexpr double kParallel = 0.4;

struct Candidate {
  EdgePlane plane;
  std::vector<int> points;
  double weight = 1;
  bool taken = false;
};

class EdgePlanes {
 public:
  EdgePlanes(const SureEdges& edges, int seed)
      : edges_(edges),
        seed_(seed),
        n_(int(edges.position.cols())),
        reach_(kPlanePx * edges.footprint),
        sine_(std::sin(kPlaneDeg * M_PI / 180)),
        fewest_(std::max(kFewestPoints, int(kLeastShare * n_))) {}

  std::vector<EdgePlane> run() const {
    std::vector<Candidate> candidates = distinct(drawn());
    for (Candidate& c : candidates) c.weight = weight(c.points);
    return choose(&candidates);
  }

 private:
  // Planes through the tangent of one point and another point, the best supported first.
  std::vector<Candidate> drawn() const {
    if (n_ < fewest_) return {};
    std::mt19937 random(1u + seed_);
    std::vector<std::pair<int, double>> pairs(kTries);
    for (auto& p : pairs) p = {int(random() % n_), (random() % 65536) / 65536.0};
    std::vector<Candidate> out(pairs.size());
    parallel_for(int(pairs.size()), 16, [&](int k) {
      const auto [i, share] = pairs[k];
      if (through(i, partner(i, share), &out[k].plane)) out[k].points = near(out[k].plane);
    });
    out.erase(std::remove_if(out.begin(), out.end(),
                             [&](const Candidate& c) { return int(c.points.size()) < fewest_; }),
              out.end());
    std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
      return a.points.size() > b.points.size();
    });
    return out;
  }

  // All scales alike: ranks by distance whose logarithms are spread evenly.
  int partner(int i, double share) const {
    std::vector<std::pair<double, int>> order(n_);
    for (int k = 0; k < n_; ++k)
      order[k] = {(edges_.position.col(k) - edges_.position.col(i)).squaredNorm(), k};
    const int rank = std::min(n_ - 1, int(kNearest * std::pow(double(n_) / kNearest, share)));
    std::nth_element(order.begin(), order.begin() + rank, order.end());
    return order[rank].second;
  }

  bool through(int i, int j, EdgePlane* plane) const {
    const Vector3d way = edges_.position.col(j) - edges_.position.col(i);
    if (way.norm() < kNearest * reach_) return false;
    const Vector3d normal = edges_.tangent.col(i).cross(way.normalized());
    if (normal.norm() < 0.1) return false;
    *plane = EdgePlane(normal.normalized(), Vector3d(edges_.position.col(i)));
    return std::abs(plane->normal().dot(edges_.tangent.col(j))) < sine_;
  }

  std::vector<int> near(const EdgePlane& plane) const {
    std::vector<int> points;
    for (int k = 0; k < n_; ++k)
      if (plane.absDistance(edges_.position.col(k)) < reach_ &&
          std::abs(plane.normal().dot(edges_.tangent.col(k))) < sine_)
        points.push_back(k);
    return points;
  }

  EdgePlane fit(const std::vector<int>& points) const {
    const Eigen::Matrix3Xd p = edges_.position(Eigen::all, points);
    const Vector3d mean = p.rowwise().mean();
    const Eigen::Matrix3Xd q = p.colwise() - mean;
    const auto es = eigen_symmetric(q * q.transpose());
    return EdgePlane(Vector3d(es.vectors.col(0)), mean);
  }

  // The same as one of these?
  bool known(const Candidate& c, const std::vector<Candidate>& others) const {
    for (const Candidate& other : others) {
      if (std::abs(c.plane.normal().dot(other.plane.normal())) < kSame) continue;
      const auto both = std::count_if(c.points.begin(), c.points.end(), [&](int k) {
        return other.plane.absDistance(edges_.position.col(k)) < 3 * reach_;
      });
      if (double(both) > kShared * double(c.points.size())) return true;
    }
    return false;
  }

  std::vector<Candidate> distinct(const std::vector<Candidate>& drawn) const {
    std::vector<Candidate> out;
    for (Candidate c : drawn) {
      if (int(out.size()) == kMostDistinct) break;
      if (known(c, out)) continue;
      for (int round = 0; round < 2; ++round) c.plane = fit(c.points), c.points = near(c.plane);
      if (int(c.points.size()) >= fewest_ && !known(c, out)) out.push_back(c);
    }
    return out;
  }

  // Faces have edges of more than one direction, planes of two parallel edges do not.
  double weight(const std::vector<int>& points) const {
    const Eigen::Matrix3Xd t = edges_.tangent(Eigen::all, points);
    const auto es = eigen_symmetric(t * t.transpose());
    const Vector3d v = es.values;
    return kParallel + (1 - kParallel) * std::min(1.0, 4 * v[1] / (v[1] + v[2]));
  }

  // Are there points of the plane on both sides of this one? Then it lies inside a face.
  bool inside(int i, const Candidate& c) const {
    const Vector3d across = c.plane.normal().cross(edges_.tangent.col(i));
    bool left = false, right = false;
    for (const int k : c.points) {
      const Vector3d d = edges_.position.col(k) - edges_.position.col(i);
      if (d.norm() > kWithinPx * edges_.footprint) continue;
      left = left || across.dot(d) > kBesidePx * edges_.footprint;
      right = right || across.dot(d) < -kBesidePx * edges_.footprint;
    }
    return left && right;
  }

  std::vector<EdgePlane> choose(std::vector<Candidate>* candidates) const {
    const double part = std::cos(kPartDeg * M_PI / 180);
    std::vector<EdgePlane> planes;
    std::vector<std::vector<int>> of_point(n_);
    std::vector<char> full(n_, 0);
    const auto is_new = [&](int k, const EdgePlane& plane) {
      if (full[k]) return false;
      for (const int p : of_point[k])
        if (std::abs(planes[p].normal().dot(plane.normal())) > part) return false;
      return true;
    };
    while (int(planes.size()) < kMostPlanes) {
      Candidate* best = nullptr;
      double most = 0;
      for (Candidate& c : *candidates) {
        if (c.taken) continue;
        const auto gain = std::count_if(c.points.begin(), c.points.end(),
                                        [&](int k) { return is_new(k, c.plane); });
        if (gain < fewest_ || double(gain) < kLeastNew * double(c.points.size())) continue;
        if (c.weight * double(gain) > most) most = c.weight * double(gain), best = &c;
      }
      if (!best) break;
      best->taken = true;
      for (const int k : best->points) {
        of_point[k].push_back(int(planes.size()));
        full[k] = full[k] || of_point[k].size() == 2 || inside(k, *best);
      }
      planes.push_back(best->plane);
    }
    return planes;
  }

  const SureEdges& edges_;
  const int seed_, n_;
  const double reach_, sine_;
  const int fewest_;
};

}  // namespace

std::vector<EdgePlane> edge_planes(const SureEdges& edges, int seed) {
  return EdgePlanes(edges, seed).run();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/degree.h"
#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kNeighbours = 8;
constexpr double kNear = 2.5;      // [spacings] to a neighbour
constexpr double kNearAngle = 45;  // [deg] between neighbours' normals
constexpr double kStrip = 2;       // [spacings] width of a narrow strip
constexpr int kRounds = 8;         // of growing and fitting

struct Plane {
  Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
};

class Regions {
 public:
  Regions(double spacing, const PlaneOptions& options, const SurfelSet& set)
      : spacing_(spacing),
        options_(options),
        center_(set.values.middleRows<3>(SurfelSet::kCenter)) {
    const int n = set.size();
    normal_.resize(3, n);
    for (int i = 0; i < n; ++i) normal_.col(i) = set.normal(i);
    near_.resize(n);
    for (const auto& [i, j] : neighbour_pairs(set, kNeighbours, kNear * spacing, kNearAngle))
      near_[i].push_back(j), near_[j].push_back(i);
    taken_.assign(n, 0);
  }

  // Surfels by how little their neighbours turn away.
  std::vector<int> seeds() const {
    std::vector<double> turn(near_.size(), 1e9);
    for (size_t i = 0; i < near_.size(); ++i) {
      if (int(near_[i].size()) < 3) continue;
      double sum = 0;
      for (const int j : near_[i])
        sum += 1 - normal_.col(i).dot(normal_.col(j)) +
               std::pow(normal_.col(i).dot(center_.col(j) - center_.col(i)) / spacing_, 2);
      turn[i] = sum / near_[i].size();
    }
    std::vector<int> order(near_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return turn[a] < turn[b]; });
    return order;
  }

  // The plane about a seed and what lies on it; empty if that is too little, or bent.
  std::vector<int> grow(int seed, Plane* plane) {
    std::vector<int> region;
    if (taken_[seed]) return region;
    region = {seed};
    for (const int j : near_[seed])
      if (!taken_[j]) region.push_back(j);
    *plane = fit(region);
    for (int round = 0; round < kRounds; ++round) {
      std::vector<int> next = reach(seed, *plane);
      if (next.size() < 3) return {};
      const bool same = next.size() == region.size();
      region = std::move(next);
      *plane = fit(region);
      if (same) break;
    }
    if (int(region.size()) < options_.fewest || bent(region, *plane)) return {};
    for (const int i : region) taken_[i] = 1;
    return region;
  }

 private:
  Plane fit(const std::vector<int>& region) const {
    Plane p;
    Vector3d mean = Vector3d::Zero();
    for (const int i : region) p.middle += center_.col(i), mean += normal_.col(i);
    p.middle /= double(region.size());
    mean.normalize();
    Matrix3d scatter = Matrix3d::Zero();
    for (const int i : region) {
      const Vector3d d = center_.col(i) - p.middle;
      scatter += d * d.transpose();
    }
    const auto es = eigen_symmetric(scatter);
    // Of a narrow strip the places say too little about its turn.
    const double width = std::sqrt(12 * es.values[1] / region.size());
    p.normal = width > kStrip * spacing_ ? Vector3d(es.vectors.col(0)) : mean;
    if (p.normal.dot(mean) < 0) p.normal = -p.normal;
    return p;
  }

  bool on(int i, const Plane& plane) const {
    return normal_.col(i).dot(plane.normal) > std::cos(options_.angle_deg * kDegree) &&
           std::abs(plane.normal.dot(center_.col(i) - plane.middle)) < options_.reach * spacing_;
  }

  std::vector<int> reach(int seed, const Plane& plane) const {
    std::vector<char> seen(near_.size(), 0);
    std::vector<int> queue = {seed}, out;
    seen[seed] = 1;
    for (size_t k = 0; k < queue.size(); ++k) {
      const int i = queue[k];
      if (!on(i, plane)) continue;
      out.push_back(i);
      for (const int j : near_[i])
        if (!seen[j] && !taken_[j]) seen[j] = 1, queue.push_back(j);
    }
    return out;
  }

  // Do normals turn steadily along the region? On a round surface they do.
  bool bent(const std::vector<int>& region, const Plane& plane) const {
    const Vector3d u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
    Matrix3d A = Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> B = Eigen::Matrix<double, 3, 2>::Zero();
    for (const int i : region) {
      const Vector3d d = center_.col(i) - plane.middle;
      const Vector3d b(1, d.dot(u), d.dot(v));
      A += b * b.transpose();
      B += b * Eigen::RowVector2d(normal_.col(i).dot(u), normal_.col(i).dot(v));
    }
    const Eigen::Matrix<double, 3, 2> fit = solve_symmetric(A, B);
    const Eigen::Matrix2d slope = fit.bottomRows<2>();  // d normal / d place
    const auto es = eigen_symmetric((slope + slope.transpose()) / 2);
    double most = 0;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d axis = es.vectors.col(k);
      double lo = 1e300, hi = -1e300;
      for (const int i : region) {
        const Vector3d d = center_.col(i) - plane.middle;
        const double s = axis.x() * d.dot(u) + axis.y() * d.dot(v);
        lo = std::min(lo, s), hi = std::max(hi, s);
      }
      most = std::max(most, std::abs(es.values[k]) * (hi - lo));
    }
    return most > options_.bend_deg * kDegree;
  }

  const double spacing_;
  const PlaneOptions options_;
  const Eigen::Matrix3Xd center_;
  Eigen::Matrix3Xd normal_;
  std::vector<std::vector<int>> near_;
  std::vector<char> taken_;
};

}  // namespace

std::vector<char> flatten_surfels(double spacing, const PlaneOptions& options, SurfelSet* set) {
  std::vector<char> flat(set->size(), 0);
  if (set->size() == 0 || options.fewest <= 0) return flat;
  Regions regions(spacing, options, *set);
  for (const int seed : regions.seeds()) {
    Plane plane;
    for (const int i : regions.grow(seed, &plane)) {
      const Vector3d center = set->center(i);
      set->lay(i, center - plane.normal.dot(center - plane.middle) * plane.normal, plane.normal);
      flat[i] = 1;
    }
  }
  return flat;
}

}  // namespace sketchsplat

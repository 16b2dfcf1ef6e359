// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_cylinders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <random>
#include <utility>

#include "datasets/neighbours/kd_tree.h"
#include "datasets/types/degree.h"
#include "datasets/types/dense.h"
#include "datasets/types/parallel.h"
#include "datasets/types/widest_gap.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kGap = 2;              // [spacings] between surfels of one cylinder
constexpr int kRounds = 8, kSteps = 3;  // of choosing and fitting; of a fit
constexpr int kPairs = 2;               // that each surfel proposes a cylinder with
constexpr int kMostPairs = 10000;       // of all surfels
constexpr int kLongestWalk = 6;         // log2 of the steps from a surfel to the other of its pair
constexpr int kWalks = 4;               // until the other one's normal differs enough
constexpr double kLeastTurnDeg = 12;    // [deg] between the normals of a pair
constexpr double kLeastArc = 0.5;       // of the arc asked for, before a cylinder is fitted
// A radian of a normal weighs as so many spacings of a place: fits are wrong by a fifth of a
// spacing and by 0.1 rad, about.
constexpr double kTilt = 2;

struct Cylinder {
  Vector3d point = Vector3d::Zero(), axis = Vector3d::UnitZ();
  double radius = 0;
  double side = 1;  // +1: normals point away from the axis

  double height(const Vector3d& p) const { return axis.dot(p - point); }
  Vector3d from_axis(const Vector3d& p) const { return p - point - height(p) * axis; }
};

// Cylinders that pairs of neighbouring surfels propose, by how many surfels lie on them.
class CylinderPool {
 public:
  // `from`: indices into `set` of the surfels that count.
  CylinderPool(const SurfelSet& set, std::vector<int> from, double spacing,
               const CylinderOptions& options)
      : from_(std::move(from)),
        reach_(options.reach * spacing),
        cosine_(std::cos(options.angle_deg * kDegree)),
        points_(from_.size(), 3),
        normals_(from_.size(), 3),
        free_(from_.size(), 1),
        near_(from_.size()) {
    for (size_t k = 0; k < from_.size(); ++k) {
      points_.row(k) = set.center(from_[k]).transpose();
      normals_.row(k) = set.normal(from_[k]).transpose();
    }
    find_neighbours(kGap * spacing);
    propose(options.seed);
  }

  // The cylinder with the largest connected set of free surfels, and that set, ascending; false if
  // there is none of at least `fewest`. No cylinder comes twice.
  bool next(int fewest, Cylinder* c, std::vector<int>* on) {
    while (!queue_.empty()) {
      const auto [most, k] = queue_.top();  // as many as it had; it can only have lost some
      if (most < fewest) return false;
      queue_.pop();
      std::vector<int> part = largest_part(proposed_[k]);
      if (!queue_.empty() && int(part.size()) < queue_.top().first) {
        queue_.push({int(part.size()), k});
        continue;
      }
      if (int(part.size()) < fewest) return false;
      *c = proposed_[k];
      on->clear();
      for (const int i : part) on->push_back(from_[i]);
      return true;
    }
    return false;
  }

  // Surfels that count no more; `gone` as from next() or SurfelSet.
  void remove(const std::vector<int>& gone) {
    for (const int i : gone) {
      const auto at = std::lower_bound(from_.begin(), from_.end(), i);
      if (at != from_.end() && *at == i) free_[at - from_.begin()] = 0;
    }
  }

 private:
  void find_neighbours(double radius) {
    const KdTree tree(points_.transpose());
    parallel_for(int(from_.size()), [&](int i) { near_[i] = tree.within(points_.row(i), radius); });
  }

  void propose(int seed) {
    const int n = int(from_.size()), pairs = std::min(kPairs * n, kMostPairs);
    std::mt19937 random(1u + seed);
    for (int k = 0; k < pairs; ++k) {
      const int i = int(int64_t(k) * n / pairs);
      for (int walk = 0; walk < kWalks; ++walk) {
        int j = i;
        for (int left = 1 << (1 + random() % kLongestWalk); left > 0 && !near_[j].empty(); --left)
          j = near_[j][random() % near_[j].size()];
        Cylinder c;
        if (!through(i, j, &c)) continue;
        proposed_.push_back(c);
        break;
      }
    }
    std::vector<int> count(proposed_.size());
    parallel_for(int(proposed_.size()), [&](int k) { count[k] = count_on(proposed_[k]); });
    for (size_t k = 0; k < proposed_.size(); ++k) queue_.push({count[k], int(k)});
  }

  // The cylinder of two surfels: its axis is across both normals and where these meet.
  bool through(int i, int j, Cylinder* c) const {
    const Vector3d p = points_.row(i), q = points_.row(j), n = normals_.row(i), m = normals_.row(j);
    const Vector3d across = n.cross(m);
    if (across.norm() < std::sin(kLeastTurnDeg * kDegree)) return false;
    c->axis = across.normalized();
    const Vector3d apart = q - p - c->axis.dot(q - p) * c->axis, turn = n - m;
    const double along = apart.dot(turn) / turn.squaredNorm();
    if ((apart - along * turn).norm() > 2 * reach_) return false;
    c->point = p + along * n;
    c->radius = std::abs(along), c->side = along < 0 ? 1 : -1;
    return c->radius > 0;
  }

  template <typename F>
  void each_on(const Cylinder& c, const F& f) const {
    const double low = std::max(0.0, c.radius - reach_), high = c.radius + reach_;
    for (int i = 0; i < int(from_.size()); ++i) {
      const double x = points_(i, 0) - c.point[0], y = points_(i, 1) - c.point[1],
                   z = points_(i, 2) - c.point[2];
      const double u = normals_(i, 0), v = normals_(i, 1), w = normals_(i, 2);
      const double height = x * c.axis[0] + y * c.axis[1] + z * c.axis[2];
      const double tilt = u * c.axis[0] + v * c.axis[1] + w * c.axis[2];
      const double square = x * x + y * y + z * z - height * height;
      const double facing = c.side * (x * u + y * v + z * w - height * tilt);
      f(i, bool(int(square > low * low) & int(square < high * high) & int(facing > 0) &
                int(facing * facing > cosine_ * cosine_ * square)));
    }
  }

  int count_on(const Cylinder& c) const {
    int count = 0;
    each_on(c, [&](int, bool on) { count += on; });
    return count;
  }

  // The largest set of free surfels on the cylinder that hang together, ascending.
  std::vector<int> largest_part(const Cylinder& c) const {
    std::vector<char> open(from_.size(), 0);
    each_on(c, [&](int i, bool on) { open[i] = on && free_[i]; });
    std::vector<int> best, part;
    for (int i = 0; i < int(open.size()); ++i) {
      if (!open[i]) continue;
      open[i] = 0, part.assign(1, i);
      for (size_t k = 0; k < part.size(); ++k)
        for (const int j : near_[part[k]])
          if (open[j]) open[j] = 0, part.push_back(j);
      if (part.size() > best.size()) best.swap(part);
    }
    std::sort(best.begin(), best.end());
    return best;
  }

  using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  const std::vector<int> from_;  // ascending
  const double reach_, cosine_;
  Points points_, normals_;  // a surfel a row
  std::vector<char> free_;
  std::vector<std::vector<int>> near_;
  std::vector<Cylinder> proposed_;
  std::priority_queue<std::pair<int, int>> queue_;  // most surfels, index into proposed_
};

class Cylinders {
 public:
  Cylinders(double spacing, const CylinderOptions& options, const std::vector<char>& taken,
            SurfelSet* set)
      : spacing_(spacing), options_(options), taken_(taken), set_(*set) {}

  // Lays surfels on cylinders, the largest first; how many.
  int lay_all() {
    std::vector<int> from;
    for (int i = 0; i < set_.size(); ++i)
      if (!taken_[i]) from.push_back(i);
    if (int(from.size()) < options_.fewest) return 0;
    CylinderPool pool(set_, std::move(from), spacing_, options_);
    int count = 0;
    Cylinder c;
    for (std::vector<int> on; pool.next(options_.fewest, &c, &on);) {
      if (arc(c, on) < kLeastArc * options_.arc_deg * kDegree) continue;
      pool.remove(on);  // be it a cylinder or not
      if (!settle(&c, &on)) continue;
      pool.remove(on);
      lay(c, on);
      count += int(on.size());
    }
    return count;
  }

 private:
  // Fits the cylinder to what lies on it, and finds that anew; false if it is none.
  bool settle(Cylinder* c, std::vector<int>* on) const {
    for (int round = 0; round < kRounds; ++round) {
      if (int(on->size()) < options_.fewest) return false;
      if (!fit(*on, c)) return false;
      std::vector<int> next = reach(*c, *on);
      const bool same = next == *on;
      *on = std::move(next);
      if (same) break;
    }
    return int(on->size()) >= options_.fewest && lean(*c, *on) <= options_.lean_deg * kDegree &&
           arc(*c, *on) >= options_.arc_deg * kDegree;
  }

  void lay(const Cylinder& c, const std::vector<int>& on) {
    for (const int i : on) {
      const Vector3d p = set_.center(i), away = c.from_axis(p).normalized();
      set_.lay(i, c.point + c.height(p) * c.axis + c.radius * away, c.side * away);
      taken_[i] = 1;
    }
  }

  // Gauss-Newton over two shifts and two tilts of the axis, and the radius.
  bool fit(const std::vector<int>& on, Cylinder* c) const {
    for (int step = 0; step < kSteps; ++step) {
      double middle = 0, side = 0;
      for (const int i : on) {
        middle += c->height(set_.center(i)) / on.size();
        side += c->from_axis(set_.center(i)).normalized().dot(set_.normal(i));
      }
      c->point += middle * c->axis;
      c->side = side < 0 ? -1 : 1;
      const Vector3d u = c->axis.unitOrthogonal(), v = c->axis.cross(u);
      using Vector5 = Eigen::Matrix<double, 5, 1>;
      Eigen::Matrix<double, 5, 5> H = Eigen::Matrix<double, 5, 5>::Zero();
      Vector5 g = Vector5::Zero();
      const auto add = [&](double residual, const Vector5& slope) {
        H += slope * slope.transpose();
        g += slope * residual;
      };
      for (const int i : on) {
        const Vector3d p = set_.center(i), from = c->from_axis(p), n = set_.normal(i);
        const Vector3d away = from.normalized();
        const double h = c->height(p), a = away.dot(u), b = away.dot(v);
        add((from.norm() - c->radius) / spacing_,
            (Vector5() << -a, -b, -h * a, -h * b, -1).finished() / spacing_);
        add(kTilt * n.dot(c->axis), kTilt * (Vector5() << 0, 0, n.dot(u), n.dot(v), 0).finished());
      }
      const Vector5 x = solve_symmetric(H, -g);
      if (!x.allFinite()) return false;
      c->point += x[0] * u + x[1] * v;
      c->axis = (c->axis + x[2] * u + x[3] * v).normalized();
      c->radius += x[4];
    }
    return c->radius > 0;
  }

  // Free surfels on the cylinder, from end to end of those known and a gap farther.
  std::vector<int> reach(const Cylinder& c, const std::vector<int>& known) const {
    double low = 1e300, high = -1e300;
    for (const int i : known) {
      const double h = c.height(set_.center(i));
      low = std::min(low, h), high = std::max(high, h);
    }
    const double gap = kGap * spacing_, least = std::cos(options_.angle_deg * kDegree);
    std::vector<int> on;
    for (int i = 0; i < set_.size(); ++i) {
      if (taken_[i]) continue;
      const Vector3d p = set_.center(i), from = c.from_axis(p);
      const double h = c.height(p);
      if (h > low - gap && h < high + gap &&
          std::abs(from.norm() - c.radius) < options_.reach * spacing_ &&
          c.side * from.normalized().dot(set_.normal(i)) > least)
        on.push_back(i);
    }
    return on;
  }

  // How far normals lean along the axis, root mean square of what changes steadily from end to end
  // and up to twice about the turn [rad]: pieces of cones, spheres and bent pipes do.
  double lean(const Cylinder& c, const std::vector<int>& on) const {
    const Vector3d u = c.axis.unitOrthogonal(), v = c.axis.cross(u);
    Eigen::Matrix<double, Eigen::Dynamic, 10> basis(on.size(), 10);
    Eigen::VectorXd leans(on.size());
    for (size_t k = 0; k < on.size(); ++k) {
      const Vector3d p = set_.center(on[k]), away = c.from_axis(p).normalized();
      const double x = away.dot(u), y = away.dot(v);
      basis.row(k).head<5>() << 1, x, y, x * x - y * y, 2 * x * y;
      basis.row(k).tail<5>() = c.height(p) / c.radius * basis.row(k).head<5>();
      leans[k] = c.axis.dot(set_.normal(on[k]));
    }
    const Eigen::VectorXd steady = basis * least_squares(basis, leans);
    return steady.norm() / std::sqrt(double(on.size()));
  }

  // What is left of a turn without the widest gap [rad].
  double arc(const Cylinder& c, const std::vector<int>& on) const {
    Eigen::Matrix3Xd out(3, Eigen::Index(on.size()));
    for (size_t k = 0; k < on.size(); ++k)
      out.col(Eigen::Index(k)) = c.from_axis(set_.center(on[k]));
    return 2 * M_PI - widest_gap(out, c.axis);
  }

  const double spacing_;
  const CylinderOptions options_;
  std::vector<char> taken_;
  SurfelSet& set_;
};

}  // namespace

int round_surfels(double spacing, const CylinderOptions& options, const std::vector<char>& taken,
                  SurfelSet* set) {
  if (set->size() == 0 || options.fewest <= 0) return 0;
  return Cylinders(spacing, options, taken, set).lay_all();
}

}  // namespace sketchsplat

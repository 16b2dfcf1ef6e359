// SPDX-License-Identifier: MIT
#include "edges/surfel_cylinders.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Shape_detection/Efficient_RANSAC.h>
#include <CGAL/property_map.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
constexpr double kGap = 2;              // [spacings] between surfels of one cylinder
constexpr double kMissed = 0.001;       // probability that RANSAC misses the largest cylinder
constexpr int kRounds = 8, kSteps = 3;  // of choosing and fitting; of a fit
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

class Cylinders {
 public:
  Cylinders(double spacing, const CylinderOptions& options, const std::vector<char>& taken,
            SurfelSet* set)
      : spacing_(spacing), options_(options), taken_(taken), set_(*set) {}

  // What RANSAC finds, the largest first, and the surfels on it.
  std::vector<std::pair<Cylinder, std::vector<int>>> candidates() const {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Item = std::tuple<Kernel::Point_3, Kernel::Vector_3, int>;
    using Traits =
        CGAL::Shape_detection::Efficient_RANSAC_traits<Kernel, std::vector<Item>,
                                                       CGAL::Nth_of_tuple_property_map<0, Item>,
                                                       CGAL::Nth_of_tuple_property_map<1, Item>>;
    using Shape = CGAL::Shape_detection::Cylinder<Traits>;
    const auto vector = [](const auto& v) { return Vector3d(v.x(), v.y(), v.z()); };
    std::vector<Item> items;
    for (int i = 0; i < set_.size(); ++i) {
      const Vector3d p = set_.center(i), n = set_.normal(i);
      if (!taken_[i])
        items.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()),
                           Kernel::Vector_3(n.x(), n.y(), n.z()), i);
    }
    std::vector<std::pair<Cylinder, std::vector<int>>> found;
    if (int(items.size()) < options_.fewest) return found;
    CGAL::get_default_random() = CGAL::Random(0);  // of this thread; it chooses the samples
    CGAL::Shape_detection::Efficient_RANSAC<Traits> ransac;
    ransac.set_input(items);  // which it reorders
    ransac.template add_shape_factory<Shape>();
    typename CGAL::Shape_detection::Efficient_RANSAC<Traits>::Parameters parameters;
    parameters.probability = kMissed;
    parameters.min_points = options_.fewest;
    parameters.epsilon = options_.reach * spacing_;
    parameters.cluster_epsilon = kGap * spacing_;
    parameters.normal_threshold = std::cos(options_.angle_deg * kDegree);
    ransac.detect(parameters);
    for (const auto& shape : ransac.shapes()) {
      const Shape& s = dynamic_cast<const Shape&>(*shape);
      Cylinder c;
      c.point = vector(s.axis().point(0)), c.axis = vector(s.axis().to_vector()).normalized();
      c.radius = s.radius();
      std::vector<int> on;
      for (const auto k : s.indices_of_assigned_points()) on.push_back(std::get<2>(items[k]));
      std::sort(on.begin(), on.end());
      found.push_back({c, std::move(on)});
    }
    return found;
  }

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

 private:
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
      const Vector5 x = H.ldlt().solve(-g);
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
    const Eigen::VectorXd steady = basis * basis.colPivHouseholderQr().solve(leans);
    return steady.norm() / std::sqrt(double(on.size()));
  }

  // What is left of a turn without the widest gap [rad].
  double arc(const Cylinder& c, const std::vector<int>& on) const {
    const Vector3d u = c.axis.unitOrthogonal(), v = c.axis.cross(u);
    std::vector<double> at;
    for (const int i : on) {
      const Vector3d from = c.from_axis(set_.center(i));
      at.push_back(std::atan2(from.dot(v), from.dot(u)));
    }
    std::sort(at.begin(), at.end());
    double gap = at.front() + 2 * M_PI - at.back();
    for (size_t k = 1; k < at.size(); ++k) gap = std::max(gap, at[k] - at[k - 1]);
    return 2 * M_PI - gap;
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
  Cylinders cylinders(spacing, options, taken, set);
  int count = 0;
  for (auto& [cylinder, on] : cylinders.candidates()) {
    if (!cylinders.settle(&cylinder, &on)) continue;
    cylinders.lay(cylinder, on);
    count += int(on.size());
  }
  return count;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "eval/solids/solid_dimensions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "eval/inspect/neighbours.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
// Curves may lie so far beside their surfaces before these are adjusted; of the extent.
constexpr double kSame = 1.5e-3;

bool square(const Vector3d& a, const Vector3d& b) {
  return std::abs(a.dot(b)) < std::sin(0.1 * kDegree);
}

// The second one's sense is turned to that of the other.
Vector3d mean_direction(const Vector3d& a, const Vector3d& b) {
  return (a + (a.dot(b) < 0 ? -1 : 1) * b).normalized();
}

double value_of(const SolidDimension& d, const std::vector<Surface>& all) {
  const Surface &a = all[d.surfaces.front()], &b = all[d.surfaces.back()];
  const Vector3d from = b.origin - a.origin;
  switch (d.kind) {
    case SolidDimensionKind::kDiameter:
    case SolidDimensionKind::kRingDiameter:
      return 2 * a.radius;
    case SolidDimensionKind::kRadius:
      return a.radius;
    case SolidDimensionKind::kTubeRadius:
      return a.minor_radius;
    case SolidDimensionKind::kConeAngle:
      return 2 * std::atan(std::abs(a.slope)) / kDegree;
    case SolidDimensionKind::kPlaneDistance:
      return std::abs(from.dot(mean_direction(a.axis, b.axis)));
    case SolidDimensionKind::kAxisToPlane:
      return std::abs(from.dot(b.axis));
    case SolidDimensionKind::kAxisDistance: {
      const Vector3d u = mean_direction(a.axis, b.axis);
      return (from - u * u.dot(from)).norm();
    }
    case SolidDimensionKind::kPlaneAngle: {
      const Vector3d n = (d.opposite ? -1 : 1) * b.axis;
      return 180 - std::atan2(a.axis.cross(n).norm(), a.axis.dot(n)) / kDegree;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

class Finder {
 public:
  Finder(const Solid& solid, const SurfaceErrors& errors)
      : solid_(solid),
        errors_(errors),
        surfaces_(errors.surfaces()),
        same_(kSame * errors.reach()) {}

  std::vector<SolidDimension> find() {
    for (int s = 0; s < int(surfaces_.size()); ++s) find_sizes(s);
    find_planes();
    find_axes();
    find_angles();
    return std::move(list_);
  }

 private:
  void add(SolidDimensionKind kind, const std::vector<int>& surfaces, bool opposite = false) {
    SolidDimension d{kind, surfaces, opposite, 0, 0};
    d.value = value_of(d, surfaces_);
    d.sigma =
        errors_.sigma([&](const std::vector<Surface>& all) { return value_of(d, all); }, surfaces);
    list_.push_back(d);
  }

  // The largest angle about the axis without a place of its curves is no more than half a turn.
  bool runs_around(int surface) const {
    constexpr int kPlaces = 64;
    const Surface& s = surfaces_[surface];
    const Vector3d x = s.axis.unitOrthogonal(), y = s.axis.cross(x);
    std::vector<double> angles;
    for (const SolidFace& face : solid_.faces) {
      if (face.surface != surface) continue;
      if (face.loops.empty()) return true;
      for (const Loop& loop : face.loops)
        for (const LoopStroke& part : loop)
          for (int i = 0; i <= kPlaces; ++i) {
            Vector3d p, d;
            evaluate_stroke(solid_.edges, part.stroke, double(i) / kPlaces, &p, &d);
            angles.push_back(std::atan2((p - s.origin).dot(y), (p - s.origin).dot(x)));
          }
    }
    if (angles.empty()) return false;
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + 2 * M_PI - angles.back();
    for (size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    return gap <= M_PI + 0.1 * kDegree;
  }

  void find_sizes(int s) {
    using Kind = SolidDimensionKind;
    switch (surfaces_[s].kind) {
      case SurfaceKind::kPlane:
      case SurfaceKind::kExtrusion:
        break;
      case SurfaceKind::kCylinder:
      case SurfaceKind::kSphere:
        add(runs_around(s) ? Kind::kDiameter : Kind::kRadius, {s});
        break;
      case SurfaceKind::kCone:
        add(Kind::kConeAngle, {s});
        break;
      case SurfaceKind::kTorus:
        add(Kind::kRingDiameter, {s});
        add(Kind::kTubeRadius, {s});
        break;
    }
  }

  std::vector<int> planes() const {
    std::vector<int> out;
    for (int s = 0; s < int(surfaces_.size()); ++s)
      if (surfaces_[s].kind == SurfaceKind::kPlane) out.push_back(s);
    return out;
  }

  void find_planes() {
    const auto direction = [&](int p) { return surfaces_[p].axis; };
    const auto offset = [&](int a, int b) {
      return (surfaces_[b].origin - surfaces_[a].origin).dot(surfaces_[a].axis);
    };
    for (const auto& [a, b] : parallel_neighbours(planes(), direction, offset, same_))
      add(SolidDimensionKind::kPlaneDistance, {a, b});
  }

  // Of the planes parallel to an axis, the nearer of the two outer ones of each direction.
  void find_positions(int axis) {
    const Surface& s = surfaces_[axis];
    std::set<int> done;
    for (const int a : planes()) {
      if (done.count(a)) continue;
      std::vector<std::pair<double, int>> offsets;
      for (const int b : planes())
        if (parallel(surfaces_[a].axis, surfaces_[b].axis)) {
          done.insert(b);
          offsets.push_back({(surfaces_[b].origin - s.origin).dot(surfaces_[a].axis), b});
        }
      if (!square(s.axis, surfaces_[a].axis)) continue;
      const auto [low, high] = std::minmax_element(offsets.begin(), offsets.end());
      const auto& near = std::abs(low->first) <= std::abs(high->first) ? *low : *high;
      if (std::abs(near.first) > same_) add(SolidDimensionKind::kAxisToPlane, {axis, near.second});
    }
  }

  void find_axes() {
    const auto distance = [&](int a, int b) {
      return value_of({SolidDimensionKind::kAxisDistance, {a, b}, false, 0, 0}, surfaces_);
    };
    std::vector<std::vector<int>> parallels;
    for (int s = 0; s < int(surfaces_.size()); ++s) {
      const SurfaceKind kind = surfaces_[s].kind;
      if ((kind != SurfaceKind::kCylinder && kind != SurfaceKind::kCone) || !runs_around(s))
        continue;
      const auto alike = std::find_if(parallels.begin(), parallels.end(), [&](const auto& set) {
        return parallel(surfaces_[set[0]].axis, surfaces_[s].axis);
      });
      if (alike == parallels.end())
        parallels.push_back({s});
      else if (std::none_of(alike->begin(), alike->end(),
                            [&](int other) { return distance(other, s) <= same_; }))
        alike->push_back(s);
    }
    for (const std::vector<int>& set : parallels) {
      for (const int axis : set) find_positions(axis);
      for (const auto& [i, k] :
           spanning_tree(int(set.size()), [&](int a, int b) { return distance(set[a], set[b]); }))
        add(SolidDimensionKind::kAxisDistance, {set[i], set[k]});
    }
  }

  void find_angles() {
    std::map<int, std::vector<int>> faces_at;  // of every stroke
    for (int f = 0; f < int(solid_.faces.size()); ++f)
      for (const Loop& loop : solid_.faces[f].loops)
        for (const LoopStroke& s : loop) faces_at[s.stroke].push_back(f);
    std::set<std::pair<int, int>> done;
    for (const auto& [stroke, faces] : faces_at) {
      if (faces.size() != 2) continue;
      const SolidFace &f = solid_.faces[std::min(faces[0], faces[1])],
                      &g = solid_.faces[std::max(faces[0], faces[1])];
      const Surface &a = surfaces_[f.surface], &b = surfaces_[g.surface];
      if (a.kind != SurfaceKind::kPlane || b.kind != SurfaceKind::kPlane ||
          parallel(a.axis, b.axis) || square(a.axis, b.axis) ||
          !done.insert(std::minmax(f.surface, g.surface)).second)
        continue;
      add(SolidDimensionKind::kPlaneAngle, {f.surface, g.surface}, f.reversed != g.reversed);
    }
  }

  const Solid& solid_;
  const SurfaceErrors& errors_;
  const std::vector<Surface>& surfaces_;
  double same_;
  std::vector<SolidDimension> list_;
};

}  // namespace

const char* solid_dimension_name(SolidDimensionKind kind) {
  constexpr const char* kNames[] = {"diameter",      "radius",        "ring diameter",
                                    "tube radius",   "cone angle",    "plane distance",
                                    "axis to plane", "axis distance", "plane angle"};
  return kNames[int(kind)];
}

std::vector<SolidDimension> find_solid_dimensions(const Solid& solid, const SurfaceErrors& errors) {
  return Finder(solid, errors).find();
}

}  // namespace sketchsplat

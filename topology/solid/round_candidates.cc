// SPDX-License-Identifier: MIT
#include "topology/solid/round_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "topology/solid/round_families.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kLeast = 20;            // contour lines that a surface must explain,
constexpr double kLeastShare = 0.02;  // and share of all
constexpr int kSteps = 48;            // of a search for the free number
constexpr double kFlattest = 1.3;     // [rad] of a cap's centre below its rim, or above

class Finder {
 public:
  Finder(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines,
         const std::vector<ContourLine>& contours, double tolerance)
      : sketch_(sketch),
        polylines_(polylines),
        tolerance_(tolerance),
        extent_(largest_extent(sketch)),
        contours_(contours, tolerance),
        least_(std::max(kLeast, int(kLeastShare * double(contours.size())))) {
    for (int s = 0; s < sketch.size(); ++s)
      if (sketch.strokes[s].kind == StrokeKind::kCircle) {
        const CircleParameters c = circle_parameters(sketch, s);
        rims_.push_back({c.centre, c.normal, c.radius});
      }
  }

  RoundCandidates find(const std::vector<SurfaceStrokes>& known) {
    for (const SurfaceStrokes& s : known) explain(s);
    for (size_t i = 0; i < rims_.size(); ++i)
      for (size_t k = i + 1; k < rims_.size(); ++k) add_sphere(rims_[i], rims_[k]);
    add_rings();
    add_caps();
    add_bends();
    return std::move(found_);
  }

 private:
  void add(const Surface& surface, bool around_tube = false) {
    SurfaceStrokes s{surface, strokes_on(surface, polylines_, tolerance_), around_tube};
    found_.surfaces.push_back(std::move(s));
  }
  bool enough() const { return contours_.size() >= least_; }

  // Contours of a cylinder or a cone, as far as its strokes reach.
  void explain(const SurfaceStrokes& known) {
    const Surface& s = known.surface;
    if (s.kind == SurfaceKind::kPlane || !enough()) return;
    Eigen::AlignedBox3d box;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const int stroke : known.strokes)
      for (int i = 0; i < polylines_[stroke].cols(); ++i) {
        const Vector3d p = polylines_[stroke].col(i);
        box.extend(p);
        low = std::min(low, (p - s.origin).dot(s.axis));
        high = std::max(high, (p - s.origin).dot(s.axis));
      }
    const auto between = [=, origin = s.origin, axis = s.axis](const Vector3d& p) {
      const double up = (p - origin).dot(axis);
      return up > low && up < high;
    };
    contours_.remove(contours_.touching({s, box.center(), 0.75 * box.diagonal().norm(), between}));
  }

  bool coaxial(const Rim& a, const Rim& b) const {
    const Vector3d between = b.centre - a.centre;
    return std::abs(a.axis.dot(b.axis)) > 0.999 &&
           (between - a.axis * between.dot(a.axis)).norm() <= 2 * tolerance_;
  }

  // Of equal circles it would be a barrel, and a cylinder is simpler, until contours say otherwise.
  void add_sphere(const Rim& a, const Rim& b) {
    if (!coaxial(a, b)) return;
    const double rise = (b.centre - a.centre).dot(a.axis);
    if (std::abs(rise) <= 4 * tolerance_) return;
    const double up = (rise * rise + b.radius * b.radius - a.radius * a.radius) / (2 * rise);
    const Surface sphere{SurfaceKind::kSphere, a.centre + up * a.axis, a.axis,
                         std::hypot(a.radius, up)};
    if (sphere.radius > extent_) return;
    const auto anywhere = [](const Vector3d&) { return true; };
    const std::vector<int> lines =
        contours_.touching({sphere, sphere.origin, 1.5 * sphere.radius, anywhere});
    const bool seen = int(lines.size()) >= least_;
    if (!seen && std::abs(a.radius - b.radius) <= 4 * tolerance_) return;
    add(sphere);
    if (seen) contours_.remove(lines);
  }

  void add_rings() {
    std::vector<std::pair<double, std::pair<Rim, Rim>>> pairs;
    for (size_t i = 0; i < rims_.size(); ++i)
      for (size_t k = i + 1; k < rims_.size(); ++k) {
        const Rim &a = rims_[i], &b = rims_[k];
        const double far = std::hypot((b.centre - a.centre).norm(), b.radius - a.radius);
        if (coaxial(a, b) && far > 4 * tolerance_) pairs.push_back({far, {a, b}});
      }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    for (const auto& [far, pair] : pairs)
      for (const double side : {1.0, -1.0})
        take(rings(pair.first, pair.second), side * 0.1, side * 2.5);
  }

  void add_caps() {
    for (Rim rim : rims_)
      for (int side = 0; side < 2; ++side) {
        take(caps(rim), -kFlattest, kFlattest);
        if (const std::optional<double> up = take(heads(rim), 4 * tolerance_, extent_))
          add_smooth(rim.centre + *up * rim.axis, rim.axis, rim.radius);
        rim.axis = -rim.axis;
      }
  }

  void add_bends() {
    std::vector<std::pair<Bend, double>> seen;
    std::vector<Bend> others;
    for (size_t i = 0; i < rims_.size(); ++i)
      for (size_t k = i + 1; k < rims_.size(); ++k) {
        const std::optional<Bend> bend = bend_of(rims_[i], rims_[k], tolerance_);
        if (!bend) continue;
        const std::optional<double> radius =
            take(bends(*bend), 1.01 * bend->radius, 1.01 * bend->largest(), true);
        if (!radius) {
          others.push_back(*bend);
          continue;
        }
        seen.emplace_back(*bend, *radius);
        add_smooth_ends(*bend, *radius);
      }
    for (const Bend& inner : others)  // the bore of a pipe shows no contour
      for (const auto& [outer, radius] : seen) {
        const bool same = (inner.corner - outer.corner).norm() <= 4 * tolerance_ &&
                          inner.to_a.cross(outer.to_a).norm() < 0.02 &&
                          inner.to_b.cross(outer.to_b).norm() < 0.02;
        const std::optional<RoundPatch> patch = same ? bends(inner)(radius) : std::nullopt;
        if (!patch) continue;
        add(patch->surface, true);
        add_smooth_ends(inner, radius);
      }
  }

  // Adds the member of a family on which contours agree, and says which it is.
  std::optional<double> take(const RoundFamily& family, double from, double to,
                             bool around_tube = false) {
    if (!enough()) return std::nullopt;
    const std::optional<Contours::Fit> fit = contours_.fit(family, from, to, kSteps, least_);
    if (!fit) return std::nullopt;
    add(family(fit->parameter)->surface, around_tube);
    contours_.remove(fit->lines);
    return fit->parameter;
  }

  void add_smooth_ends(const Bend& bend, double radius) {
    const double tangent = bend.tangent(radius);
    if (bend.length_a - tangent > 4 * tolerance_)
      add_smooth(bend.corner + tangent * bend.to_a, bend.to_a, bend.radius);
    if (bend.length_b - tangent > 4 * tolerance_)
      add_smooth(bend.corner + tangent * bend.to_b, bend.to_b, bend.radius);
  }
  void add_smooth(const Vector3d& centre, const Vector3d& axis, double radius) {
    found_.rims.push_back({StrokeKind::kCircle, -1, -1, {centre, radius * axis}, true});
  }

  const Sketch& sketch_;
  const std::vector<Matrix3Xd>& polylines_;
  double tolerance_, extent_;
  Contours contours_;  // that nothing explains yet
  int least_;
  std::vector<Rim> rims_;
  RoundCandidates found_;
};

}  // namespace

RoundCandidates round_candidates(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines,
                                 const std::vector<SurfaceStrokes>& known,
                                 const std::vector<ContourLine>& contours, double tolerance) {
  return Finder(sketch, polylines, contours, tolerance).find(known);
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "topology/solid/round_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "datasets/types/dense.h"
#include "sketches/curve/curve.h"
#include "topology/solid/round_families.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kLeast = 20;            // contour lines that a surface must explain,
constexpr double kLeastShare = 0.02;  // and share of all
constexpr int kSteps = 48;            // of a search for the free number
constexpr double kLeastBulge = 6;     // tolerances by which an arc leaves its chord
constexpr double kBallPrice = 1.5;    // [nat] that a ball costs more than a cone between two rims
constexpr double kFlattest = 1.3;     // [rad] of a cap's centre below its rim, or above

class Finder {
 public:
  Finder(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines,
         const std::vector<ContourLine>& contours, double tolerance)
      : polylines_(polylines),
        tolerance_(tolerance),
        extent_(largest_extent(sketch)),
        contours_(contours, tolerance),
        any_contours_(!contours.empty()),
        least_(std::max(kLeast, int(kLeastShare * double(contours.size())))) {
    for (int s = 0; s < sketch.size(); ++s) {
      const std::optional<CircleRim> rim = circle_rim(sketch, s, tolerance_);
      if (!rim || rim->radius > extent_) continue;
      const auto same = std::find_if(rims_.begin(), rims_.end(),
                                     [&](const CircleRim& r) { return alike(r, *rim); });
      if (same == rims_.end()) {
        rims_.push_back(*rim);
        strokes_.push_back({s});
      } else {
        strokes_[same - rims_.begin()].push_back(s);  // an arc of the same rim
      }
    }
  }

  RoundCandidates find(const std::vector<SurfaceStrokes>& known) {
    for (const SurfaceStrokes& s : known) explain(s);
    for (size_t i = 0; i < rims_.size(); ++i) {
      for (size_t k = i + 1; k < rims_.size(); ++k) {
        propose_sphere(i, k);
        propose_rings(rims_[i], rims_[k]);
        const std::optional<Bend> bend = bend_of(rims_[i], rims_[k], tolerance_);
        if (bend) bends_.push_back(*bend);
      }
    }
    for (const CircleRim& rim : rims_) propose_caps(rim);
    for (const Bend& bend : bends_) propose_bend(bend);
    take();
    add_hollows();
    return std::move(found_);
  }

 private:
  void add(const RoundPatch& patch, bool around_tube = false, double bonus = 0) {
    const Surface& s = patch.surface;
    found_.surfaces.push_back(
        {s, strokes_on(s, polylines_, tolerance_), around_tube, patch.holds, bonus});
  }
  bool alike(const CircleRim& a, const CircleRim& b) const {
    return (a.centre - b.centre).norm() <= 2 * tolerance_ &&
           std::abs(a.radius - b.radius) <= 2 * tolerance_ && std::abs(a.axis.dot(b.axis)) > 0.999;
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

  // The sphere nearest to two rims, in the least squares of |p|^2 - 2 c.p + (|c|^2 - r^2).
  Surface sphere_through(size_t i, size_t k) const {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    const Vector3d about = rims_[i].centre;
    for (const size_t rim : {i, k})
      for (const int s : strokes_[rim])
        for (int c = 0; c < polylines_[s].cols(); ++c) {
          const Vector3d p = polylines_[s].col(c) - about;
          const Eigen::Vector4d row(2 * p.x(), 2 * p.y(), 2 * p.z(), 1);
          normal += row * row.transpose();
          right += row * p.squaredNorm();
        }
    const Eigen::Vector4d x = solve_symmetric(normal, right);
    const double r2 = x[3] + x.head<3>().squaredNorm();
    return {SurfaceKind::kSphere, about + x.head<3>(), rims_[i].axis, std::sqrt(std::max(0.0, r2))};
  }

  // Of equal rims it would be a barrel.
  void propose_sphere(size_t i, size_t k) {
    const CircleRim &a = rims_[i], &b = rims_[k];
    const double rise = (b.centre - a.centre).dot(a.axis);
    if (!coaxial(a, b, tolerance_) || std::abs(rise) <= 4 * tolerance_) return;
    const Surface sphere = sphere_through(i, k);
    const double half = std::hypot(rise, a.radius - b.radius) / 2,
                 bulge = sphere.radius -
                         std::sqrt(std::max(0.0, sphere.radius * sphere.radius - half * half));
    if (bulge <= kLeastBulge * tolerance_) return;  // a cone is simpler
    const auto between = [=](const Vector3d& p) {
      const double height = (p - a.centre).dot(a.axis) / rise;
      return height > 0 && height < 1;
    };
    const RoundPatch patch{sphere, sphere.origin, sphere.radius, between};
    propose([patch](double) { return patch; }, 0, 0);
    if (std::abs(a.radius - b.radius) > 4 * tolerance_) hollows_.push_back(patch);
  }

  void propose_rings(const CircleRim& a, const CircleRim& b) {
    const double half = std::hypot((b.centre - a.centre).norm(), b.radius - a.radius) / 2;
    const double flattest = 2 * std::atan(kLeastBulge * tolerance_ / half);
    if (!coaxial(a, b, tolerance_) || !(flattest < 1)) return;
    for (const double side : {1.0, -1.0}) propose(rings(a, b), side * flattest, side * 2.5);
  }

  void propose_caps(CircleRim rim) {
    for (int side = 0; side < 2; ++side) {
      propose(caps(rim), -kFlattest, kFlattest);
      propose(tips(rim), M_PI / 2 - kFlattest, kFlattest);
      propose(heads(rim), 4 * tolerance_, extent_,
              [=](double up) { add_smooth(rim.centre, rim.axis, up, rim.radius); });
      rim.axis = -rim.axis;
    }
  }

  void propose_bend(const Bend& bend) {
    propose(
        bends(bend), 1.01 * bend.radius, 1.01 * bend.largest(),
        [=](double radius) { add_bends_about(bend, radius); }, true);
  }

  bool same_axes(const Bend& bend, const Bend& other) const {
    const auto run = [](const Vector3d& a, const Vector3d& b) { return a.cross(b).norm() <= 0.02; };
    return (bend.corner - other.corner).norm() <= 4 * tolerance_ &&
           ((run(bend.to_a, other.to_a) && run(bend.to_b, other.to_b)) ||
            (run(bend.to_a, other.to_b) && run(bend.to_b, other.to_a)));
  }

  // A bend, and those about the same axes: the bore of a pipe shows no contour.
  void add_bends_about(const Bend& outer, double radius) {
    for (const Bend& bend : bends_) {
      if (!same_axes(bend, outer)) continue;
      const std::optional<RoundPatch> patch = bends(bend)(radius);
      if (!patch) continue;
      if (std::abs(bend.radius - outer.radius) > 4 * tolerance_) add(*patch, true, bonus());
      add_smooth_ends(bend, radius);
    }
  }

  // A hollow shows no contour: it is taken about a centre that is known. Between other rims cones
  // are so much more common that balls are no choice, unless there are no contours at all.
  void add_hollows() {
    const std::vector<SurfaceStrokes> seen = found_.surfaces;
    for (const RoundPatch& p : hollows_) {
      const auto is = [&](auto like) { return std::any_of(seen.begin(), seen.end(), like); };
      if (is([&](const SurfaceStrokes& s) { return alike(s.surface, p.surface); })) continue;
      const bool concentric = is([&](const SurfaceStrokes& s) {
        return s.surface.kind == SurfaceKind::kSphere &&
               (s.surface.origin - p.surface.origin).norm() <= 2 * tolerance_;
      });
      if (concentric || !any_contours_) add(p, false, concentric ? bonus() : -kBallPrice);
    }
  }
  // A place along a line that is known anyway, among all along the part.
  double bonus() const { return std::log(std::max(1.0, extent_ / (4 * tolerance_))); }

  bool alike(const Surface& a, const Surface& b) const {
    return a.kind == b.kind && (a.origin - b.origin).norm() <= 4 * tolerance_ &&
           std::abs(a.radius - b.radius) <= 4 * tolerance_ &&
           std::abs(a.minor_radius - b.minor_radius) <= 4 * tolerance_;
  }

  // The member of a family on which contours agree.
  struct Proposal {
    Contours::Fit fit;
    RoundPatch patch;
    bool around_tube;
    std::function<void(double)> then;
  };
  void propose(const RoundFamily& family, double from, double to,
               std::function<void(double)> then = {}, bool around_tube = false) {
    const std::optional<Contours::Fit> fit = contours_.fit(family, from, to, kSteps, least_);
    if (fit) proposals_.push_back({*fit, *family(fit->parameter), around_tube, std::move(then)});
  }

  // Those that explain the most first; the others as far as enough is left for them.
  void take() {
    std::stable_sort(proposals_.begin(), proposals_.end(), [](const auto& a, const auto& b) {
      return a.fit.lines.size() > b.fit.lines.size();
    });
    for (const Proposal& p : proposals_) {
      const std::vector<int> lines = contours_.touching(p.patch);
      if (int(lines.size()) < least_ || 2 * lines.size() < p.fit.lines.size()) continue;
      add(p.patch, p.around_tube);
      contours_.remove(lines);
      if (p.then) p.then(p.fit.parameter);
    }
  }

  void add_smooth_ends(const Bend& bend, double radius) {
    const double tangent = bend.tangent(radius);
    add_smooth(bend.corner + bend.length_a * bend.to_a, -bend.to_a, bend.length_a - tangent,
               bend.radius);
    add_smooth(bend.corner + bend.length_b * bend.to_b, -bend.to_b, bend.length_b - tangent,
               bend.radius);
  }

  // The other rim of a cylinder of this length, of which one is seen.
  void add_smooth(const Vector3d& rim, const Vector3d& axis, double length, double radius) {
    if (length <= 4 * tolerance_) return;
    found_.rims.push_back(
        {StrokeKind::kCircle, -1, -1, {rim + length * axis, radius * axis}, true});
    const auto between = [=](const Vector3d& p) {
      const double up = (p - rim).dot(axis);
      return up > 0 && up < length;
    };
    const Surface cylinder{SurfaceKind::kCylinder, rim, axis, radius};
    contours_.remove(
        contours_.touching({cylinder, rim + length / 2 * axis, length + 2 * radius, between}));
  }

  const std::vector<Matrix3Xd>& polylines_;
  double tolerance_, extent_;
  Contours contours_;  // that nothing explains yet
  bool any_contours_;
  int least_;
  std::vector<CircleRim> rims_;
  std::vector<std::vector<int>> strokes_;  // of each rim
  std::vector<Bend> bends_;
  std::vector<RoundPatch> hollows_;  // spheres through two rims
  std::vector<Proposal> proposals_;
  RoundCandidates found_;
};

}  // namespace

RoundCandidates round_candidates(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines,
                                 const std::vector<SurfaceStrokes>& known,
                                 const std::vector<ContourLine>& contours, double tolerance) {
  return Finder(sketch, polylines, contours, tolerance).find(known);
}

}  // namespace sketchsplat

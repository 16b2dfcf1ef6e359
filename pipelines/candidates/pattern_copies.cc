// SPDX-License-Identifier: MIT
#include "pipelines/candidates/pattern_copies.h"

#include <Eigen/Geometry>
#include <cmath>

#include "pipelines/candidates/circles.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kMostRepeats = 16;    // around an axis
constexpr int kMostOfOneSize = 12;  // whose parallelograms are asked for

bool are_alike(const Circle& a, const Circle& b, double tolerance) {
  return std::abs(a.radius - b.radius) < tolerance && std::abs(a.axis.dot(b.axis)) > kParallel &&
         std::abs((b.centre - a.centre).dot(a.axis)) < tolerance;
}

Candidate at(const Vector3d& centre, const Circle& like) {
  return candidate_of({centre, like.axis, like.radius});
}

// The turns about a middle that two alike circles ask for.
void repeat_around(const Vector3d& middle, const Circle& a, const Circle& b, double tolerance,
                   std::vector<Candidate>* out) {
  Vector3d u = a.centre - middle, v = b.centre - middle;
  u -= u.dot(a.axis) * a.axis, v -= v.dot(a.axis) * a.axis;
  if (std::abs(u.norm() - v.norm()) > tolerance || u.norm() < 2 * tolerance) return;
  const double turn = std::atan2(u.cross(v).dot(a.axis), u.dot(v));
  const double repeats = std::round(2 * M_PI / std::abs(turn));
  if (!(repeats >= 2 && repeats <= kMostRepeats)) return;
  const double whole = 2 * M_PI / repeats;
  if (std::abs(std::abs(turn) - whole) * u.norm() > tolerance) return;
  for (int k = 1; k < int(repeats); ++k)
    out->push_back(at(a.centre - u + Eigen::AngleAxisd(k * whole, a.axis) * u, a));
}

}  // namespace

std::vector<Candidate> mirror_copies(const Sketch& sketch, const std::vector<Levels>& levels) {
  std::vector<Candidate> out;
  for (const Levels& l : levels) {
    if (l.height.size() < 2) continue;
    const double middle = 0.5 * (l.height.front() + l.height.back());
    const Eigen::Affine3d by = mirror(l.normal, middle);
    for (int i = 0; i < sketch.size(); ++i)
      out.push_back(moved({sketch.strokes[i].kind, control_points(sketch, i)}, by));
  }
  return out;
}

std::vector<Candidate> circle_patterns(const Sketch& sketch, double tolerance) {
  const std::vector<Circle> circles = circles_of(sketch);
  std::vector<Candidate> out;
  for (size_t i = 0; i < circles.size(); ++i) {
    std::vector<size_t> alike;
    for (size_t k = 0; k < circles.size() && alike.size() < kMostOfOneSize; ++k)
      if (k != i && are_alike(circles[i], circles[k], tolerance)) alike.push_back(k);
    const Circle& a = circles[i];
    for (size_t m = 0; m < alike.size(); ++m) {
      const Circle& b = circles[alike[m]];
      out.push_back(at(2 * b.centre - a.centre, a));
      for (size_t n = m + 1; n < alike.size(); ++n)
        out.push_back(at(b.centre + circles[alike[n]].centre - a.centre, a));
      if (alike[m] < i) continue;
      for (const Circle& c : circles)
        if (std::abs(c.axis.dot(a.axis)) > kParallel)
          repeat_around(c.centre, a, b, tolerance, &out);
    }
  }
  return out;
}

}  // namespace sketchsplat

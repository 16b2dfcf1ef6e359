// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipelines/candidates/generators.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kMostRepeats = 16;      // around an axis
constexpr int kMostOfOneSize = 12;    // whose parallelograms are asked for
constexpr int kFewest = 3;            // of a pattern that are there
constexpr size_t kMostAgreed = 1000;  // those that most views agree on; a texture tells nothing
constexpr double kLeastApart = 2;     // radii between neighbours along the way around

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

namespace {

// Circles of one size at one distance from an axis in one level.
struct Orbit {
  Vector3d middle, axis, u, v;      // of the level; u, v: unit, across the axis
  double radius = 0, distance = 0;  // of a circle; of centres from the middle
  std::vector<double> angle;        // of those that are there
};

Orbit orbit_of(const Circle& seed, const Circle& axis, const std::vector<Circle>& all,
               double tolerance) {
  Orbit out;
  out.axis = axis.axis;
  out.middle = axis.centre + axis.axis.dot(seed.centre - axis.centre) * axis.axis;
  const Vector3d arm = seed.centre - out.middle;
  out.u = arm.normalized(), out.v = axis.axis.cross(out.u);
  for (const Circle& c : all) {
    const Vector3d other = c.centre - out.middle;
    if (std::abs(c.axis.dot(axis.axis)) < kParallel ||
        std::abs(c.radius - seed.radius) > tolerance ||
        std::abs(other.dot(axis.axis)) > tolerance ||
        std::abs(other.norm() - arm.norm()) > tolerance)
      continue;
    out.angle.push_back(std::atan2(other.dot(out.v), other.dot(out.u)));
    out.radius += c.radius, out.distance += other.norm();
  }
  const double n = double(std::max<size_t>(1, out.angle.size()));
  out.radius /= n, out.distance /= n;
  return out;
}

bool goes_around(const Circle& axis, const Circle& seed, double tolerance) {
  return std::abs(seed.axis.dot(axis.axis)) > kParallel &&
         axis.axis.cross(seed.centre - axis.centre).norm() > 2 * tolerance;
}

struct Pattern {
  Orbit orbit;
  int number = 0, there = 0;  // of circles
  double phase = 0;           // [rad] of the first
  int surplus() const { return 2 * there - number; }
};

// With the number of circles of which most are there and the fewest are missing.
Pattern pattern_of(const Orbit& orbit, double tolerance) {
  Pattern best;
  for (int n = kFewest; n <= kMostRepeats; ++n) {
    const double turn = 2 * M_PI / n;
    if (orbit.distance * turn < kLeastApart * orbit.radius) break;
    std::vector<char> there(n, 0);
    double sum = 0;
    int count = 0;
    for (const double a : orbit.angle) {
      const double k = std::round(a / turn), off = a - k * turn;
      if (std::abs(off) * orbit.distance > tolerance) continue;
      there[(int(k) + n) % n] = 1;
      sum += off, ++count;
    }
    const Pattern p{orbit, n, int(std::count(there.begin(), there.end(), 1)), sum / count};
    if (p.there >= kFewest && p.surplus() >= 0 &&
        (best.number == 0 || p.surplus() > best.surplus()))
      best = p;
  }
  return best;
}

std::vector<Candidate> whole(const Pattern& p) {
  std::vector<Candidate> out;
  for (int k = 0; k < p.number; ++k) {
    const double a = p.phase + 2 * M_PI * k / p.number;
    const Vector3d arm = std::cos(a) * p.orbit.u + std::sin(a) * p.orbit.v;
    out.push_back(
        candidate_of({p.orbit.middle + p.orbit.distance * arm, p.orbit.axis, p.orbit.radius}));
  }
  return out;
}

std::vector<LevelRing> most_agreed(std::vector<LevelRing> rings) {
  std::stable_sort(rings.begin(), rings.end(),
                   [](const LevelRing& a, const LevelRing& b) { return a.views > b.views; });
  if (rings.size() > kMostAgreed) rings.resize(kMostAgreed);
  return rings;
}

// As seen from anywhere or from one side.
Windows windows_of(const std::vector<Candidate>& pattern, const Vector3d& normal,
                   const EdgeWorld& world, const ContrastJudge& judge) {
  double sum[3] = {0, 0, 0};
  const Vector3d point = pattern[0].curve.p[0];
  const Window sides[] = {Window::one_side(normal, point), Window::one_side(-normal, point)};
  for (const Candidate& c : pattern) {
    const CurvePoints points = candidate_points(c, world.footprint);
    const ContrastEvidence e = judge.judge(points);
    sum[0] += e.nats;
    for (int k = 0; k < 2; ++k)
      sum[k + 1] += judge.nats_through(e, sides[k], points.position.col(0));
  }
  const int best = int(std::max_element(sum, sum + 3) - sum);
  if (best == 0) return nullptr;
  return std::make_shared<const std::vector<Window>>(1, sides[best - 1]);
}

}  // namespace

std::vector<Candidate> ring_patterns(const Sketch& sketch, const std::vector<LevelRing>& rings,
                                     double tolerance, const EdgeWorld& world,
                                     const ContrastJudge& judge, int first_group, int* tried) {
  const std::vector<Circle> known = circles_of(sketch);
  std::vector<Circle> all;
  for (const LevelRing& r : most_agreed(rings))
    all.push_back({r.ring.curve.p[0], r.ring.curve.p[1].normalized(), r.ring.curve.p[1].norm()});
  const size_t seeds = all.size();
  all.insert(all.end(), known.begin(), known.end());
  std::vector<Pattern> patterns;
  for (const Circle& axis : distinct_axes(known, tolerance))
    for (size_t seed = 0; seed < seeds; ++seed) {
      if (!goes_around(axis, all[seed], tolerance)) continue;
      const Pattern p = pattern_of(orbit_of(all[seed], axis, all, tolerance), tolerance);
      if (p.number > 0) patterns.push_back(p);
    }
  std::stable_sort(patterns.begin(), patterns.end(),
                   [](const Pattern& a, const Pattern& b) { return a.surplus() > b.surplus(); });
  std::vector<Candidate> out;
  for (const Pattern& p : patterns) {
    std::vector<Candidate> more = whole(p);
    const auto is_there = [&](const Candidate& c) {
      return std::any_of(out.begin(), out.end(), [&](const Candidate& other) {
        return (other.curve.p[0] - c.curve.p[0]).norm() < tolerance;
      });
    };
    if (std::any_of(more.begin(), more.end(), is_there)) continue;
    const auto windows = windows_of(more, p.orbit.axis, world, judge);
    for (Candidate& c : more) c.windows = windows, c.group = first_group;
    ++first_group, ++*tried;
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

}  // namespace sketchsplat

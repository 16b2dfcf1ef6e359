// SPDX-License-Identifier: MIT
#include "pipelines/candidates/ring_patterns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipelines/candidates/circles.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kFewest = 3;           // of a pattern that are there
constexpr size_t kMostRings = 1000;  // those that most views agree on; a texture tells nothing
constexpr int kMostRepeats = 16;     // around an axis
constexpr double kLeastApart = 2;    // radii between neighbours along the way around

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
  if (rings.size() > kMostRings) rings.resize(kMostRings);
  return rings;
}

// As seen from anywhere or from one side.
std::shared_ptr<const std::vector<Window>> windows_of(const std::vector<Candidate>& pattern,
                                                      const Vector3d& normal,
                                                      const EdgeWorld& world,
                                                      const ContrastJudge& judge) {
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

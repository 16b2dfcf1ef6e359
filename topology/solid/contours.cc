// SPDX-License-Identifier: MIT
#include "topology/solid/contours.h"

#include <algorithm>
#include <cmath>

#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kFine = 8;     // steps of the second search, around what the first one finds
constexpr int kPlaces = 33;  // on a line within the ball around a part

// Where a line comes nearest to a surface, or leaves it the least while it is inside.
struct Extreme {
  double off = 0;        // signed distance from the surface
  bool nearest = false;  // else: least deep
};

// Of a ball: where the perpendicular from its centre meets the line.
std::optional<Extreme> extreme_of_ball(const RoundPatch& patch, const ContourLine& line) {
  const Vector3d& centre = patch.surface.origin;
  const Vector3d foot = line.from + (centre - line.from).dot(line.direction) * line.direction;
  if (!patch.holds(foot)) return std::nullopt;
  return Extreme{(foot - centre).norm() - patch.surface.radius, true};
}

// The one that is nearest to touching, of those at the part.
std::optional<Extreme> extreme_of(const RoundPatch& patch, const ContourLine& line) {
  if (patch.surface.kind == SurfaceKind::kSphere) return extreme_of_ball(patch, line);
  const double foot = (patch.middle - line.from).dot(line.direction);
  const double aside2 = (line.from + foot * line.direction - patch.middle).squaredNorm();
  const double half2 = patch.reach * patch.reach - aside2;
  if (!(half2 > 0)) return std::nullopt;
  const double begin = foot - std::sqrt(half2), step = 2 * std::sqrt(half2) / (kPlaces - 1);
  const auto at = [&](double i) -> Vector3d {
    return line.from + (begin + i * step) * line.direction;
  };
  std::optional<Extreme> best;
  double a = surface_distance(patch.surface, at(0)), b = surface_distance(patch.surface, at(1));
  for (int i = 1; i + 1 < kPlaces; ++i) {
    const double c = surface_distance(patch.surface, at(i + 1));
    const double bend = a - 2 * b + c;
    if ((b - a) * (c - b) <= 0 && bend != 0) {  // a parabola through three places
      const double shift = (a - c) / (2 * bend), off = b - (c - a) * (c - a) / (8 * bend);
      if ((!best || std::abs(off) < std::abs(best->off)) && patch.holds(at(i + shift)))
        best = Extreme{off, bend > 0};
    }
    a = b;
    b = c;
  }
  return best;
}

// Parameters that a line is content with.
struct Interval {
  double low, high;
  int line;
};

// The place that the most intervals hold.
double most_held(const std::vector<Interval>& intervals) {
  std::vector<std::pair<double, int>> ends;
  for (const Interval& i : intervals) {
    ends.emplace_back(i.low, -1);  // begins come first where they meet an end
    ends.emplace_back(i.high, 1);
  }
  std::sort(ends.begin(), ends.end());
  int held = 0, most = 0;
  double from = 0, to = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    held -= ends[i].second;
    if (held <= most) continue;
    most = held;
    from = ends[i].first;
    to = i + 1 < ends.size() ? ends[i + 1].first : from;
  }
  return (from + to) / 2;
}

}  // namespace

std::vector<int> Contours::touching(const RoundPatch& patch) const {
  std::vector<int> out;
  for (int i = 0; i < size(); ++i) {
    const std::optional<Extreme> e = extreme_of(patch, lines_[i]);
    if (e && std::abs(e->off) <= tolerance_) out.push_back(i);
  }
  return out;
}

void Contours::remove(const std::vector<int>& lines) {
  for (size_t k = lines.size(); k-- > 0;) lines_.erase(lines_.begin() + lines[k]);
}

std::optional<Contours::Fit> Contours::fit(const RoundFamily& family, double low, double high,
                                           int steps, int least) const {
  if (size() < least) return std::nullopt;
  if (low == high) return touched(family, low, least);
  std::vector<Interval> intervals;
  std::vector<std::optional<Extreme>> last(lines_.size()), here = last;
  for (int k = 0; k <= steps; ++k) {
    const double step = (high - low) / steps, x = low + k * step;
    const std::optional<RoundPatch> patch = family(x);
    for (int i = 0; i < size(); ++i) {
      here[i] = patch ? extreme_of(*patch, lines_[i]) : std::nullopt;
      if (!here[i] || !last[i] || here[i]->nearest != last[i]->nearest) continue;
      const double from = last[i]->off, to = here[i]->off;
      if ((from < 0) == (to < 0)) continue;
      const double at = x - step * to / (to - from),
                   half = std::abs(step * tolerance_ / (to - from));
      intervals.push_back({at - half, at + half, i});
    }
    std::swap(last, here);
  }
  if (int(intervals.size()) < least) return std::nullopt;
  const double rough = most_held(intervals);
  std::vector<double> middles;
  for (const Interval& i : intervals)
    if (i.low <= rough && rough <= i.high) middles.push_back((i.low + i.high) / 2);
  if (middles.empty()) return std::nullopt;
  std::nth_element(middles.begin(), middles.begin() + long(middles.size() / 2), middles.end());
  const double best = middles[middles.size() / 2], step = (high - low) / steps;
  if (steps <= kFine) return touched(family, best, least);
  return fit(family, best - step, best + step, kFine, least);  // where off is linear in between
}

std::optional<Contours::Fit> Contours::touched(const RoundFamily& family, double parameter,
                                               int least) const {
  const std::optional<RoundPatch> patch = family(parameter);
  if (!patch) return std::nullopt;
  Fit out{parameter, touching(*patch)};
  std::vector<Vector3d> cameras;
  for (const int i : out.lines)
    if (std::find(cameras.begin(), cameras.end(), lines_[i].from) == cameras.end())
      cameras.push_back(lines_[i].from);
  if (int(out.lines.size()) < least || cameras.size() < 3) return std::nullopt;
  return out;
}

}  // namespace sketchsplat

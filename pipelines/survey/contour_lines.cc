// SPDX-License-Identifier: MIT
#include "pipelines/survey/contour_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// [px] of the line from the curve: lines of sight that touch the surface meet outside of it.
constexpr double kTouchPx = 4;
constexpr double kLonger = 0.5;     // of its length, that a line may end before the curve
constexpr double kFromEndPx = 4;    // [px] of the touch from the ends of the curve
constexpr double kAlong = 0.7;      // cosine of line and curve that run alongside
constexpr double kNearPx = 2;       // [px] of the contour from the line, where it is seen as one
constexpr double kGrazes = 0.2;     // sine of an angle at which a view sees the contour, too
constexpr double kSeen = 0.5;       // of its samples, of a line that a view sees
constexpr double kAccident = 0.05;  // of the views that see something else there
// [nat] beforehand, assumed: of ten such lines one is an edge, since edges end where others do, and
// not before a curve that goes on smoothly.
const double kPrior = std::log(10);

// Of the surface that holds the line and the curve at its foot.
struct Surface {
  Vector3d normal;  // unit, outwards
  double radius;    // across the line, world units
};

std::optional<Surface> surface_at(const Vector3d& way, const Vector3d& tangent,
                                  const Vector3d& curvature) {
  const Vector3d t = tangent - tangent.dot(way) * way;
  Vector3d k = curvature - curvature.dot(way) * way;
  if (t.norm() < std::sqrt(1 - kAlong * kAlong)) return std::nullopt;
  k -= k.dot(t) / t.squaredNorm() * t;
  const double bent = k.norm() / t.squaredNorm();
  if (!(bent > 0)) return std::nullopt;
  return Surface{-k.normalized(), 1 / bent};
}

// Where a curve is touched by the line, if it goes on to either side.
std::optional<Surface> touched(const Vector3d& begin, const Vector3d& end, int curve,
                               const Sketch& sketch, const Observation& o, double px) {
  const double length = (end - begin).norm();
  const Vector3d way = (end - begin) / length;
  const int first = o.layout.first[curve], last = o.layout.first[curve + 1] - 1;
  int best = -1;
  double least = kTouchPx * px;
  for (int i = first; i <= last; ++i) {
    const Vector3d d = o.samples.position.col(i) - begin;
    const double along = d.dot(way), off = (d - along * way).norm();
    const double longer = kLonger * length + kTouchPx * px;
    if (off < least && along > -longer && along < length + longer) least = off, best = i;
  }
  if (best < 0) return std::nullopt;
  const auto from = [&](int end_sample) {
    return (o.samples.position.col(best) - o.samples.position.col(end_sample)).norm();
  };
  if (!is_closed(sketch.strokes[curve].kind) && std::min(from(first), from(last)) < kFromEndPx * px)
    return std::nullopt;
  return surface_at(way, o.samples.tangent.col(best),
                    curvature_at(sketch, curve, o.layout.t[best]));
}

std::vector<char> views_that_see(int line, const Observation& o, size_t views) {
  std::vector<int> samples(views, 0);
  const int first = o.layout.first[line], last = o.layout.first[line + 1];
  for (int i = first; i < last; ++i)
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m)
      ++samples[o.matches.matches[m].view];
  std::vector<char> out;
  for (const int n : samples) out.push_back(n >= kSeen * (last - first));
  return out;
}

// Logarithm of the probability of so many hits and misses, if all rates are as likely.
double any_rate(int hits, int misses) {
  return std::lgamma(hits + 1) + std::lgamma(misses + 1) - std::lgamma(hits + misses + 2);
}

double nats_of(const Surface& s, const Vector3d& middle, const Vector3d& way,
               const std::vector<char>& sees, const EdgeWorld& world) {
  int far[2] = {0, 0};  // views that do not and that do see the line
  for (size_t v = 0; v < world.views.size(); ++v) {
    const Vector3d camera = world.views[v].center_in_world();
    Vector3d d = camera - middle;
    d = (d - d.dot(way) * way).normalized();
    const double sine = s.normal.dot(d);
    const double off = s.radius * (1 - std::sqrt(std::max(0.0, 1 - sine * sine)));
    // Views that graze see a contour there in any case, be there an edge or not.
    if (off < kNearPx * world.footprint || std::abs(sine) < kGrazes) continue;
    if (sees[v] || (sine > 0 && world.hull.surely_visible(middle, camera))) ++far[int(sees[v])];
  }
  return kPrior + far[1] * std::log(kAccident) + far[0] * std::log(1 - kAccident) -
         any_rate(far[1], far[0]);
}

}  // namespace

double contour_nats(int line, const Sketch& sketch, const std::vector<bool>& keep,
                    const Observation& o, const EdgeWorld& world) {
  const Stroke& stroke = sketch.strokes[line];
  if (stroke.kind != StrokeKind::kLine) return -INFINITY;
  const Vector3d begin = sketch.nodes.col(stroke.begin), end = sketch.nodes.col(stroke.end);
  const std::vector<char> sees = views_that_see(line, o, world.views.size());
  double most = -INFINITY;
  for (int c = 0; c < sketch.size(); ++c) {
    if (!keep[c] || sketch.strokes[c].kind == StrokeKind::kLine) continue;
    const auto surface = touched(begin, end, c, sketch, o, world.footprint);
    if (!surface) continue;
    most = std::max(
        most, nats_of(*surface, 0.5 * (begin + end), (end - begin).normalized(), sees, world));
  }
  return most;
}

}  // namespace sketchsplat

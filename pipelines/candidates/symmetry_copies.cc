// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "pipelines/candidates/generators.h"
#include "topology/core/plain_curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kMostTurns = 12;   // around an axis
constexpr size_t kMostAxes = 8;  // of the largest circles
constexpr int kMostMirrors = 3;
constexpr int kPlaces = 12;          // of a stroke at which motions are tried
constexpr double kOffMiddle = 0.15;  // of the size of the sketch, of an axis from its middle
constexpr double kRepeats = 0.33;    // of what is moved that must lie on strokes again
constexpr double kThere = 0.33;      // of the images of a stroke that must be known
constexpr double kWhole = 0.98;      // of a circle that images of an arc of it cover
constexpr int kFewestMoved = 3;      // strokes that lie on others then
constexpr double kAnyTurn = 1.0;     // [rad], no part of a turn: what it leaves is round

Eigen::Affine3d turn_about(const Circle& axis, double angle) {
  return Eigen::Translation3d(axis.centre) * Eigen::AngleAxisd(angle, axis.axis) *
         Eigen::Translation3d(-axis.centre);
}

CurvePoints moved_by(CurvePoints points, const Eigen::Affine3d& by) {
  points.position = by * points.position;
  return points;
}

// Of the largest circles.
std::vector<Circle> main_axes(const Sketch& sketch, double tolerance) {
  std::vector<Circle> all = circles_of(sketch);
  std::stable_sort(all.begin(), all.end(),
                   [](const Circle& a, const Circle& b) { return a.radius > b.radius; });
  std::vector<Circle> out = distinct_axes(all, tolerance);
  if (out.size() > kMostAxes) out.resize(kMostAxes);
  return out;
}

// Strokes with a few points of each.
struct Places {
  std::vector<Candidate> stroke;
  std::vector<CurvePoints> at;
  std::vector<double> length;
  Vector3d middle = Vector3d::Zero();
  double size = 0;
};

Places places_of(const Sketch& sketch, double px) {
  Places out;
  Eigen::AlignedBox3d box;
  double all = 0;
  for (int s = 0; s < sketch.size(); ++s) {
    const Candidate c = candidate_of(sketch, s);
    CurvePoints p = candidate_points(c, px);
    const double length = px * double(p.position.cols());
    p = candidate_points(c, std::max(px, length / kPlaces));
    out.middle += length * p.position.rowwise().mean();
    all += length;
    for (Eigen::Index i = 0; i < p.position.cols(); ++i) box.extend(Vector3d(p.position.col(i)));
    out.stroke.push_back(c), out.at.push_back(p), out.length.push_back(length);
  }
  if (all > 0) out.middle /= all, out.size = box.diagonal().norm();
  return out;
}

// Whether enough of these strokes, which a motion moves, lies on strokes again.
bool repeats(const Eigen::Affine3d& by, const std::vector<int>& moved, const Places& places,
             const KnownCurves& known) {
  double all = 0, again = 0;
  int strokes = 0;
  for (const int s : moved) {
    all += places.length[s];
    if (known.share(moved_by(places.at[s], by)) > kWholeShare) again += places.length[s], ++strokes;
  }
  return strokes >= kFewestMoved && again >= kRepeats * all;
}

// The turns about the axis of a circle in the middle, most of one turn.
std::vector<Eigen::Affine3d> turns_of(const Sketch& sketch, const Places& places,
                                      const KnownCurves& known, double tolerance) {
  for (const Circle& axis : main_axes(sketch, tolerance)) {
    if (axis.axis.cross(places.middle - axis.centre).norm() > kOffMiddle * places.size) continue;
    std::vector<int> moved;
    for (size_t s = 0; s < places.at.size(); ++s)
      if (known.share(moved_by(places.at[s], turn_about(axis, kAnyTurn))) <= kWholeShare)
        moved.push_back(int(s));
    for (int n = kMostTurns; n >= 2; --n) {
      if (!repeats(turn_about(axis, 2 * M_PI / n), moved, places, known)) continue;
      std::vector<Eigen::Affine3d> out;
      for (int k = 0; k < n; ++k) out.push_back(turn_about(axis, 2 * M_PI * k / n));
      return out;
    }
  }
  return {Eigen::Affine3d::Identity()};
}

// All motions that leave the sketch as it is, as far as it tells: turns, mirrors half-way between
// the outermost levels, and both.
std::vector<Eigen::Affine3d> symmetries_of(const Sketch& sketch, const std::vector<Levels>& levels,
                                           const Places& places, const KnownCurves& known,
                                           double tolerance) {
  std::vector<Eigen::Affine3d> out = turns_of(sketch, places, known, tolerance);
  int mirrors = 0;
  for (const Levels& l : levels) {
    if (l.height.size() < 2 || mirrors == kMostMirrors) continue;
    const double middle = 0.5 * (l.height.front() + l.height.back());
    const Eigen::Affine3d by = mirror(l.normal, middle);
    std::vector<int> moved;  // those that do not cross the plane
    for (size_t s = 0; s < places.at.size(); ++s) {
      const Eigen::VectorXd h =
          (l.normal.transpose() * places.at[s].position).array().transpose() - middle;
      if (h.minCoeff() > tolerance || h.maxCoeff() < -tolerance) moved.push_back(int(s));
    }
    if (!repeats(by, moved, places, known)) continue;
    ++mirrors;
    const size_t n = out.size();
    for (size_t k = 0; k < n; ++k) out.push_back(by * out[k]);
  }
  return out;
}

bool same_curve(const Candidate& a, const Candidate& b, double tolerance) {
  const auto close = [&](const Vector3d& x, const Vector3d& y) {
    return (x - y).norm() < tolerance;
  };
  const auto &p = a.curve.p, &q = b.curve.p;
  const int n = a.curve.count;
  if (a.kind == StrokeKind::kCircle)
    return close(p[0], q[0]) && (close(p[1], q[1]) || close(p[1], -q[1]));
  const auto all = [&](bool turned) {
    for (int k = 0; k < n; ++k)
      if (!close(p[k], q[turned ? n - 1 - k : k])) return false;
    return true;
  };
  return all(false) || (!is_closed(a.kind) && all(true));
}

// All that motions make of a curve, each once.
std::vector<Candidate> images_of(const Candidate& curve,
                                 const std::vector<Eigen::Affine3d>& motions, double tolerance) {
  std::vector<Candidate> out;
  for (const Eigen::Affine3d& by : motions) {
    const Candidate c = moved(curve, by);
    const auto is_this = [&](const Candidate& o) { return same_curve(o, c, 2 * tolerance); };
    if (std::none_of(out.begin(), out.end(), is_this)) out.push_back(c);
  }
  return out;
}

KnownCurves curves_of(const std::vector<Candidate>& candidates, double px) {
  Sketch all;
  for (const Candidate& c : candidates) append(c, &all);
  return KnownCurves(all, px, kKnownPx * px);
}

// The circle of an arc, if it is no larger than the sketch.
std::optional<Candidate> circle_of(const Candidate& arc, double size) {
  if (arc.kind != StrokeKind::kArc || plane_normal(arc.kind, arc.curve).isZero())
    return std::nullopt;
  PlainCurve curve;
  curve.kind = arc.kind;
  curve.p = arc.curve.p;
  const PlainCurve circle = circle_of_arc(curve);
  const double radius = circle.p[1].norm();
  if (!(radius > 0 && radius < size)) return std::nullopt;
  return candidate_of({circle.p[0], circle.p[1] / radius, radius});
}

// All images of a stroke, or of the circle that images of an arc cover.
std::vector<Candidate> whole_images(const Candidate& stroke,
                                    const std::vector<Eigen::Affine3d>& motions, double size,
                                    double tolerance, double px) {
  std::vector<Candidate> images = images_of(stroke, motions, tolerance);
  if (const std::optional<Candidate> circle = circle_of(stroke, size))
    if (curves_of(images, px).share(candidate_points(*circle, px)) > kWhole)
      return images_of(*circle, motions, tolerance);
  return images;
}

// Is enough of them known to believe in the others, and is any not?
bool ask_for_more(const std::vector<Candidate>& images, const KnownCurves& known, double px) {
  int there = 0, whole = 0;
  for (const Candidate& c : images) {
    const double share = known.share(candidate_points(c, px));
    there += share > kKnownShare, whole += share > kWholeShare;
  }
  return there >= kThere * double(images.size()) && whole < int(images.size());
}

}  // namespace

std::vector<Candidate> symmetry_copies(const Sketch& sketch, const std::vector<Levels>& levels,
                                       const KnownCurves& known, double tolerance, double px,
                                       int first_group, int* tried) {
  const Places places = places_of(sketch, px);
  const std::vector<Eigen::Affine3d> motions =
      symmetries_of(sketch, levels, places, known, tolerance);
  if (motions.size() < 2) return {};
  std::vector<int> by_length(places.length.size());
  std::iota(by_length.begin(), by_length.end(), 0);
  std::stable_sort(by_length.begin(), by_length.end(),
                   [&](int a, int b) { return places.length[a] > places.length[b]; });
  std::vector<Candidate> out;
  std::vector<char> done(places.stroke.size(), 0);
  for (const int s : by_length) {
    if (done[s]) continue;
    std::vector<Candidate> images =
        whole_images(places.stroke[s], motions, places.size, tolerance, px);
    const KnownCurves covered = curves_of(images, px);
    for (size_t o = 0; o < places.at.size(); ++o)
      done[o] = done[o] || covered.share(places.at[o]) > kWholeShare;
    if (!ask_for_more(images, known, px)) continue;
    for (Candidate& c : images) c.group = first_group;
    out.insert(out.end(), images.begin(), images.end());
    ++first_group, ++*tried;
  }
  return out;
}

}  // namespace sketchsplat

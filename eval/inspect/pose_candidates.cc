// SPDX-License-Identifier: MIT
#include "eval/inspect/pose_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "datasets/types/dense.h"
#include "eval/inspect/edge_samples.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
constexpr double kSameAxis = 3 * kDegree;   // directions that are one
constexpr double kSameTurn = 2 * kDegree;   // rotations that are one
constexpr double kSameAngle = 4 * kDegree;  // between directions, in both sketches
constexpr double kLeastAngle = 15 * kDegree;
constexpr int kMostAxes = 7, kMostPairs = 3, kSpins = 24, kVoted = 3;
constexpr double kBin = 0.03;    // [extents] of votes for a place
constexpr double kAlike = 0.88;  // ratio of sizes of strokes that may be one

// A stroke for those who look for it elsewhere.
struct Feature {
  Vector3d place, axis;  // middle or centre; unit direction or normal, zero if none
  double size = 0;       // length or radius
  double length = 0;
  bool round = false;
};

struct Shape {
  std::vector<Feature> features;
  std::vector<std::pair<Vector3d, double>> axes;  // undirected, with their length, longest first
  Eigen::Matrix3Xd points;
  Vector3d centroid = Vector3d::Zero();
  double spread = 0;   // rms distance from the centroid
  Matrix3d principal;  // columns: axes of inertia
};

Feature feature_of(const Sketch& sketch, int s) {
  const ControlPoints c = control_points(sketch, s);
  Feature f;
  f.length = f.size = stroke_length(sketch, s);
  f.axis = Vector3d::Zero();
  Vector3d d;
  evaluate_stroke(sketch, s, 0.5, &f.place, &d);
  const StrokeKind kind = sketch.strokes[s].kind;
  if (kind == StrokeKind::kLine) {
    f.axis = (c.p[1] - c.p[0]).stableNormalized();
  } else if (kind == StrokeKind::kArc || kind == StrokeKind::kCircle) {
    const CircleParameters k = circle_parameters(sketch, s);
    if (k.straight) return f;
    f.axis = k.normal, f.place = k.centre, f.size = k.radius, f.round = true;
  } else if (kind == StrokeKind::kEllipse) {
    f.axis = c.p[1].cross(c.p[2]).stableNormalized();
    f.place = c.p[0], f.size = std::sqrt(c.p[1].norm() * c.p[2].norm()), f.round = true;
  }
  return f;
}

void add_axis(const Feature& f, std::vector<std::pair<Vector3d, double>>* axes) {
  if (f.axis.isZero()) return;
  for (auto& [axis, length] : *axes) {
    const double side = axis.dot(f.axis);
    if (std::abs(side) < std::cos(kSameAxis)) continue;
    axis = (length * axis + (side < 0 ? -f.length : f.length) * f.axis).normalized();
    length += f.length;
    return;
  }
  axes->push_back({f.axis, f.length});
}

Shape shape_of(const Sketch& sketch) {
  Shape out;
  for (int s = 0; s < sketch.size(); ++s) {
    out.features.push_back(feature_of(sketch, s));
    add_axis(out.features.back(), &out.axes);
  }
  std::stable_sort(out.axes.begin(), out.axes.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  if (out.axes.size() > kMostAxes) out.axes.resize(kMostAxes);
  const EdgeSamples samples = sample_edges(sketch, largest_extent(sketch) / 40, 4);
  out.points = samples.position;
  double total = 0;
  for (int i = 0; i < samples.size(); ++i) {
    out.centroid += samples.length[i] * samples.position.col(i);
    total += samples.length[i];
  }
  out.centroid /= total;
  Matrix3d moments = Matrix3d::Zero();
  for (int i = 0; i < samples.size(); ++i) {
    const Vector3d d = samples.position.col(i) - out.centroid;
    moments += samples.length[i] / total * d * d.transpose();
  }
  out.spread = std::sqrt(moments.trace());
  out.principal = eigen_symmetric(moments).vectors;
  return out;
}

class Rotations {
 public:
  void add(const Matrix3d& rotation) {
    for (const Matrix3d& r : list)
      if ((r.transpose() * rotation).trace() > 1 + 2 * std::cos(kSameTurn)) return;
    list.push_back(rotation);
  }

  std::vector<Matrix3d> list;
};

Matrix3d frame(const Vector3d& x, const Vector3d& near_y) {
  Matrix3d f;
  f.col(0) = x;
  f.col(2) = x.cross(near_y).normalized();
  f.col(1) = f.col(2).cross(x);
  return f;
}

// Takes a1 to b1, and a2 as near to b2 as that allows.
Matrix3d turn(const Vector3d& a1, const Vector3d& a2, const Vector3d& b1, const Vector3d& b2) {
  return frame(b1, b2) * frame(a1, a2).transpose();
}

// Undirected angle in [0, pi / 2].
double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b))));
}

void add_by_axes(const Shape& from, const Shape& to, Rotations* rotations) {
  int pairs = 0;
  for (size_t i = 0; i < to.axes.size() && pairs < kMostPairs; ++i)
    for (size_t k = i + 1; k < to.axes.size() && pairs < kMostPairs; ++k) {
      const Vector3d &b1 = to.axes[i].first, &b2 = to.axes[k].first;
      const double angle = angle_between(b1, b2);
      if (angle < kLeastAngle) continue;
      ++pairs;
      for (const auto& [a1, l1] : from.axes)
        for (const auto& [a2, l2] : from.axes) {
          const double own = angle_between(a1, a2);
          if (own < kLeastAngle || std::abs(own - angle) > kSameAngle) continue;
          for (const double side1 : {1.0, -1.0})
            for (const double side2 : {1.0, -1.0})
              if (std::abs(side1 * side2 * a1.dot(a2) - b1.dot(b2)) < 2 * kSameAngle)
                rotations->add(turn(side1 * a1, side2 * a2, b1, b2));
        }
    }
  if (pairs > 0 || to.axes.empty()) return;
  // One axis alone: a turned part. Any spin may be right.
  const Vector3d b = to.axes[0].first, b_side = b.unitOrthogonal();
  for (const auto& [a, length] : from.axes)
    for (const double side : {1.0, -1.0}) {
      const Matrix3d first = turn(side * a, a.unitOrthogonal(), b, b_side);
      for (int k = 0; k < kSpins; ++k)
        rotations->add(rotation_about(2 * M_PI * k / kSpins * b) * first);
    }
}

void add_by_inertia(const Shape& from, const Shape& to, Rotations* rotations) {
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const auto& order : kOrders)
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d turned;
      for (int k = 0; k < 3; ++k)
        turned.col(k) = (signs >> k & 1 ? -1 : 1) * from.principal.col(order[k]);
      const Matrix3d rotation = to.principal * turned.transpose();
      if (rotation.determinant() > 0) rotations->add(rotation);
    }
}

// Where most pairs of like strokes fall together.
std::vector<Vector3d> voted_places(const Shape& from, const Shape& to, const Matrix3d& rotation,
                                   double scale, double bin) {
  std::map<std::array<int, 3>, std::pair<double, Vector3d>> votes;
  for (const Feature& a : from.features)
    for (const Feature& b : to.features) {
      const double ratio = scale * a.size / b.size;
      if (a.round != b.round || ratio < kAlike || ratio > 1 / kAlike) continue;
      if (std::abs((rotation * a.axis).dot(b.axis)) < std::cos(2 * kSameAngle)) continue;
      const Vector3d shift = b.place - scale * (rotation * a.place);
      const Eigen::Array3i cell = (shift / bin).array().round().cast<int>();
      auto& [weight, sum] =
          votes.try_emplace({cell.x(), cell.y(), cell.z()}, 0, Vector3d::Zero()).first->second;
      weight += b.length;
      sum += b.length * shift;
    }
  std::vector<std::pair<double, Vector3d>> sorted;
  for (const auto& [cell, vote] : votes) sorted.push_back({vote.first, vote.second / vote.first});
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vector3d> out;
  for (size_t i = 0; i < sorted.size() && i < kVoted; ++i) out.push_back(sorted[i].second);
  return out;
}

Vector3d box_centre(const Eigen::Matrix3Xd& p) {
  return (p.rowwise().minCoeff() + p.rowwise().maxCoeff()) / 2;
}

}  // namespace

std::vector<Similarity> pose_candidates(const Sketch& from, const Sketch& to, bool fit_scale) {
  const Shape a = shape_of(from), b = shape_of(to);
  Rotations rotations;
  rotations.add(Matrix3d::Identity());
  add_by_axes(a, b, &rotations);
  add_by_inertia(a, b, &rotations);
  std::vector<double> scales = {1};
  if (fit_scale) scales = {b.spread / a.spread, largest_extent(to) / largest_extent(from)};
  const double bin = kBin * largest_extent(to);
  std::vector<Similarity> out;
  if (!fit_scale) out.push_back({});
  for (const double scale : scales)
    for (const Matrix3d& r : rotations.list) {
      out.push_back({scale, r, b.centroid - scale * (r * a.centroid)});
      out.push_back({scale, r, box_centre(b.points) - box_centre(scale * (r * a.points))});
      for (const Vector3d& shift : voted_places(a, b, r, scale, bin))
        out.push_back({scale, r, shift});
    }
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "sketches/curve/curve.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A curve by its own control points (order: StrokeKind), outside of any sketch.
struct PlainCurve {
  StrokeKind kind = StrokeKind::kLine;
  std::array<Eigen::Vector3d, 4> p;  ///< unused ones are zero

  PlainCurve() { p.fill(Eigen::Vector3d::Zero()); }
  bool closed() const { return is_closed(kind); }
  int size() const { return num_handles(kind) + (closed() ? 0 : 2); }
  const Eigen::Vector3d& begin() const { return p[0]; }         ///< of an open curve
  const Eigen::Vector3d& end() const { return p[size() - 1]; }  ///< of an open curve
};

PlainCurve plain_curve(const Sketch& sketch, int stroke);

/// Finite control points and some extent: what a sketch may hold.
bool is_sound(const PlainCurve& curve);

/// Points along a curve, uniform in t, both ends included.
struct CurveSamples {
  Eigen::Matrix3Xd position;  ///< 3 x n
  Eigen::Matrix3Xd tangent;   ///< 3 x n, unit; zero where the curve stands still
  Eigen::VectorXd weight;     ///< n  arc length that the sample stands for (trapezoid rule)
  double length = 0;          ///< sum of the weights
  Eigen::Vector3d low, high;  ///< box around the samples
};
constexpr int kPieces = 32;
CurveSamples sample_curve(const PlainCurve& curve, int pieces = kPieces);

struct Closest {
  double t = 0;
  double distance = 0;
  Eigen::Vector3d position, tangent;  ///< tangent is a unit vector, or zero
};
/// Nearest point of a curve; `samples` are of the same curve. Exact for line, arc and circle,
/// else Gauss-Newton from the nearest sample.
Closest closest_point(const PlainCurve& curve, const CurveSamples& samples,
                      const Eigen::Vector3d& point);

/// Largest distance of `points` (3 x n) from the curve; 0 if there are none.
double max_distance(const PlainCurve& curve, const Eigen::Matrix3Xd& points);

/// Unit tangent at the begin or the end of an open curve, pointing out of it; zero if undefined.
Eigen::Vector3d outward_tangent(const PlainCurve& curve, bool at_end);

/// The open curve with its ends moved and no kink: a cubic is displaced by a linear function of t,
/// an
/// arc keeps passing through its own old middle part, an elliptic arc keeps its ellipse as far as
/// the ends allow, a line is a line.
PlainCurve move_ends(const PlainCurve& curve, const Eigen::Vector3d& begin,
                     const Eigen::Vector3d& end);

/// The open curve run through the other way.
PlainCurve backwards(const PlainCurve& curve);

/// The full circle that an arc lies on. The arc must not be straight.
PlainCurve circle_of_arc(const PlainCurve& arc);

}  // namespace sketchsplat

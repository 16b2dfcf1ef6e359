// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A curve as its owner evaluates it: point and derivative at a parameter in [first, last].
struct ParametricCurve {
  double first = 0, last = 1;
  std::function<void(double, Eigen::Vector3d*, Eigen::Vector3d*)> evaluate;
  Eigen::Vector3d point(double t) const {
    Eigen::Vector3d p, d;
    evaluate(t, &p, &d);
    return p;
  }
};

/// What a curve is, whatever it is stored as: exporters write lines, circles and ellipses as
/// B-splines too. Circle, ellipse or an arc of one: p = centre + cos(a) u + sin(a) v, u no shorter
/// than v and at right angles to it, where a grows along the curve by `turn` in all. A circle's u
/// points to where the curve begins.
struct CurveShape {
  enum Kind { kLine, kCircular, kElliptic, kOther } kind = kOther;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d u = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();
  double turn = 0;  ///< [rad], > 0
};
/// `tolerance`: largest distance from the ideal curve that still counts, same unit as the curve.
/// Elliptic only if it turns by half a radian or more: shorter curves of any kind lie on ellipses.
CurveShape recognise(const ParametricCurve& curve, double tolerance);

/// Parameters first = t0 < t1 < ... < last between which the cubic Hermite interpolant stays within
/// `tolerance` of the curve. `breaks`: inner parameters where its derivative may jump, ascending.
std::vector<double> hermite_knots(const ParametricCurve& curve, const std::vector<double>& breaks,
                                  double tolerance);

/// Bezier handles of the cubic Hermite interpolant on [a, b]; its derivatives are taken just
/// inside, so that a jump at either end does no harm.
void hermite_handles(const ParametricCurve& curve, double a, double b, Eigen::Vector3d* h0,
                     Eigen::Vector3d* h1);

/// Points such that chords stay within `deflection` of the curve and are no longer than `spacing`;
/// both ends included: 3 x N, N >= 2.
Eigen::Matrix3Xd polyline(const ParametricCurve& curve, const std::vector<double>& breaks,
                          double deflection, double spacing, std::vector<double>* parameters);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sketches/sketch.h"

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

/// What a curve is, whatever it is stored as: exporters write lines and circles as B-splines too.
/// For a circle or an arc of one, `centre` and `axis` (unit normal times radius) are set, and
/// `turn` is the angle that the curve covers, signed about the axis.
struct CurveShape {
  enum Kind { kLine, kCircular, kOther } kind = kOther;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double turn = 0;  ///< [rad]
};
/// `tolerance`: largest distance from the ideal curve that still counts, same unit as the curve.
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

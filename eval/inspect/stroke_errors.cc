// SPDX-License-Identifier: MIT
#include "eval/inspect/stroke_errors.h"

#include "datasets/types/dense.h"
#include "sketches/curve/curve_jacobian.h"

namespace sketchsplat {

StrokeErrors::StrokeErrors(const Sketch& measured, const SigmaModel& sigma, int stroke)
    : measured_(measured), sigma_(sigma), stroke_(stroke) {
  const auto es = eigen_symmetric(calibrated_covariance(measured, stroke, sigma));
  root_ = es.vectors * es.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

Eigen::Matrix<double, 3, kErrorsOfStroke> StrokeErrors::at(double t) const {
  const StrokeKind kind = measured_.strokes[stroke_].kind;
  Eigen::Matrix<double, 3, kErrorsOfStroke> out = Eigen::Matrix<double, 3, kErrorsOfStroke>::Zero();
  out.leftCols(root_.cols()) =
      curve_jacobian(kind, control_points(measured_, stroke_), t).leftCols(root_.rows()) * root_;
  out.middleCols<3>(kErrorsOfEdgels) =
      sigma_.place(measured_.strokes[stroke_], measured_.evidence[stroke_]) *
      Eigen::Matrix3d::Identity();
  out.rightCols<2>() = sigma_.radial_errors(measured_, stroke_, t);
  return out;
}

}  // namespace sketchsplat

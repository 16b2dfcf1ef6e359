// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "eval/inspect/sigma_model.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Independent errors of a stroke: 12 control coordinates; a shift (3), and two ways of being too
/// small, which edgels do not know.
constexpr int kErrorsOfStroke = 17, kErrorsOfEdgels = 12;

/// One standard deviation of each independent error of a stroke, calibrated.
class StrokeErrors {
 public:
  /// Keeps references to both.
  StrokeErrors(const Sketch& measured, const SigmaModel& sigma, int stroke);

  /// How each of them moves the place at t in [0, 1]: columns.
  Eigen::Matrix<double, 3, kErrorsOfStroke> at(double t) const;

 private:
  const Sketch& measured_;
  const SigmaModel& sigma_;
  int stroke_;
  Eigen::MatrixXd root_;
};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "sketches/curve/curve_jacobian.h"

#include <ceres/jet.h>

#include "sketches/curve/curve.h"

namespace sketchsplat {

Eigen::Matrix<double, 3, 12> curve_jacobian(StrokeKind kind, const ControlPoints& c, double t) {
  using Jet12 = ceres::Jet<double, 12>;  // three coordinates of up to four control points
  Vec3<Jet12> control[4], position, derivative;
  for (int i = 0; i < c.count; ++i)
    for (int k = 0; k < 3; ++k) control[i][k] = Jet12(c.p[i][k], 3 * i + k);
  evaluate_curve<Jet12>(kind, control, t, &position, &derivative);
  Eigen::Matrix<double, 3, 12> j;
  for (int k = 0; k < 3; ++k) j.row(k) = position[k].v.transpose();
  return j;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/cameras/halves.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace sketchsplat {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Confirmed confirm(const Halves& halves, const MatrixXd& information) {
  Confirmed out;
  for (const int half : {0, 1}) {
    const MatrixXd held = halves.hessian[1 - half] + information;
    const VectorXd move = -held.ldlt().solve(halves.gradient[1 - half]);
    const double fits = -move.dot(halves.gradient[half]);
    const double spread = move.dot(halves.hessian[half] * move);
    if (!(spread > 0)) continue;
    out.sigmas += fits / std::sqrt(2 * spread);
    out.told += fits;
  }
  return out;
}

double alike(const Halves& halves, const MatrixXd& information) {
  const MatrixXd both = halves.hessian[0] + halves.hessian[1] + information;
  const Eigen::LDLT<MatrixXd> inverse(both);
  const double variance =
      (inverse.solve(halves.hessian[0]) * inverse.solve(halves.hessian[1])).trace();
  return variance > 0
             ? halves.gradient[0].dot(inverse.solve(halves.gradient[1])) / std::sqrt(variance)
             : 0;
}

}  // namespace sketchsplat

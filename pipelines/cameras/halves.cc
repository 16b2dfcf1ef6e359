// SPDX-License-Identifier: MIT
#include "pipelines/cameras/halves.h"

#include <cmath>

#include "datasets/types/dense.h"

namespace sketchsplat {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Confirmed confirm(const Halves& halves, const MatrixXd& information) {
  Confirmed out;
  for (const int half : {0, 1}) {
    const MatrixXd held = halves.hessian[1 - half] + information;
    const VectorXd move = -solve_symmetric(held, halves.gradient[1 - half]);
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
  const double variance =
      (solve_symmetric(both, halves.hessian[0]) * solve_symmetric(both, halves.hessian[1])).trace();
  return variance > 0 ? halves.gradient[0].dot(solve_symmetric(both, halves.gradient[1])) /
                            std::sqrt(variance)
                      : 0;
}

}  // namespace sketchsplat

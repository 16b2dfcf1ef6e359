// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>

namespace sketchsplat {

/// Normal equations of the same N unknowns by two halves of the data, without any prior, in
/// standard deviations of the data.
struct Halves {
  std::array<Eigen::MatrixXd, 2> hessian;   ///< N x N, positive semidefinite
  std::array<Eigen::VectorXd, 2> gradient;  ///< N; its covariance is the hessian if all are right
};

/// Whether the moves that one half tells fit the other half, too.
struct Confirmed {
  /// If the unknowns are right, normal of mean 0; of variance 1 to 2, as the halves' answers, of
  /// variance 1/2 each, hang together.
  double sigmas = 0;
  double told = 0;    ///< the sum of squares that is explained
};
/// `information`: N x N, of a prior about the unknowns as they are.
Confirmed confirm(const Halves& halves, const Eigen::MatrixXd& information);

/// How much more alike the gradients of the halves are than by chance, in standard deviations: of
/// independent ones, a.M.b has variance tr(M A M B), for any M; this one is that of all data. 0
/// where nothing is known.
double alike(const Halves& halves, const Eigen::MatrixXd& information);

}  // namespace sketchsplat

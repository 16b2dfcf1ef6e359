// SPDX-License-Identifier: MIT
#include <Eigen/Eigenvalues>

#include "datasets/types/dense.h"

namespace sketchsplat {

using Eigen::MatrixXd;

namespace {

template <int N>
void decompose(int n, const double* a, double* values, double* vectors) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Map<const Square> matrix(a, n, n);
  const int wanted = vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly;
  Eigen::SelfAdjointEigenSolver<Square> solver(n);
  if constexpr (N == 2)
    solver.computeDirect(matrix, wanted);
  else
    solver.compute(matrix, wanted);
  Eigen::Map<Eigen::Matrix<double, N, 1>>(values, n) = solver.eigenvalues();
  if (vectors) Eigen::Map<Square>(vectors, n, n) = solver.eigenvectors();
}

}  // namespace

void dense::eigen_symmetric(int n, const double* a, double* values, double* vectors) {
  if (n == 0) return;
  if (n == 2) return decompose<2>(n, a, values, vectors);
  if (n == 3) return decompose<3>(n, a, values, vectors);
  decompose<Eigen::Dynamic>(n, a, values, vectors);
}

GeneralEigen eigen_general(const Eigen::Ref<const MatrixXd>& a) {
  const Eigen::EigenSolver<MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd polynomial_roots(const Eigen::VectorXd& c) {
  MatrixXd companion = MatrixXd::Zero(c.size(), c.size());
  companion.row(0) = -c.transpose();
  companion.diagonal(-1).setOnes();
  return Eigen::EigenSolver<MatrixXd>(companion, false).eigenvalues();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "datasets/types/dense.h"

namespace sketchsplat {

using Eigen::MatrixXd;

namespace {

template <int N>
void solve_by_ldlt(int n, const double* a, int columns, double* b) {
  using Square = Eigen::Matrix<double, N, N>;
  using Column = Eigen::Matrix<double, N, 1>;
  const Eigen::LDLT<Square> ldlt(Eigen::Map<const Square>(a, n, n));
  for (int k = 0; k < columns; ++k) {
    Eigen::Map<Column> x(b + k * n, n);
    x = ldlt.solve(Column(x));
  }
}

}  // namespace

void dense::solve_symmetric(int n, const double* a, int columns, double* b) {
  if (n == 0) return;
  if (n == 2) return solve_by_ldlt<2>(n, a, columns, b);
  if (n == 3) return solve_by_ldlt<3>(n, a, columns, b);
  Eigen::Map<MatrixXd> x(b, n, columns);
  x = Eigen::LDLT<MatrixXd>(Eigen::Map<const MatrixXd>(a, n, n)).solve(MatrixXd(x));
}

Cholesky::Cholesky(const Eigen::Ref<const MatrixXd>& a) {
  const Eigen::LLT<MatrixXd> llt(a);
  lower_ = llt.matrixLLT();
  ok_ = llt.info() == Eigen::Success;
}

double Cholesky::log_determinant() const { return 2 * lower_.diagonal().array().log().sum(); }

MatrixXd Cholesky::whitened(const Eigen::Ref<const MatrixXd>& b) const {
  return lower_.triangularView<Eigen::Lower>().solve(b);
}

MatrixXd Cholesky::solve(const Eigen::Ref<const MatrixXd>& b) const {
  return lower_.transpose().triangularView<Eigen::Upper>().solve(whitened(b));
}

MatrixXd least_squares(const Eigen::Ref<const MatrixXd>& a, const Eigen::Ref<const MatrixXd>& b) {
  return a.colPivHouseholderQr().solve(b);
}

}  // namespace sketchsplat

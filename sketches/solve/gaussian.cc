// SPDX-License-Identifier: MIT
#include "sketches/solve/gaussian.h"

#include <algorithm>

#include "datasets/types/dense.h"

namespace sketchsplat {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Gaussian::Gaussian(const Eigen::SparseMatrix<double>& information)
    : factor_(information), taken_(information.rows(), 0), first_(int(information.rows())) {}

void Gaussian::add_variable(double variance) {
  added_.push_back(variance);
  const int rows = int(taken_.rows());
  if (size() > rows) {
    taken_.conservativeResize(2 * rows, Eigen::NoChange);
    taken_.bottomRows(rows).setZero();
  }
}

MatrixXd Gaussian::first_spread(const Rows& rows) const {
  const MatrixXd dense = rows.transpose();
  MatrixXd out(size(), rows.rows());
  out.topRows(first_) = factor_.solve(dense.topRows(first_));
  for (size_t i = 0; i < added_.size(); ++i)
    out.row(first_ + i) = added_[i] * dense.row(first_ + i);
  return out;
}

MatrixXd Gaussian::gathered(const Rows& rows) const {
  MatrixXd out = MatrixXd::Zero(rows.rows(), count_);
  for (int r = 0; r < rows.rows() && count_ > 0; ++r)
    for (Rows::InnerIterator it(rows, r); it; ++it)
      out.row(r) += it.value() * taken_.row(it.col()).head(count_);
  return out;
}

MatrixXd Gaussian::covariance(const Rows& rows) const {
  const MatrixXd w = gathered(rows);
  return rows * first_spread(rows) - w * w.transpose();
}

VectorXd Gaussian::observe(const Rows& rows, const VectorXd& residual, double sigma) {
  const MatrixXd w = gathered(rows);
  MatrixXd spread = first_spread(rows);
  spread.noalias() -= taken_.topLeftCorner(size(), count_) * w.transpose();
  MatrixXd s = rows * spread;
  s.diagonal().array() += sigma * sigma;
  const Cholesky root(s);
  if (!root.ok()) return VectorXd::Zero(size());
  const int k = int(rows.rows());
  if (count_ + k > taken_.cols())
    taken_.conservativeResize(Eigen::NoChange, std::max<int>(count_ + k, 2 * int(taken_.cols())));
  taken_.middleCols(count_, k).setZero();
  taken_.block(0, count_, size(), k) = root.whitened(spread.transpose()).transpose();
  count_ += k;
  return -spread * root.solve(residual);
}

}  // namespace sketchsplat

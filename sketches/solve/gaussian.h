// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

namespace sketchsplat {

/// A normal distribution in n variables, given by its sparse information matrix, as linear
/// observations come in one after the other (Kalman's update). The covariance is never formed: what
/// each observation took away from it is kept as a column.
class Gaussian {
 public:
  /// `information`: n x n, symmetric, positive definite.
  explicit Gaussian(const Eigen::SparseMatrix<double>& information);

  bool ok() const { return factor_.info() == Eigen::Success; }
  int size() const { return first_ + int(added_.size()); }

  int taken() const { return count_; }  ///< observations so far

  /// information^-1 b, of the distribution at first; b: n.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return factor_.solve(b); }

  /// A further variable that depends on no other so far.
  void add_variable(double variance);

  /// rows P rows^T, P the covariance by now; k x k. `rows`: k x n.
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Eigen::MatrixXd covariance(const Rows& rows) const;

  /// Takes in that rows x + residual = 0, with a standard deviation. Returns how the mean moves.
  Eigen::VectorXd observe(const Rows& rows, const Eigen::VectorXd& residual, double sigma);

 private:
  Eigen::MatrixXd first_spread(const Rows& rows) const;  // P rows^T at first: n x k
  Eigen::MatrixXd gathered(const Rows& rows) const;      // rows taken_: k x count

  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> taken_;
  int first_ = 0;              // variables at first
  int count_ = 0;              // columns of taken_ in use
  std::vector<double> added_;  // variances of further variables
};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace sketchsplat {

// Decompositions of small dense matrices by Eigen, compiled here once: in place each of them costs
// the compiler two to ten seconds a file. Sizes of 2 and 3 are compiled as such, for inner loops.

/// Eigenvalues, ascending, and orthonormal eigenvectors, as columns, of a symmetric N x N matrix.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// Eigenvalues and eigenvectors, in no order, of an n x n matrix. Vectors have length 1.
struct GeneralEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// U diag(values) V^T = an m x n matrix. Values, n of them, descend; U is m x n, V n x n. With m <
/// n the last values are 0, and the columns of U that go with them.
struct Svd {
  Eigen::VectorXd values;
  Eigen::MatrixXd u, v;
};

namespace dense {  // n x n matrices by columns; `vectors` may be null
void eigen_symmetric(int n, const double* a, double* values, double* vectors);
void solve_symmetric(int n, const double* a, int columns, double* b_and_x);
}  // namespace dense

/// Of a symmetric matrix, of which the lower triangle is read, by implicit QR steps (of a 2 x 2
/// matrix in closed form).
template <typename A>
SymmetricEigen<A::ColsAtCompileTime> eigen_symmetric(const Eigen::MatrixBase<A>& a) {
  constexpr int N = A::ColsAtCompileTime;
  const Eigen::Matrix<double, N, N> own = a;
  SymmetricEigen<N> out;
  out.values.resize(own.cols()), out.vectors.resize(own.cols(), own.cols());
  dense::eigen_symmetric(int(own.cols()), own.data(), out.values.data(), out.vectors.data());
  return out;
}
/// The same without the vectors.
template <typename A>
Eigen::Matrix<double, A::ColsAtCompileTime, 1> eigenvalues_symmetric(
    const Eigen::MatrixBase<A>& a) {
  constexpr int N = A::ColsAtCompileTime;
  const Eigen::Matrix<double, N, N> own = a;
  Eigen::Matrix<double, N, 1> values(own.cols());
  dense::eigen_symmetric(int(own.cols()), own.data(), values.data(), nullptr);
  return values;
}

/// x of a x = b for a symmetric n x n matrix `a`, of which the lower triangle is read, and any
/// number of columns b, by LDL^T with pivots. Components along pivots that are exactly 0 become 0.
template <typename A, typename B>
Eigen::Matrix<double, A::ColsAtCompileTime, B::ColsAtCompileTime> solve_symmetric(
    const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  constexpr int N = A::ColsAtCompileTime;
  const Eigen::Matrix<double, N, N> own = a;
  Eigen::Matrix<double, N, B::ColsAtCompileTime> x = b;
  dense::solve_symmetric(int(own.cols()), own.data(), int(x.cols()), x.data());
  return x;
}

/// L of a positive definite matrix L L^T, lower triangular.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::Ref<const Eigen::MatrixXd>& a);
  /// False if the matrix is not positive definite: nothing else means anything then.
  bool ok() const { return ok_; }
  double log_determinant() const;                                              ///< of L L^T
  Eigen::MatrixXd whitened(const Eigen::Ref<const Eigen::MatrixXd>& b) const;  ///< L^-1 b
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& b) const;     ///< L^-T L^-1 b

 private:
  Eigen::MatrixXd lower_;
  bool ok_;
};

/// x of least |a x - b|, of each column of b, by QR with pivots; a has full rank, or x is one of
/// many.
Eigen::MatrixXd least_squares(const Eigen::Ref<const Eigen::MatrixXd>& a,
                              const Eigen::Ref<const Eigen::MatrixXd>& b);

GeneralEigen eigen_general(const Eigen::Ref<const Eigen::MatrixXd>& a);

/// All roots of x^n + c[0] x^(n-1) + ... + c[n-1].
Eigen::VectorXcd polynomial_roots(const Eigen::VectorXd& c);

/// By one-sided Jacobi rotations: small values have small relative errors.
Svd svd(const Eigen::Ref<const Eigen::MatrixXd>& a);

/// The rotation R of least |R - m|. Reference: S. Umeyama, PAMI 13(4), 1991.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m);

/// 4 x 4 matrix of the similarity that takes points nearest to others, column by column (the same).
Eigen::Matrix4d similarity_between(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

}  // namespace sketchsplat

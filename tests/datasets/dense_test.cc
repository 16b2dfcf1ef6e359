// SPDX-License-Identifier: MIT
#include "datasets/types/dense.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd symmetric(int n) {
  const MatrixXd a = MatrixXd::Random(n, n);
  return a + a.transpose();
}

template <typename A>
void expect_decomposed(const A& a) {
  const auto e = eigen_symmetric(a);
  EXPECT_TRUE((e.vectors.transpose() * e.vectors).isIdentity(1e-12));
  EXPECT_NEAR((a - e.vectors * e.values.asDiagonal() * e.vectors.transpose()).norm(), 0, 1e-12);
  EXPECT_TRUE(std::is_sorted(e.values.data(), e.values.data() + e.values.size()));
  EXPECT_NEAR((eigenvalues_symmetric(a) - e.values).norm(), 0, 1e-12);
  const MatrixXd b = MatrixXd::Random(a.rows(), 2);
  EXPECT_NEAR((a * solve_symmetric(a, b) - b).norm(), 0, 1e-9);
}

TEST(Dense, DecomposesAndSolvesSymmetricMatricesOfAnySize) {
  std::srand(1);
  for (const int n : {0, 1, 2, 3, 7, 20}) expect_decomposed(symmetric(n));
  expect_decomposed(Eigen::Matrix2d(symmetric(2)));
  expect_decomposed(Eigen::Matrix3d(symmetric(3)));
  expect_decomposed(Eigen::Matrix<double, 7, 7>(symmetric(7)));
}

TEST(Dense, CholeskyIsOfPositiveMatricesOnly) {
  std::srand(1);
  const MatrixXd l = MatrixXd::Random(5, 5), a = l * l.transpose(), b = MatrixXd::Random(5, 2);
  const Cholesky root(a);
  ASSERT_TRUE(root.ok());
  EXPECT_NEAR((a * root.solve(b) - b).norm(), 0, 1e-9);
  EXPECT_NEAR(root.whitened(b).squaredNorm(), (b.transpose() * root.solve(b)).trace(), 1e-9);
  EXPECT_NEAR(root.log_determinant(), std::log(l.determinant() * l.determinant()), 1e-9);
  EXPECT_FALSE(Cholesky(-a).ok());
}

// Few rows, more than columns, and rows of which none is new.
TEST(Dense, SingularValuesDescendAndTheRestIsZero) {
  std::srand(1);
  for (const int m : {1, 2, 3, 4, 40})
    for (const int rank : {1, 2, 3}) {
      const MatrixXd a = MatrixXd::Random(m, rank) * MatrixXd::Random(rank, 3);
      const Svd s = svd(a);
      EXPECT_TRUE((s.v.transpose() * s.v).isIdentity(1e-12));
      EXPECT_NEAR((a - s.u * s.values.asDiagonal() * s.v.transpose()).norm(), 0, 1e-12);
      EXPECT_TRUE(std::is_sorted(s.values.data(), s.values.data() + 3, std::greater<double>()));
      EXPECT_NEAR(s.values.tail(3 - std::min(m, rank)).norm(), 0, 1e-12);
      if (m >= 3) EXPECT_TRUE((s.u.transpose() * s.u).isIdentity(1e-12));
    }
}

TEST(Dense, LeastSquaresLeaveWhatIsSquareToTheColumns) {
  std::srand(1);
  const MatrixXd a = MatrixXd::Random(9, 4), b = MatrixXd::Random(9, 2);
  EXPECT_NEAR((a.transpose() * (a * least_squares(a, b) - b)).norm(), 0, 1e-12);
}

TEST(Dense, RootsOfAPolynomialAreThoseItWasMadeOf) {
  const Eigen::VectorXcd roots = polynomial_roots(Eigen::Vector3d(-4, 1, 6));  // -1, 2, 3
  VectorXd real = roots.real();
  std::sort(real.data(), real.data() + 3);
  EXPECT_NEAR((real - Eigen::Vector3d(-1, 2, 3)).norm() + roots.imag().norm(), 0, 1e-12);
  const Eigen::VectorXcd i = polynomial_roots(Eigen::Vector2d(0, 1));
  EXPECT_NEAR(std::abs(i[0] * i[0] + 1.0) + std::abs(i[0] + i[1]), 0, 1e-12);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const GeneralEigen e = eigen_general(turn);
  EXPECT_NEAR((turn * e.vectors - e.vectors * e.values.asDiagonal()).norm(), 0, 1e-12);
}

TEST(Dense, FindsTheRotationAndTheSimilarity) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix();
  EXPECT_NEAR((nearest_rotation(1.7 * turn) - turn).norm(), 0, 1e-12);
  EXPECT_NEAR(nearest_rotation(-turn).determinant(), 1, 1e-12);
  const Eigen::Matrix3Xd from = Eigen::Matrix3Xd::Random(3, 9);
  const Eigen::Matrix3Xd to = (2 * turn * from).colwise() + Eigen::Vector3d(1, 2, 3);
  const Eigen::Matrix4d t = similarity_between(from, to);
  EXPECT_NEAR((t * from.colwise().homogeneous() - to.colwise().homogeneous()).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace sketchsplat

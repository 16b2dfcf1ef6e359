// SPDX-License-Identifier: MIT
#include "sketches/fit/right_singular.h"

#include <gtest/gtest.h>

namespace sketchsplat {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// Few rows, more than columns, and rows of which none is new.
TEST(RightSingular, IsThatOfTheDecompositionOfTheWholeMatrix) {
  std::srand(1);
  for (int n : {1, 2, 3, 4, 40}) {
    for (int rank : {1, 2, 3}) {
      const Rows rows = Eigen::MatrixXd::Random(n, rank) * Eigen::MatrixXd::Random(rank, 3);
      const RightSingular<3> ours = right_singular<3>(rows);
      const Eigen::JacobiSVD<Eigen::MatrixXd> whole(rows, Eigen::ComputeFullV);
      EXPECT_TRUE((ours.vectors.transpose() * ours.vectors).isIdentity(1e-12));
      const int known = std::min(n, rank);
      EXPECT_NEAR(ours.values.tail(3 - known).norm(), 0, 1e-12);
      for (int k = 0; k < known; ++k) {
        EXPECT_NEAR(ours.values[k], whole.singularValues()[k], 1e-12);
        EXPECT_NEAR(std::abs(ours.vectors.col(k).dot(whole.matrixV().col(k))), 1, 1e-9)
            << n << " rows of rank " << rank;
      }
    }
  }
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace sketchsplat {

/// Singular values, largest first, and right singular vectors, as columns.
template <int Columns>
struct RightSingular {
  using Square = Eigen::Matrix<double, Columns, Columns>;
  Eigen::Matrix<double, Columns, 1> values;
  Square vectors;
};

/// Those of a matrix with few columns: of the R of its QR decomposition with pivots. Eigen's own
/// way to them (JacobiSVD of a matrix with more rows than columns) frees its preconditioner twice
/// where memory runs out in it. With fewer rows than columns the values that are missing are 0.
template <int Columns>
RightSingular<Columns> right_singular(const Eigen::Matrix<double, Eigen::Dynamic, Columns>& rows) {
  using Square = typename RightSingular<Columns>::Square;
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, Columns>> qr(rows);
  const Eigen::Index n = std::min<Eigen::Index>(rows.rows(), Columns);
  Square r = Square::Zero();
  r.topRows(n) = qr.matrixR().topRows(n);
  r = Square(r.template triangularView<Eigen::Upper>());
  const Eigen::JacobiSVD<Square> svd(r, Eigen::ComputeFullV);
  return {svd.singularValues(), qr.colsPermutation() * svd.matrixV()};
}

}  // namespace sketchsplat

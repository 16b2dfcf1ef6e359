// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

#include "datasets/types/dense.h"

namespace sketchsplat {

using Eigen::MatrixXd;

// Of the square R of a QR decomposition with pivots. JacobiSVD itself does so, too, but frees what
// it does it with twice where memory runs out.
Svd svd(const Eigen::Ref<const MatrixXd>& a) {
  const Eigen::Index m = a.rows(), n = a.cols(), rank = std::min(m, n);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(a);
  MatrixXd r = MatrixXd::Zero(n, n);
  r.topRows(rank) = qr.matrixR().topRows(rank).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<MatrixXd> jacobi(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  MatrixXd u = MatrixXd::Zero(m, n);
  u.topRows(rank) = jacobi.matrixU().topRows(rank);
  u.applyOnTheLeft(qr.householderQ());
  return {jacobi.singularValues(), u, qr.colsPermutation() * jacobi.matrixV()};
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

Eigen::Matrix4d similarity_between(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  return Eigen::umeyama(from, to);
}

}  // namespace sketchsplat

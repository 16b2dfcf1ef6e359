// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Unknowns of a stroke, 12 at the most: its control points.
constexpr int kStrokeUnknowns = 12;
using StrokeVector = Eigen::Matrix<double, kStrokeUnknowns, 1>;
using StrokeMatrix = Eigen::Matrix<double, kStrokeUnknowns, kStrokeUnknowns>;

/// What the normal equations of cameras and strokes hold of one stroke.
struct StrokeNormal {
  /// F with F^T F = A^+, the inverse of the stroke's own block in what its edgels tell (a line
  /// slides along itself).
  StrokeMatrix root;
  StrokeVector gradient;
  Eigen::MatrixXd cross;  ///< 12 x (unknowns of cameras)

  /// The stroke's step, if the cameras move.
  StrokeVector step(const Eigen::VectorXd& cameras) const {
    return -(root.transpose() * (root * (gradient + cross * cameras)));
  }
};

/// F of a block A, `damping` times its largest eigenvalue added to all that count. 0 if it is.
StrokeMatrix root_of_inverse(const StrokeMatrix& A, double damping);

/// Takes the strokes out of the cameras' normal equations: the Schur complement H - C^T A^+ C, and
/// the same of the gradient. The same sums for any number of threads.
void eliminate(const std::vector<StrokeNormal>& strokes, Eigen::MatrixXd* hessian,
               Eigen::VectorXd* gradient);

}  // namespace sketchsplat

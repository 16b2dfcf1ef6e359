// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Gaussians on edges, structure of arrays. A splat is a thin Gaussian, long along its tangent:
///   covariance = across^2 I + (along^2 - across^2) tangent tangent^T.
struct Splats {
  Eigen::Matrix3Xd mean;     ///< 3 x N, world units
  Eigen::Matrix3Xd tangent;  ///< 3 x N, unit (zero: the splat is round)
  Eigen::VectorXd along;     ///< N, standard deviation along the tangent, world units, > 0
  Eigen::VectorXd across;    ///< N, standard deviation across it, world units, > 0
  Eigen::VectorXd opacity;   ///< N, peak of the optical depth tau, >= 0
  int size() const { return int(mean.cols()); }
  static Splats zero(int n);
};

/// Gradient of a scalar by every field of the splats.
using SplatGradient = Splats;

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/types/view.h"
#include "raster/splats/splats.h"

namespace sketchsplat {

/// How splats are drawn. With d = pixel - mean, S the covariance in the image and q = d^T S^-1 d, a
/// splat has the optical depth peak * k(q); with Q = cutoff^2,
///   k(q) = (exp(-q/2) - exp(-Q/2) (1 + (Q - q)/2)) / (1 - exp(-Q/2) (1 + Q/2))   for q < Q, else
///   0:
/// the Gaussian lowered by its tangent at Q. Value and slope are zero at the rim, so that the loss
/// stays continuously differentiable when pixels enter or leave a splat; k(0) = 1.
struct RasterOptions {
  double lowpass_px = 0.3;   ///< [px] standard deviation added to every splat (pixel filter), > 0
  double cutoff = 3.5;       ///< [standard deviations] radius Q^(1/2) where a splat ends, in [2, 6]
  double near_sigmas = 4.0;  ///< culled if depth <= this * max(along, across): no affine view of it
  double margin = 0.15;      ///< culled if the mean is this share of the image size outside of it
};

/// A splat in an image.
struct Footprint {
  int splat = 0;         ///< index into the splats
  Eigen::Vector2d mean;  ///< [px]
  double u00, u01, u11;  ///< U = [u00 u01; 0 u11], q = |U d|^2, U^T U = S^-1; [1/px]
  double peak = 0;       ///< optical depth at the mean: opacity * visibility
  int x0, x1, y0, y1;    ///< box of the pixels with q < Q, inclusive, inside the image, not empty
};

/// Gradient of a scalar by a footprint.
struct FootprintGradient {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< by S, symmetric
  double peak = 0;
};

/// Footprints of the splats that reach the image, in the order of the splats (EWA splatting,
/// Zwicker et al. 2001: S = J R Sigma R^T J^T + lowpass^2 I, J the Jacobian at the mean).
/// `visibility`: N values in [0, 1] or empty (all 1). Splats that are invisible (visibility 0),
/// not finite, too near, behind the camera or outside the image are left out.
std::vector<Footprint> project_splats(const Splats& splats,
                                      const Eigen::Ref<const Eigen::VectorXf>& visibility,
                                      const View& view, const RasterOptions& options);

/// Pulls gradients by the footprints back to the splats and adds them to `gradient` (N splats). The
/// arguments are those of project_splats; splats without a footprint receive nothing.
void project_splats_backward(const Splats& splats,
                             const Eigen::Ref<const Eigen::VectorXf>& visibility, const View& view,
                             const std::vector<Footprint>& footprints,
                             const std::vector<FootprintGradient>& footprint_gradients,
                             SplatGradient* gradient);

}  // namespace sketchsplat

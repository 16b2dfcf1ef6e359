// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/types/image.h"
#include "datasets/types/view.h"
#include "raster/splats/loss.h"
#include "raster/splats/project.h"
#include "raster/splats/splats.h"

namespace sketchsplat {

/// Edges white on black: I(p) = 1 - exp(-sum_i tau_i(p)), the limit of alpha compositing with white
/// splats whose alpha is 1 - exp(-tau). The sum needs no depth order. `visibility`: N values in
/// [0, 1] that scale the optical depth of each splat in this view, or empty (all 1). Size of the
/// result: that of the camera. One thread; float inside, absolute error below 1e-5.
Image<float> render(const Splats& splats, const Eigen::Ref<const Eigen::VectorXf>& visibility,
                    const View& view, const RasterOptions& options);

/// Loss (loss.h) of the rendering against `target`, whose size must be that of the camera. If
/// `gradient` is there it becomes the gradient by all N splats (zero for those that are not drawn).
/// One thread; costs in proportion to the pixels of the splats, not to the image.
double render_loss(const Splats& splats, const Eigen::Ref<const Eigen::VectorXf>& visibility,
                   const View& view, const EdgeTarget& target, const RasterOptions& options,
                   SplatGradient* gradient);

/// render_loss of V views, in parallel. `visibility` is N x V or empty. Returns V losses;
/// `gradient`, if there, becomes the gradient of their sum. Same bytes for any number of threads.
Eigen::VectorXd render_loss_views(const Splats& splats, const Eigen::MatrixXf& visibility,
                                  const std::vector<View>& views,
                                  const std::vector<EdgeTarget>& targets,
                                  const RasterOptions& options, SplatGradient* gradient);

}  // namespace sketchsplat

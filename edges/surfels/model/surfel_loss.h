// SPDX-License-Identifier: MIT
#pragma once

#include "edges/surfels/model/training_view.h"
#include "raster/surfels/surfel.h"

namespace sketchsplat {

/// What a picture says of its rendering. Every term is a mean over the pixels of the view that are
/// looked at.
struct SurfelLossOptions {
  double ssim = 0.2;          ///< share of 1 - SSIM of the greys in the photometric term, [0, 1]
  double softness = 0.01;     ///< of |rendered - seen|, grey values, > 0
  double alpha = 0.5;         ///< weight of the squared error of alpha
  double consistency = 0.05;  ///< of 1 - cosine between the rendered normal and that of the depth
};

/// The loss of a rendered view and, in `by_images`, its derivatives by the images: color, alpha,
/// normal and depth. `mask`: pixels with 0 are not looked at.
///   (1 - s) mean |I - T| + s mean (1 - SSIM(I, T))          I: color, T: color times alpha
///   + alpha mean (A - T_a)^2                                  A: alpha
///   + consistency mean (1 - N . n(D / A))                     n: normal of the points of the depth
/// The last term leaves out pixels where A, there or at a neighbour, is not above 1/2.
double surfel_loss(const SurfelImages& images, const TrainingView& target,
                   const Image<std::uint8_t>& mask, const SurfelLossOptions& options,
                   SurfelImages* by_images);

}  // namespace sketchsplat

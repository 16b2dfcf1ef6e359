// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

namespace sketchsplat {

/// Derivatives of a Gaussian of `sigma` pixels, exact on a ramp [values per px]; the image goes on
/// as it ends.
void gaussian_gradient(const cv::Mat1f& value, double sigma, cv::Mat1f* x, cv::Mat1f* y);

/// Standard deviation of a component of that gradient where the image is white noise: its variance
/// is 1 / (8 pi sigma^4) of the noise's.
inline double noise_of_gradient(double noise, double sigma) {
  return noise / (std::sqrt(8 * M_PI) * sigma * sigma);
}

}  // namespace sketchsplat

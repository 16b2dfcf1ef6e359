// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core.hpp>

namespace sketchsplat {

/// Derivatives of a Gaussian of `sigma` pixels, exact on a ramp [values per px]; the image goes on
/// as it ends.
void gaussian_gradient(const cv::Mat1f& value, double sigma, cv::Mat1f* x, cv::Mat1f* y);

}  // namespace sketchsplat

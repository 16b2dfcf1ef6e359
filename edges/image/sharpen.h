// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core.hpp>

namespace sketchsplat {

/// What makes a picture sharper that is blurred and noisy: Wiener's filter (Extrapolation,
/// interpolation, and smoothing of stationary time series, 1949) for a picture of steps, whose
/// power falls with the third power of the frequency. As it is made it changes nothing.
struct Sharpening {
  double blur_px = 0;  ///< [px] standard deviation of the picture's blur, a Gaussian
  double left_px = 0;  ///< [px] that steps are blurred by afterwards, where noise lets them
  /// [px^3] power of the noise over that of steps, where the frequency is 1 / px
  double noise_of_steps = 0;
  /// Of a wave of `frequency` [1 / px], 1 at 0.
  double gain(double frequency) const;
  /// Standard deviation of white noise that makes gradients of scale `sigma_px` as strong as those
  /// that are left of white noise of 1.
  double noise_left(double sigma_px) const;
};

/// For a picture with steps (a range of 1) and white noise of this standard deviation, of which a
/// Gaussian gradient of scale `sigma_px` tells how much the steps are.
Sharpening sharpening_of(const cv::Mat1f& value, double blur_px, double noise, double sigma_px);

/// Filters a picture, which is mirrored beyond its frame.
void sharpen(const Sharpening& how, cv::Mat1f* value);

}  // namespace sketchsplat

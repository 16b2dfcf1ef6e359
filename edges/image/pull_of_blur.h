// SPDX-License-Identifier: MIT
#pragma once

namespace sketchsplat {

/// By how much the steepest place of a disc's edge lies nearer to its centre when it is blurred by
/// a Gaussian, both in px; `curvature`: 1 / radius [1 / px], not negative. To first order curvature
/// blur^2 / 2; within 0.02 blur of the exact place (the maximum of the gradient's magnitude, a
/// Bessel function I_1 times a Gaussian) up to a radius of 1.4 blur; 0 below, where little is left
/// of the disc.
inline double pull_of_blur(double curvature, double blur) {
  constexpr double kNothing = 0.75;  // blur over the radius at which nothing is left
  const double bend = curvature * blur, share = bend / kNothing;
  return share < 1 ? blur * bend / 2 * (1 - share * share * share * share) : 0;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "edges/image/sharpen.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/image/gradient.h"

namespace sketchsplat {
namespace {

// Of a Gaussian blur.
double transfer(double blur_px, double frequency) {
  const double a = M_PI * blur_px * frequency;
  return std::exp(-2 * a * a);
}

// Gains of a grid as cv::dft orders it.
cv::Mat1f gains(const Sharpening& how, cv::Size size) {
  const auto frequency = [](int k, int n) { return double(std::min(k, n - k)) / n; };
  cv::Mat1f out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      out(y, x) = float(how.gain(std::hypot(frequency(x, size.width), frequency(y, size.height))));
  return out;
}

}  // namespace

double Sharpening::gain(double frequency) const {
  const double blur = transfer(blur_px, frequency);
  const double noise = noise_of_steps * frequency * frequency * frequency;
  return transfer(left_px, frequency) * blur / std::max(blur * blur + noise, 1e-300);
}

double Sharpening::noise_left(double sigma_px) const {
  constexpr int kSteps = 200;
  double before = 0, after = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double f = 0.5 * (i + 0.5) / kSteps, g = transfer(sigma_px, f), w = g * gain(f);
    before += f * f * f * g * g, after += f * f * f * w * w;
  }
  return std::sqrt(after / before);
}

// Steps that blur and detector make a Gaussian's of s px wide, with a power of c / f^3 at a
// frequency f before, have a mean square gradient of the integral of (2 pi f)^2 c / f^3
// exp(-4 pi^2 s^2 f^2) over all frequencies, which is 2 pi^(5/2) c / s.
Sharpening sharpening_of(const cv::Mat1f& value, double blur_px, double noise, double sigma_px) {
  // Little is gained by more, and noise grows.
  constexpr double kLeft = 1.3, kShare = 0.6;        // [px]; of the blur
  const double least = 1 / (255 * std::sqrt(12.0));  // of values that are whole numbers
  const double white = std::max(noise, least), in_gradient = noise_of_gradient(white, sigma_px);
  cv::Mat1f x, y;
  gaussian_gradient(value, sigma_px, &x, &y);
  const double gradient = (x.dot(x) + y.dot(y)) / double(value.total());
  const double steps = std::max(gradient - 2 * in_gradient * in_gradient, 1e-12) *
                       std::hypot(blur_px, sigma_px) / (2 * std::pow(M_PI, 2.5));
  return {blur_px, std::max(kLeft, kShare * blur_px), white * white / steps};
}

void sharpen(const Sharpening& how, cv::Mat1f* value) {
  const int border = int(std::ceil(4 * how.blur_px));
  const int width = cv::getOptimalDFTSize(value->cols + 2 * border);
  const int height = cv::getOptimalDFTSize(value->rows + 2 * border);
  cv::Mat padded;
  cv::copyMakeBorder(*value, padded, border, height - value->rows - border, border,
                     width - value->cols - border, cv::BORDER_REFLECT);
  cv::Mat waves;
  cv::dft(padded, waves, cv::DFT_COMPLEX_OUTPUT);
  const cv::Mat1f gain = gains(how, waves.size());
  cv::Mat planes[] = {gain, gain}, both;
  cv::merge(planes, 2, both);
  cv::multiply(waves, both, waves);
  cv::dft(waves, padded, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  padded(cv::Rect(border, border, value->cols, value->rows)).copyTo(*value);
}

}  // namespace sketchsplat

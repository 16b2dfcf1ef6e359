// SPDX-License-Identifier: MIT
#include "edges/image/gradient.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace sketchsplat {

void gaussian_gradient(const cv::Mat1f& value, double sigma, cv::Mat1f* x, cv::Mat1f* y) {
  const int radius = std::max(2, int(std::ceil(3.5 * sigma)));
  cv::Mat1f smooth(1, 2 * radius + 1), slope(1, 2 * radius + 1);
  double sum = 0, moment = 0;
  for (int i = -radius; i <= radius; ++i) sum += std::exp(-0.5 * i * i / (sigma * sigma));
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-0.5 * i * i / (sigma * sigma)) / sum;
    smooth(0, i + radius) = float(g);
    slope(0, i + radius) = float(i * g);
    moment += i * i * g;
  }
  slope *= float(1.0 / moment);  // exact on a ramp
  cv::sepFilter2D(value, *x, CV_32F, slope, smooth, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
  cv::sepFilter2D(value, *y, CV_32F, smooth, slope, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "datasets/types/image.h"

namespace sketchsplat {

/// [px] From each pixel where `places` is not 0 to the nearest one where it is; 0 there.
inline cv::Mat1f distance_to_zero(const cv::Mat1b& places) {
  cv::Mat1f out;
  cv::distanceTransform(places, out, cv::DIST_L2, 3);
  return out;
}

/// A mask as OpenCV sees it, without a copy: to be read alone.
inline cv::Mat1b mat_of(const Image<uint8_t>& mask) {
  return cv::Mat1b(mask.height, mask.width, const_cast<uint8_t*>(mask.data.data()));
}

}  // namespace sketchsplat

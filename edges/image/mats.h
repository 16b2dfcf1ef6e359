// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "datasets/types/image.h"

namespace sketchsplat {

/// An image as OpenCV sees it, without a copy: to be read alone if the image is const.
template <typename T>
cv::Mat_<T> mat_of(const Image<T>& image) {
  return cv::Mat_<T>(image.height, image.width, const_cast<T*>(image.data.data()));
}

template <typename T>
Image<T> image_of(const cv::Mat_<T>& mat) {
  Image<T> out(mat.cols, mat.rows);
  mat.copyTo(mat_of(out));
  return out;
}

/// [px] From each pixel where `places` is not 0 to the nearest one where it is; 0 there.
inline cv::Mat1f distance_to_zero(const cv::Mat1b& places) {
  cv::Mat1f out;
  cv::distanceTransform(places, out, cv::DIST_L2, 3);
  return out;
}

}  // namespace sketchsplat

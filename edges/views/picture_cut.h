// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "datasets/types/view.h"
#include "edges/views/object_region.h"

namespace sketchsplat {

/// A view of a picture that is some times smaller.
struct ShrunkView {
  const View& view;
  int denominator;
  int width() const { return view.camera.shrunk(denominator).width; }
  int height() const { return view.camera.shrunk(denominator).height; }
  /// Pixel where a world point is drawn; false behind the camera, or where the lens draws nothing.
  bool pixel(const Eigen::Vector3d& point, Eigen::Vector2d* out, double* depth = nullptr) const;
};

/// A picture, shrunk, and what is cut out of it by colours.
struct PictureCut {
  static constexpr double kEndPx = 1;  ///< [px] by which cuts miss the object's end

  int denominator = 0;  ///< 0: the picture tells nothing
  Picture picture;
  cv::Mat1b mask;      ///< 1 on the object; empty: unknown
  cv::Mat1f distance;  ///< [px] to the nearest pixel of it

  /// [px] From where a point is drawn to the mask; NAN where the picture does not show it.
  double distance_px(const View& view, const Eigen::Vector3d& point, double* depth) const;
  /// Share of the points that the mask holds, of those that the picture shows; 1 of none, and 0
  /// without a mask.
  double share(const View& view, const std::vector<Eigen::Vector3d>& points) const;
};

/// The picture of a view as `read` shrinks it, so that the region's longer side has about
/// `object_px` pixels; its denominator is 0 if that cannot be read or the region is not in front.
PictureCut read_cut(const View& view, const ObjectRegion& region, double object_px,
                    const std::function<Picture(int denominator)>& read);

/// Where in the picture the object may be, and, within what is known of it, where that is likely,
/// as of cut_out(); empty if nobody knows.
cv::Mat1b may_be(const ShrunkView& shrunk, const ObjectRegion& region);

/// Cuts the pictures anew, all together. `maybe`, one per picture: as of cut_out(), empty if nobody
/// knows.
void cut_again(const std::vector<cv::Mat1b>& maybe, int rounds, std::vector<PictureCut>* cuts);

}  // namespace sketchsplat

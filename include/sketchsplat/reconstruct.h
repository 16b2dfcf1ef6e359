// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sketchsplat/curves.h"

namespace sketchsplat {

/// A calibrated view, in memory: a camera, and an image or edges that were found in it.
struct InputView {
  std::string name;           ///< of the view in results; view_0, view_1, ... if it is empty
  int width = 0, height = 0;  ///< [px]
  /// [px] fx 0 cx; 0 fy cy; 0 0 1. The centre of the top-left pixel is (0, 0).
  Eigen::Matrix3d intrinsics = Eigen::Matrix3d::Identity();
  /// World to camera: x_cam = rotation * x_world + translation; x right, y down, z forward.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  /// Lens distortion in OpenCV's order: none, k1 k2 p1 p2 [k3 [k4 k5 k6]], or the four of a
  /// fisheye.
  std::vector<double> distortion;
  bool fisheye = false;

  /// Rows of 8-bit samples: grey (1 channel), RGB (3) or RGBA (4; alpha is the mask). The caller
  /// keeps them until reconstruct() returns. Null: `edges` are used instead.
  const std::uint8_t* pixels = nullptr;
  int channels = 3;
  std::ptrdiff_t row_bytes = 0;  ///< from row to row; 0: they lie side by side
  /// Rows of 8 bits, bright where the object is; null: there is no mask.
  const std::uint8_t* mask = nullptr;
  std::ptrdiff_t mask_row_bytes = 0;
  /// Edges found by others, polylines in pixels of the image (2 x N, sub-pixel, in order along the
  /// edge). Used if no view has pixels.
  std::vector<Eigen::Matrix2Xd> edges;
};

/// How far the work is.
struct StageProgress {
  std::string stage;  ///< "detect", "lift", ...
  int done = 0;       ///< parts of this stage
  int total = 0;      ///< 0 if nobody knows
};

struct Options {
  std::string preset = "balanced";  ///< "fast", "balanced" or "accurate"
  /// "image", "2dgs-sn" (textured objects; needs masks); for folders also "maps:NAME", "geometry".
  std::string detector = "image";
  int threads = 0;            ///< 0: as many as OpenMP would take. The result is the same for any
  double min_confidence = 0;  ///< curves that are less probable are left out
  /// Called from time to time, never from two threads at once; false ends the work at the next
  /// stage. May be empty.
  std::function<bool(const StageProgress&)> progress;
  /// Everything that `sketchsplat reconstruct --help-all` lists, by name and value as text:
  /// {"rounds", "1"}, {"without", "second-look,missing"}.
  std::map<std::string, std::string> expert;
};

/// The edges of an object from views in memory, at least three. What the images hold too little for
/// is said by CurveSketch::ending; views that cannot be used are warnings. Throws
/// std::invalid_argument (unknown option, wrong value, a camera that is none) or
/// std::runtime_error.
CurveSketch reconstruct(const std::vector<InputView>& views, const Options& options = {});

/// The same from a folder of any format that docs/formats.md lists. Throws std::runtime_error if
/// it cannot be read.
CurveSketch reconstruct(const std::string& scene_folder, const Options& options = {});

}  // namespace sketchsplat

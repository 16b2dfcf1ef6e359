// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core.hpp>

#include "edges/image/detect.h"

namespace sketchsplat {

/// Tells hatching from edges: the layers of a print, grooves of a cutter or a brush make edges as
/// smooth as those of a part, but side by side, many in a row.
class Hatching {
 public:
  /// `map`: everything in a picture of `size` that may be an edge, within it; it must live as long.
  Hatching(const EdgelMap& map, cv::Size size);

  /// How likely [0, 1] an edgel of the map is one of hatching: a row of rungs leads across it to
  /// both sides, edgels along it that are at least half as strong, each a few pixels from the last.
  /// By Bayes: one in a thousand is, beforehand, and each rung is four times as likely there.
  double chance(const Edgel& edgel) const;

 private:
  int rungs(const Edgel& edgel, int side) const;
  const Edgel* next_rung(const Edgel& edgel, int side, double from_px) const;

  const EdgelMap& map_;
  cv::Mat1i at_;  // the edgel of a pixel, or -1
};

}  // namespace sketchsplat

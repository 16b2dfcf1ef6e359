// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "datasets/types/image.h"

namespace sketchsplat {

/// A point on an edge of an image, localised to a fraction of a pixel. In the pixels of the image
/// as it is found, in the ideal ones of the view (see View) for everybody else: undistort.h.
struct Edgel {
  float x = 0, y = 0;    ///< [px], centre of the top-left pixel is (0, 0)
  float nx = 0, ny = 0;  ///< unit normal, towards the brighter side
  float strength = 0;    ///< gradient magnitude on the edge, grey values in [0, 1] per px
  float width = 0;       ///< [px] standard deviation of the gradient's profile across the edge
  bool outline = false;  ///< the object's mask ends here
};

/// What edgels were looked for in: the part of a picture that can hold any, as one channel. Where
/// alpha is the mask, alpha * (grey + pedestal), see DetectOptions.
struct GreyPart {
  static constexpr float kOne = 40000;  ///< stands for the grey value 1
  Image<uint16_t> value;
  int x0 = 0, y0 = 0;  ///< [px] of its top-left pixel in the picture
};

/// The edgels of one view, chained along the edges, with a look-up by pixel.
struct EdgelMap {
  int width = 0, height = 0;  ///< of the image [px]
  std::vector<Edgel> edgels;  ///< chain after chain
  std::vector<int> chain;     ///< C + 1: chain c is edgels chain[c] .. chain[c + 1] - 1
  /// Per chain, minus the decimal logarithm of the number of chains like it that texture would make
  /// in this image; empty if nobody judged it, see meaningful.h.
  std::vector<float> meaning;
  float noise = 0;  ///< measured noise of the image, grey values in [0, 1]
  /// [px] median width of the edgels of a picture: what the camera and the detector blur it by; 0
  /// if they are of something else, or nobody knows.
  float blur = 0;
  Image<uint8_t> mask;  ///< 1 on the object, 0 elsewhere, in pixels of the image, never
                        ///< undistorted; empty if the image has no alpha
  /// In pixels of the image, never undistorted; null unless edgels are those of a picture.
  std::shared_ptr<const GreyPart> grey;

  // Look-up, where it is built. Its window: the bounding box of the edgels plus the reach.
  int x0 = 0, y0 = 0, window_width = 0, window_height = 0;
  /// Per pixel of the window: the nearest edgel within the reach; where there is none, minus the
  /// distance to the nearest pixel that has one (chessboard, at least 1).
  std::vector<int> nearest;

  int num_chains() const { return chain.empty() ? 0 : int(chain.size()) - 1; }
  /// Nearest edgel to a pixel position, or -1 if none lies within the reach.
  int nearest_at(double x, double y) const { return std::max(-1, nearest_or_far(x, y)); }
  /// The same; if none, minus a number of pixels (chessboard) nearer than which there is none at
  /// any pixel either.
  int nearest_or_far(double x, double y) const {
    if (!(x > -1e6 && x < 1e6 && y > -1e6 && y < 1e6)) return -1;
    const int u = int(x + 1000000.5) - 1000000 - x0, v = int(y + 1000000.5) - 1000000 - y0;
    if (u < 0 || v < 0 || u >= window_width || v >= window_height)
      return -std::max({1, -u, -v, u - window_width + 1, v - window_height + 1});
    return nearest[size_t(v) * window_width + u];
  }
};

/// [px] of the look-ups of an EdgeWorld.
inline constexpr double kLookupPx = 4;

/// Fills the look-up of a map for edgels within `reach_px` of a pixel centre.
void build_lookup(EdgelMap* map, double reach_px = kLookupPx);

/// Appends the runs of at least `min_chain` edgels within one chain that are marked, each as a
/// chain of its own; returns where they were. `keep`: one mark per edgel of `from`. `to` has
/// no look-up afterwards; unless all chains of both were judged, none of `to` is.
std::vector<int> append_runs(const EdgelMap& from, const std::vector<char>& keep, int min_chain,
                             EdgelMap* to);

/// Which chains are no accident, see meaningful.h.
struct MeaningOptions {
  /// False edges per image that are tolerated: pieces of chains that texture or noise would make
  /// more often than this are dropped. 0: none is dropped
  double most_false = 10000;
  /// Edgels that are kept at most, in side lengths of the picture (square root of its area): the
  /// least meaningful go first. 0: all stay
  double most_sides = 28;
};

struct DetectOptions {
  double sigma_px = 1.0;  ///< [px] smoothing of the gradient
  int coarser = 2;        ///< further scales, each sqrt(2) times the last, where noise hides edges
  double high_sigma = 7.0;    ///< an edge starts at this many standard deviations of the noise
  double low_sigma = 3.0;     ///< and is followed down to this many
  int min_chain = 6;          ///< [px] shorter chains are dropped
  double most_blur_px = 1.0;  ///< [px] pictures blurred by more are sharpened; 0: none
  MeaningOptions meaning;
};

/// Edgels of a picture: Gaussian gradient, hysteresis at thresholds that follow the noise measured
/// in this picture, position at the maximum along the normal; where a scale shows none, of coarser
/// ones. A blurred picture is sharpened (sharpen.h) when its edgels have told by how much it is.
/// Alpha, if any, is the mask: its outline is an edge, and colours outside it do not exist. An
/// empty picture gives an empty map. Without a look-up.
EdgelMap detect_edges(const Picture& picture, const DetectOptions& options);

/// Edge map in [0, 1] for people and rasterizers: a ridge of `sigma_px` along every edgel.
Image<float> draw_edge_map(const EdgelMap& map, double sigma_px);

}  // namespace sketchsplat

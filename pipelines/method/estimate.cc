// SPDX-License-Identifier: MIT
#include "pipelines/method/estimate.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

// Seconds and megabytes of a scene: at least, and per million pixels of its pictures.
struct Rate {
  double seconds, seconds_per_mpx, mb, mb_per_mpx;
};

Rate rate_of(const std::string& preset) {
  if (preset == "fast") return {0.08, 0.05, 25, 7};
  if (preset == "accurate") return {0.15, 0.16, 25, 7};
  return {0.1, 0.11, 25, 7};
}

}  // namespace

Load expected_load(int views, double pixels, const ReconstructOptions& options, int threads) {
  if (views == 0) return {0.1, 25};  // it cannot be opened: soon said
  const Rate rate = rate_of(options.preset);
  // Of the pictures as edges are looked for in them, if they are 4 : 3 (smaller_pictures.h).
  const double side = std::sqrt(pixels / views * 4 / 3);
  const bool smaller = options.detector == "image" && options.least_side > 0;
  const double factor = smaller ? std::max(1.0, std::floor(side / options.least_side)) : 1;
  const double mpx = pixels / (factor * factor) / 1e6;
  Load load = {rate.seconds + rate.seconds_per_mpx * mpx, rate.mb + rate.mb_per_mpx * mpx};
  if (options.detector == "2dgs-sn") {
    // A rendering goes over a given number of pixels at the most, whatever the pictures have.
    load.seconds += 1e-3 * options.surfels.renderings * views;
    load.memory_mb += 200;
  }
  load.seconds /= threads > 0 ? threads : 1;
  return load;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/types/image.h"

namespace sketchsplat {

/// Pixels of the object, or around it, of fewer than which colours tell nothing.
inline constexpr int kFewestColoured = 64;
/// How far around the object colours are looked at, in lengths of its longest side.
inline constexpr double kAroundObject = 0.2;

/// How often which colours were seen: counts over a grid of 32 bins a channel.
class Colours {
 public:
  /// Of each pixel of a picture, the bin of its colour.
  static Image<int> bins_of(const Picture& picture);

  Colours();
  void add(int bin) { count_[size_t(bin)] += 1, total_ += 1; }
  /// What was seen elsewhere, too.
  void add(const Colours& others);
  /// Noise spreads a colour over its neighbours in the grid: a binomial kernel along each channel.
  void spread();
  double total() const { return total_; }  ///< pixels
  /// Share of a bin; a little above 0 where nothing was seen.
  double share(int bin) const;

 private:
  std::vector<float> count_;
  double total_ = 0;
};

/// log(P(colour | object) / P(colour | around it)) [nat], up to 3 nat either way: pixels have
/// neighbours of their colour, which tell nothing new.
double nats_of(double share_on_object, double share_around);

/// Which side of a silhouette's end a pixel is known to lie on.
enum class Side : uint8_t { kUnknown, kObject, kAround };

/// The picture as the colours of either side tell the object: nats_of() its pixels as a grey value,
/// from 0 at -3 nat to 1 at 3. A texture whose colours are those of one side alone vanishes.
/// `side`: of the picture's size, where the colours of each are learnt. Empty if either has less
/// than 64 pixels. Without alpha.
Picture odds_by_colours(const Picture& picture, const Image<Side>& side);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "datasets/types/view.h"
#include "edges/views/lift.h"

namespace sketchsplat {

/// Silhouettes of one rigid object are consistent: what most views hold, projected, is each of
/// them. Pictures that are cut by colours alone (cut_out.h) need not be: that they are is what
/// tells right ones.
struct Silhouettes {
  /// Per view, in pixels of the image: 1 on the object and about `slack_px` around it, empty
  /// where nothing can be trusted. No views at all where too few can, or none of them
  /// shows the whole object.
  std::vector<Image<uint8_t>> mask;
  std::vector<double> slack_px;  ///< per view
  ObjectRegion region;           ///< around the object, as the silhouettes have it
  int trusted = 0;               ///< views
  double agreement = 0;          ///< median over the views, share of silhouettes that all hold
};

/// Of an object whose edges lie in `region`, as far as they are known (its box, and what stands on
/// the table within its outline), and no farther than a tenth of its size beyond. What touches it
/// nowhere, and is smaller than a quarter of it, is no part of it. `read`: the picture of a view,
/// shrunk by a whole denominator of at least 1; called from several threads, it may throw
/// InputError: that view is not trusted.
Silhouettes find_silhouettes(const std::vector<View>& views, const ObjectRegion& region,
                             const std::function<Picture(int view, int denominator)>& read);

/// 1 on the mask and up to `px` around it, 0 elsewhere.
Image<float> alpha_around(const Image<uint8_t>& mask, double px);

/// The world with silhouettes in place of masks: hull, edgels that lie on them alone, and those
/// beside their ends marked as outlines.
EdgeWorld with_silhouettes(EdgeWorld world, const Silhouettes& found);

}  // namespace sketchsplat

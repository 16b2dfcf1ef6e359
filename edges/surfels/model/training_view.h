// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/types/image.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// A picture as surfels are fitted to it: colours times alpha, so that nothing is black.
struct TrainingView {
  View view;               ///< camera of this resolution
  Image<float> color[3];   ///< red, green, blue, times alpha, in [0, 1]
  Image<float> alpha;      ///< in [0, 1]
};

/// The picture at no more than `max_side` pixels along its longer side, averaged over areas.
/// Precondition: the picture has an alpha and is of the camera's size.
TrainingView make_training_view(const View& view, const Picture& picture, int max_side);

/// The same from a training view of a higher resolution.
TrainingView shrink(const TrainingView& view, int max_side);

}  // namespace sketchsplat

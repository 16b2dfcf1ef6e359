// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/cameras/camera_fit.h"
#include "pipelines/cameras/posed.h"

namespace sketchsplat {

/// Standard deviations that make sure of what views share, which changes scale and place.
constexpr double kSureOfShared = 4;

/// What the first strokes say of the cameras.
struct Misfit {
  double offset_px = 0;  ///< of strokes in views: robust standard deviation
  double pose_px = 0;    ///< the same without what views share
  double error_px = 0;   ///< of the poses, in these offsets
  bool poses = false;    ///< they err
  bool shared = false;   ///< focal length, centre or lens err
  int rows = 0;          ///< edgels that tell

  bool confirmed() const { return poses || shared; }
};
Misfit misfit(const Posed& posed, const StatedCameras& stated);

/// What the views of a camera share moves only if the strokes are sure of it: where a flat object
/// does not tell, a wrong focal length would change the scale, a wrong centre the place.
CameraPrior prior_of(const Misfit& misfit);

}  // namespace sketchsplat

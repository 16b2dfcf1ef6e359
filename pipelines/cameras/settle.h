// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/cameras/camera_fit.h"
#include "pipelines/cameras/misfit.h"
#include "pipelines/cameras/posed.h"

namespace sketchsplat {

/// Moves the cameras of `first` together with its strokes, lifts again while that moves them, and
/// brings back views that are far off (bring_back.h): poses, and focal length, centre and lens if
/// these do not do it. Where strokes explain little even then, pictures of a quarter and a half of
/// the size are tried first. All are moved at last to where points of structure from motion
/// say, or else the stated cameras are likeliest (gauge.h). `off`: what the strokes say of the
/// stated cameras; `refit`: lifts and fits. The offsets of strokes in views that are left [px].
double settle_cameras(const Posed& first, const StatedCameras& stated, const Misfit& off,
                      const Refit& refit, Posed* posed);

/// Relative standard deviation of the size of what the moved cameras show.
double scale_sigma(const Posed& posed, const StatedCameras& stated, const Misfit& off);

}  // namespace sketchsplat

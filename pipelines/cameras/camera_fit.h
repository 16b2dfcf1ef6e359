// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pipelines/cameras/camera_unknowns.h"
#include "pipelines/survey/observe.h"

namespace sketchsplat {

/// Cameras and strokes that agree best with matched edgels, and how well.
struct CameraFit {
  std::vector<View> views;
  Sketch sketch;
  double scatter_px = 0;   ///< of single edgels about the offset of their stroke in their view
  double before_px = 0;    ///< root mean square of the offsets of strokes in views before the fit
  double after_px = 0;     ///< and after it
  int offsets = 0;         ///< number of these: a stroke in a view
  int unknowns = 0;        ///< of the cameras
  double shared_gain = 0;  ///< by which the sum of squares, in variances, is smaller because what
                           ///< the views of a camera share (focal length, centre, lens) has moved
  int shared = 0;          ///< number of such unknowns
  double scale_sigma = 0;  ///< relative, of the size of all strokes: what the cameras leave open
  std::vector<double> radius_px;           ///< per view: of the object's image
};

/// Moves cameras and strokes, by Levenberg and Marquardt's method, so that the squared distances of
/// the edgels from the images of the strokes become small: every edgel with the biweight of its
/// match and as much less as its stroke has more of them in its view, where they err alike; strokes
/// eliminated first (Schur's complement). Distances are those in the image, behind the lens, from
/// the tangent of the stroke's image; strokes that share a node are free of one another, and their
/// ends meet in the middle at last. The gauge is held by the prior about `stated`, from which alone
/// it counts; world.views, which the observation was made with, are where the search begins.
CameraFit fit_cameras(const Sketch& sketch, const Observation& observation, const EdgeWorld& world,
                      const std::vector<View>& stated, const CameraPrior& prior, int steps);

}  // namespace sketchsplat

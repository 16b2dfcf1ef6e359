// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/readers/scene.h"
#include "pipelines/cameras/camera_unknowns.h"
#include "pipelines/survey/observe.h"

namespace sketchsplat {

/// Cameras as stated, and the points that structure from motion found with
/// them (point_prior.h), whose sights index these views.
struct StatedCameras {
  std::vector<View> views;
  std::vector<ScenePoint> points = {};
};

/// How cameras and strokes are fitted.
struct CameraFitOptions {
  int steps = 3;             ///< at most
  bool strokes_move = true;  ///< false: strokes stay where they are (resection)
};

/// Cameras and strokes that agree best with matched edgels, and how well.
struct CameraFit {
  std::vector<View> views;
  Sketch sketch;
  double scatter_px = 0;   ///< of single edgels about the offset of their stroke in their view
  double before_px = 0;    ///< root mean square of the offsets of strokes in views before the fit
  double after_px = 0;     ///< and after it
  int offsets = 0;         ///< number of these: a stroke in a view
  int unknowns = 0;        ///< of the cameras
  double scale_sigma = 0;  ///< relative, of the size of all strokes: what the cameras leave open
  std::vector<double> radius_px;  ///< per view: of the object's image
};

/// Moves cameras and strokes, by Levenberg and Marquardt's method, so that the squared distances of
/// the edgels from the images of the strokes become small: every edgel with the biweight of its
/// match and as much less as its stroke has more of them in its view, where they err alike; strokes
/// eliminated first (Schur's complement). Distances are those in the image, behind the lens, from
/// the tangent of the stroke's image; strokes that share a node are free of one another, and their
/// ends meet in the middle at last. The gauge is held by the prior about `stated`, from which alone
/// it counts, and by its points; world.views, which the observation was made with, are where the
/// search begins.
CameraFit fit_cameras(const Sketch& sketch, const Observation& observation, const EdgeWorld& world,
                      const StatedCameras& stated, const CameraPrior& prior,
                      const CameraFitOptions& options);

/// Whether cameras err, from what strokes tell that other strokes confirm.
struct CameraEvidence {
  double offset_px = 0;  ///< robust standard deviation of the offsets of strokes in views
  double error_px = 0;   ///< root mean square of that part of the offsets which poses make
  /// Confirmed::sigmas, if poses are exact and strokes err by themselves: normal, mean 0, variance
  /// 1 to 2.
  double poses = 0;
  double shared = 0;  ///< standard normal if what views share is right, of poses within the prior
};

/// Two halves of the strokes each say how the cameras err, and each is asked whether that fits its
/// own offsets r, too: by moves d of them which the other half tells, d.r is normal with variance
/// d.d where cameras are right, in standard deviations of offsets; else its mean is d.d. One linear
/// step from world.views. Of what views share every other view of a camera makes a half, with
/// strokes and poses of its own: a part may have few strokes.
CameraEvidence camera_evidence(const Sketch& sketch, const Observation& observation,
                               const EdgeWorld& world, const StatedCameras& stated,
                               const CameraPrior& prior);

}  // namespace sketchsplat

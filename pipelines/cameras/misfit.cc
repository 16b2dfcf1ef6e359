// SPDX-License-Identifier: MIT
#include "pipelines/cameras/misfit.h"

#include <algorithm>

namespace sketchsplat {
namespace {

constexpr double kErrPx = 0.075;   // what poses that err less make of strokes is no matter
constexpr double kRare = 1.645;    // exact poses in one scene of eight to twenty
constexpr double kExactPx = 0.02;  // poses err at least by this
constexpr double kLoose = 3;       // times the offsets, which do not reach beyond the matches

}  // namespace

Misfit misfit(const Posed& posed, const StatedCameras& stated) {
  Misfit out;
  if (posed.sketch.size() == 0) return out;
  const Observation o = look(posed, kCameraReachPx);
  out.rows = int(o.matches.matches.size());
  if (out.rows == 0) return out;
  const CameraEvidence evidence = camera_evidence(posed.sketch, o, posed.world, stated, {});
  out.offset_px = out.pose_px = evidence.offset_px, out.error_px = evidence.error_px;
  // Cameras that structure from motion found are never exact.
  const double least = stated.points.empty() ? kErrPx : kExactPx;
  out.poses = evidence.poses > kRare && evidence.error_px > least;
  CameraPrior held;
  held.pose_px = kExactPx;
  // Poses that nothing contradicts do not take up what another focal length or lens explains.
  out.shared =
      (out.poses ? evidence : camera_evidence(posed.sketch, o, posed.world, stated, held)).shared >
      kSureOfShared;
  if (!out.shared) return out;
  out.pose_px = fit_cameras(posed.sketch, o, posed.world, stated, held, {}).after_px;
  return out;
}

CameraPrior prior_of(const Misfit& misfit) {
  CameraPrior prior;
  prior.shared = misfit.shared;
  prior.pose_px = std::max(kExactPx, (misfit.poses ? kLoose : 1) * misfit.pose_px);
  return prior;
}

}  // namespace sketchsplat

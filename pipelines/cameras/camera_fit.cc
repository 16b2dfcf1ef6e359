// SPDX-License-Identifier: MIT
#include "pipelines/cameras/camera_fit.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "pipelines/cameras/camera_system.h"
#include "pipelines/cameras/halves.h"

namespace sketchsplat {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// How errors of the cameras grow the strokes about their middle: these follow the cameras, dx =
// -A^-1 B dc, and the cameras' covariance is that of the system without strokes. By samples, for
// not all control points are places.
double CameraSystem::scale_sigma() const {
  std::vector<StrokeVector> growth(kinds_.size(), StrokeVector::Zero());
  double spread = 0;
  for (int i = 0; i < layout_.size(); ++i) {
    const int s = layout_.stroke[i];
    const Vector3d arm = points_[i] - middle_;
    growth[s] += point_jacobian(kinds_[s], now_.strokes[s], layout_.t[i]).transpose() * arm;
    spread += arm.squaredNorm();
  }
  VectorXd by_camera = VectorXd::Zero(cameras_.size());
  for (size_t s = 0; s < growth.size(); ++s)
    by_camera -= normals_[s].cross.transpose() *
                 (normals_[s].root.transpose() * (normals_[s].root * growth[s])) / spread;
  const double variance = by_camera.dot(solve_symmetric(hessian_, by_camera));
  return variance > 0 ? std::sqrt(variance) : 0;
}

CameraEvidence CameraSystem::evidence() {
  std::vector<Linear> rows;
  linearise(&rows);
  const int poses = CameraUnknowns::kPose * cameras_.views(), shared = cameras_.size() - poses;
  const MatrixXd& information = prior_.information;
  const auto prior_cross = information.topRightCorner(poses, shared);
  const MatrixXd prior_shared =  // poses are free in it
      information.bottomRightCorner(shared, shared) -
      prior_cross.transpose() *
          solve_symmetric(information.topLeftCorner(poses, poses), prior_cross);
  Halves of_poses, of_shared;
  const VectorXd of_prior = prior_.gradient + information * now_.cameras;
  for (const int half : {0, 1}) {
    assemble(rows, 0, {Part::kViews, half});
    gradient_ -= of_prior;
    const auto cross = hessian_.topRightCorner(poses, shared);
    const MatrixXd follow = solve_symmetric(hessian_.topLeftCorner(poses, poses), cross);
    of_shared.hessian[half] =
        hessian_.bottomRightCorner(shared, shared) - cross.transpose() * follow;
    of_shared.hessian[half] -= prior_shared;
    of_shared.gradient[half] = gradient_.tail(shared) - follow.transpose() * gradient_.head(poses);
    assemble(rows, 0, {Part::kStrokes, half});
    gradient_ -= of_prior;
    of_poses.hessian[half] = hessian_.topLeftCorner(poses, poses);
    of_poses.hessian[half] -= information.topLeftCorner(poses, poses);
    of_poses.gradient[half] = gradient_.head(poses);
  }
  const Confirmed moved = confirm(of_poses, information.topLeftCorner(poses, poses));
  CameraEvidence out;
  out.offset_px = before_;
  out.poses = moved.sigmas;
  out.error_px = offset_sigma_ * std::sqrt(std::max(0.0, moved.told) / std::max(1, offsets_));
  if (shared > 0) out.shared = alike(of_shared, prior_shared);
  return out;
}

CameraFit CameraSystem::result(const Sketch& joined) {
  CameraFit out;
  out.views = cameras_.current();
  out.sketch = with_control_points(joined, now_.strokes);
  out.scatter_px = scatter_, out.before_px = before_, out.after_px = offset_px();
  out.offsets = offsets_, out.unknowns = cameras_.size();
  out.radius_px = radius_;
  std::vector<Linear> rows;
  linearise(&rows);
  assemble(rows, 0);
  out.scale_sigma = scale_sigma();
  return out;
}

CameraFit fit_cameras(const Sketch& sketch, const Observation& observation, const EdgeWorld& world,
                      const StatedCameras& stated, const CameraPrior& prior,
                      const CameraFitOptions& options) {
  CameraSystem system(sketch, observation, world, stated, prior, options);
  system.solve();
  return system.result(sketch);
}

CameraEvidence camera_evidence(const Sketch& sketch, const Observation& observation,
                               const EdgeWorld& world, const StatedCameras& stated,
                               const CameraPrior& prior) {
  return CameraSystem(sketch, observation, world, stated, prior, {}).evidence();
}

}  // namespace sketchsplat

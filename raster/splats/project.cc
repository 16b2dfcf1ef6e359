// SPDX-License-Identifier: MIT
#include "raster/splats/project.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

using Matrix23 = Eigen::Matrix<double, 2, 3>;

// The intermediate values that forward and backward share.
struct Linearised {
  Eigen::Vector3d mean_in_cam;
  Eigen::Vector3d tangent_in_cam;
  Matrix23 J;             // d pixel / d mean_in_cam
  Eigen::Vector2d axis;   // J tangent_in_cam
  Eigen::Matrix2d round;  // J J^T
  double along2, across2;
};

Linearised linearise(const Splats& splats, int i, const View& view) {
  Linearised l;
  l.mean_in_cam = view.cam_from_world * splats.mean.col(i);
  l.tangent_in_cam = view.cam_from_world.rotation * splats.tangent.col(i);
  l.J = view.camera.project_jacobian(l.mean_in_cam);
  l.axis = l.J * l.tangent_in_cam;
  l.round = l.J * l.J.transpose();
  l.along2 = splats.along[i] * splats.along[i];
  l.across2 = splats.across[i] * splats.across[i];
  return l;
}

// Comparisons are written so that a NaN fails them.
bool in_front(const Splats& splats, int i, const View& view, const RasterOptions& options) {
  const double size = std::max(std::abs(splats.along[i]), std::abs(splats.across[i]));
  const double depth = view.cam_from_world.rotation.row(2).dot(splats.mean.col(i)) +
                       view.cam_from_world.translation.z();
  return depth > 0 && depth > options.near_sigmas * size && splats.opacity[i] >= 0;
}

bool near_image(const Eigen::Vector2d& pixel, const Camera& camera, double margin) {
  const double mx = margin * camera.width, my = margin * camera.height;
  return pixel.x() >= -mx && pixel.x() <= camera.width - 1 + mx && pixel.y() >= -my &&
         pixel.y() <= camera.height - 1 + my;
}

// Pixels within `half` of `centre`, clipped to [0, size - 1]; false if there are none.
bool clip(double centre, double half, int size, int* first, int* last) {
  *first = int(std::ceil(std::max(centre - half, 0.0)));
  *last = int(std::floor(std::min(centre + half, size - 1.0)));
  return *first <= *last;
}

bool project(const Splats& splats, int i, double visibility, const View& view,
             const RasterOptions& options, Footprint* f) {
  if (!(visibility > 0) || !in_front(splats, i, view, options)) return false;
  const Linearised l = linearise(splats, i, view);
  f->mean = view.camera.project(l.mean_in_cam);
  if (!near_image(f->mean, view.camera, options.margin)) return false;
  Eigen::Matrix2d S = l.across2 * l.round + (l.along2 - l.across2) * l.axis * l.axis.transpose();
  S.diagonal().array() += options.lowpass_px * options.lowpass_px;
  const double determinant = S(0, 0) * S(1, 1) - S(0, 1) * S(0, 1);
  if (!(determinant > 0) || !std::isfinite(determinant)) return false;
  if (!clip(f->mean.x(), options.cutoff * std::sqrt(S(0, 0)), view.camera.width, &f->x0, &f->x1) ||
      !clip(f->mean.y(), options.cutoff * std::sqrt(S(1, 1)), view.camera.height, &f->y0, &f->y1)) {
    return false;
  }
  f->u00 = std::sqrt(S(1, 1) / determinant);
  f->u01 = -S(0, 1) / (determinant * f->u00);
  f->u11 = 1 / std::sqrt(S(1, 1));
  f->splat = i;
  f->peak = splats.opacity[i] * visibility;
  return true;
}

// Gradient by the point in camera coordinates that reaches J = J(point): dL/dJ is `by_J`.
Eigen::Vector3d jacobian_backward(const Camera& camera, const Eigen::Vector3d& p,
                                  const Matrix23& by_J) {
  const double iz = 1 / p.z(), iz2 = iz * iz;
  const double gx = camera.fx * iz2, gy = camera.fy * iz2;
  return {-gx * by_J(0, 2), -gy * by_J(1, 2),
          gx * (2 * p.x() * iz * by_J(0, 2) - by_J(0, 0)) +
              gy * (2 * p.y() * iz * by_J(1, 2) - by_J(1, 1))};
}

}  // namespace

std::vector<Footprint> project_splats(const Splats& splats,
                                      const Eigen::Ref<const Eigen::VectorXf>& visibility,
                                      const View& view, const RasterOptions& options) {
  std::vector<Footprint> footprints;
  footprints.reserve(splats.size());
  Footprint f;
  for (int i = 0; i < splats.size(); ++i) {
    const double v = visibility.size() ? visibility[i] : 1.0;
    if (project(splats, i, v, view, options, &f)) footprints.push_back(f);
  }
  return footprints;
}

void project_splats_backward(const Splats& splats,
                             const Eigen::Ref<const Eigen::VectorXf>& visibility, const View& view,
                             const std::vector<Footprint>& footprints,
                             const std::vector<FootprintGradient>& footprint_gradients,
                             SplatGradient* gradient) {
  const Eigen::Matrix3d& R = view.cam_from_world.rotation;
  for (size_t k = 0; k < footprints.size(); ++k) {
    const int i = footprints[k].splat;
    const FootprintGradient& g = footprint_gradients[k];
    const Linearised l = linearise(splats, i, view);
    const Eigen::Vector2d H_axis = g.covariance * l.axis;
    const double by_along2 = l.axis.dot(H_axis);
    const double by_across2 = g.covariance.cwiseProduct(l.round).sum() - by_along2;
    const Eigen::Vector2d by_axis = 2 * (l.along2 - l.across2) * H_axis;
    const Matrix23 by_J =
        2 * l.across2 * g.covariance * l.J + by_axis * l.tangent_in_cam.transpose();
    const Eigen::Vector3d by_mean =
        l.J.transpose() * g.mean + jacobian_backward(view.camera, l.mean_in_cam, by_J);
    gradient->mean.col(i) += R.transpose() * by_mean;
    gradient->tangent.col(i) += R.transpose() * (l.J.transpose() * by_axis);
    gradient->along[i] += 2 * splats.along[i] * by_along2;
    gradient->across[i] += 2 * splats.across[i] * by_across2;
    gradient->opacity[i] += g.peak * (visibility.size() ? visibility[i] : 1.0);
  }
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "datasets/types/image.h"
#include "datasets/types/view.h"
#include "raster/splats/loss.h"
#include "raster/splats/project.h"
#include "raster/splats/splats.h"

// The renderer said plainly: every pixel asks every splat, in double precision, through the full 3D
// covariance. The referee of raster/splats/render.h; far too slow for anything else.
namespace sketchsplat {

/// One splat over a scalar T (double, or a dual number that differentiates).
template <typename T>
struct ReferenceSplat {
  Eigen::Matrix<T, 3, 1> mean, tangent;
  T along, across, opacity;
};

/// k(q) of RasterOptions.
template <typename T>
T reference_profile(const T& q, double cutoff) {
  using std::exp;
  const double Q = cutoff * cutoff, rim = std::exp(-Q / 2);
  if (!(q < T(Q))) return T(0);
  return (exp(-q / 2.0) - rim * (1.0 + (Q - q) / 2.0)) / (1 - rim * (1 + Q / 2));
}

/// Optical depth of a splat, which must be in front of the camera, at a pixel.
template <typename T>
T reference_depth(const ReferenceSplat<T>& s, const View& view, int x, int y,
                  const RasterOptions& options) {
  using Vector2 = Eigen::Matrix<T, 2, 1>;
  const Camera& camera = view.camera;
  const Eigen::Matrix<T, 3, 3> R = view.cam_from_world.rotation.cast<T>();
  const Eigen::Matrix<T, 3, 1> p = R * s.mean + view.cam_from_world.translation.cast<T>();
  Eigen::Matrix<T, 2, 3> J;
  J << camera.fx / p.z(), T(0), -camera.fx * p.x() / (p.z() * p.z()),  //
      T(0), camera.fy / p.z(), -camera.fy * p.y() / (p.z() * p.z());
  const Eigen::Matrix<T, 3, 3> Sigma =
      s.across * s.across * Eigen::Matrix<T, 3, 3>::Identity() +
      (s.along * s.along - s.across * s.across) * s.tangent * s.tangent.transpose();
  Eigen::Matrix<T, 2, 2> S = J * R * Sigma * R.transpose() * J.transpose();
  S.diagonal().array() += T(options.lowpass_px * options.lowpass_px);
  const Vector2 d(T(x) - (camera.fx * p.x() / p.z() + camera.cx),
                  T(y) - (camera.fy * p.y() / p.z() + camera.cy));
  const Eigen::Matrix<T, 2, 2> S_inverse = S.inverse();
  const T q = d.dot(S_inverse * d);
  return s.opacity * reference_profile(q, options.cutoff);
}

/// Like render.
Image<double> reference_render(const Splats& splats, const Eigen::VectorXf& visibility,
                               const View& view, const RasterOptions& options);

/// Like render_loss, from the edge image itself; chain rule in its textbook form.
double reference_loss(const Splats& splats, const Eigen::VectorXf& visibility, const View& view,
                      const Image<float>& edges, const LossOptions& loss_options,
                      const RasterOptions& options, SplatGradient* gradient);

}  // namespace sketchsplat

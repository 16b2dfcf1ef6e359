// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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

inline double visibility_of(const Eigen::VectorXf& visibility, int i) {
  return visibility.size() ? visibility[i] : 1.0;
}

// The rules of RasterOptions for what is drawn at all.
inline bool is_drawn(const Splats& s, int i, double visibility, const View& view,
                     const RasterOptions& options) {
  double depth;
  const Eigen::Vector2d pixel = view.project(s.mean.col(i), &depth);
  const Eigen::Array2d size(view.camera.width, view.camera.height);
  const Eigen::Array2d outside = (-pixel.array()).max(pixel.array() - (size - 1));
  const bool finite = s.mean.col(i).allFinite() && s.tangent.col(i).allFinite() &&
                      std::isfinite(s.along[i] + s.across[i] + s.opacity[i]);
  return finite && visibility > 0 && depth > 0 &&
         depth > options.near_sigmas * std::max(s.along[i], s.across[i]) &&
         (outside <= options.margin * size).all();
}

inline Image<double> depth_image(const Splats& splats, const Eigen::VectorXf& visibility,
                                 const View& view, const RasterOptions& options) {
  Image<double> depth(view.camera.width, view.camera.height);
  for (int i = 0; i < splats.size(); ++i) {
    const double v = visibility_of(visibility, i);
    if (!is_drawn(splats, i, v, view, options)) continue;
    const ReferenceSplat<double> s{splats.mean.col(i), splats.tangent.col(i), splats.along[i],
                                   splats.across[i], splats.opacity[i]};
    for (int y = 0; y < depth.height; ++y) {
      for (int x = 0; x < depth.width; ++x) {
        depth.at(x, y) += v * reference_depth(s, view, x, y, options);
      }
    }
  }
  return depth;
}

// Adds the gradient by splat i, given `by_depth` = dL/dtau of every pixel.
inline void add_gradient(const Splats& splats, int i, double visibility, const View& view,
                         const RasterOptions& options, const Image<double>& by_depth,
                         SplatGradient* gradient) {
  const Eigen::Vector3d t = splats.tangent.col(i);
  const double along = splats.along[i], across = splats.across[i], opacity = splats.opacity[i];
  const double stretch = along * along - across * across;
  const Eigen::Matrix3d Sigma =
      across * across * Eigen::Matrix3d::Identity() + stretch * t * t.transpose();
  const Eigen::Matrix3d& R = view.cam_from_world.rotation;
  const Eigen::Vector3d p = view.cam_from_world * splats.mean.col(i);
  const Eigen::Matrix<double, 2, 3> J = view.camera.project_jacobian(p), JR = J * R;
  const Eigen::Matrix2d S = JR * Sigma * JR.transpose() +
                            options.lowpass_px * options.lowpass_px * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d C = S.inverse();
  const double Q = options.cutoff * options.cutoff, rim = std::exp(-Q / 2);

  double by_peak = 0;
  Eigen::Vector2d by_pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d by_S = Eigen::Matrix2d::Zero();
  for (int y = 0; y < by_depth.height; ++y) {
    for (int x = 0; x < by_depth.width; ++x) {
      const Eigen::Vector2d Cd = C * (Eigen::Vector2d(x, y) - view.camera.project(p));
      const double q = Cd.dot(S * Cd);
      if (q >= Q) continue;
      const double slope = -0.5 * (std::exp(-q / 2) - rim) / (1 - rim * (1 + Q / 2));
      const double by_q = by_depth.at(x, y) * opacity * visibility * slope;
      by_peak += by_depth.at(x, y) * reference_profile(q, options.cutoff);
      by_pixel += by_q * -2 * Cd;
      by_S += by_q * -Cd * Cd.transpose();
    }
  }
  const Eigen::Matrix3d by_Sigma = JR.transpose() * by_S * JR;
  const Eigen::Matrix<double, 2, 3> by_J = 2 * by_S * JR * Sigma * R.transpose();
  const double z2 = p.z() * p.z(), z3 = z2 * p.z(), fx = view.camera.fx, fy = view.camera.fy;
  Eigen::Vector3d by_p = J.transpose() * by_pixel;
  by_p.x() += by_J(0, 2) * -fx / z2;
  by_p.y() += by_J(1, 2) * -fy / z2;
  by_p.z() += by_J(0, 0) * -fx / z2 + by_J(1, 1) * -fy / z2 + by_J(0, 2) * 2 * fx * p.x() / z3 +
              by_J(1, 2) * 2 * fy * p.y() / z3;
  gradient->mean.col(i) += R.transpose() * by_p;
  gradient->tangent.col(i) += 2 * stretch * by_Sigma * t;
  gradient->along[i] += 2 * along * t.dot(by_Sigma * t);
  gradient->across[i] += 2 * across * (by_Sigma.trace() - t.dot(by_Sigma * t));
  gradient->opacity[i] += visibility * by_peak;
}

/// Like render.
inline Image<double> reference_render(const Splats& splats, const Eigen::VectorXf& visibility,
                                      const View& view, const RasterOptions& options) {
  Image<double> image = depth_image(splats, visibility, view, options);
  for (double& value : image.data) value = 1 - std::exp(-value);
  return image;
}

/// Like render_loss, from the edge image itself; chain rule in its textbook form.
inline double reference_loss(const Splats& splats, const Eigen::VectorXf& visibility,
                             const View& view, const Image<float>& edges,
                             const RasterOptions& options, SplatGradient* gradient) {
  Image<double> depth = depth_image(splats, visibility, view, options);
  double loss = 0;
  for (size_t k = 0; k < depth.data.size(); ++k) {
    const double transmittance = std::exp(-depth.data[k]);
    const double off = 1 - transmittance - edges.data[k];
    loss += off * off / 2;
    depth.data[k] = off * transmittance;
  }
  if (!gradient) return loss;
  *gradient = SplatGradient::zero(splats.size());
  for (int i = 0; i < splats.size(); ++i) {
    const double v = visibility_of(visibility, i);
    if (is_drawn(splats, i, v, view, options)) {
      add_gradient(splats, i, v, view, options, depth, gradient);
    }
  }
  return loss;
}

}  // namespace sketchsplat

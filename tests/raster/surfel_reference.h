// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/types/view.h"
#include "raster/surfels/surfel.h"
#include "tests/raster/reference.h"

// The surfel renderer said plainly: every pixel asks every surfel, in double precision, where its
// ray meets the plane of the disk. The referee of raster/surfels/surfel.h; far too slow for
// anything else.
namespace sketchsplat {

/// One surfel over a scalar T (double, or a dual number that differentiates). As in SurfelCloud.
template <typename T>
struct ReferenceSurfel {
  Eigen::Matrix<T, 3, 1> center;
  Eigen::Matrix<T, 4, 1> rotation;
  Eigen::Matrix<T, 2, 1> log_scale;
  T opacity;
  Eigen::Matrix<T, 3, 1> color;
  Eigen::Matrix<T, 2, 1> skew;
};

/// The images of SurfelImages at one pixel.
template <typename T>
struct ReferenceSurfelPixel {
  Eigen::Matrix<T, 3, 1> color, normal;
  T alpha, depth, median_depth;
};

template <typename T>
ReferenceSurfel<T> reference_surfel(const SurfelCloud& cloud, int i) {
  return {cloud.center.col(i).cast<T>(),    cloud.rotation.col(i).cast<T>(),
          cloud.log_scale.col(i).cast<T>(), T(cloud.opacity[i]),
          cloud.color.col(i).cast<T>(),     cloud.skew.col(i).cast<T>()};
}

/// A surfel in the camera frame.
template <typename T>
struct ReferenceDisk {
  Eigen::Matrix<T, 3, 1> center, u_axis, v_axis, normal;  // axes are unit vectors
  Eigen::Matrix<T, 2, 1> scale, skew;                     // skew: bounded
  T opacity;
  bool drawn;  // by SurfelOptions, but for the image's borders
};

template <typename T>
ReferenceDisk<T> reference_disk(const ReferenceSurfel<T>& s, const View& view,
                                const SurfelOptions& options) {
  using std::exp;
  using std::sqrt;
  using std::tanh;
  ReferenceDisk<T> d;
  const Eigen::Matrix<T, 4, 1> q = s.rotation / s.rotation.norm();
  const Eigen::Matrix<T, 3, 3> world = view.cam_from_world.rotation.cast<T>();
  const Eigen::Matrix<T, 3, 3> axes =
      world * Eigen::Quaternion<T>(q[0], q[1], q[2], q[3]).toRotationMatrix();
  d.center = world * s.center + view.cam_from_world.translation.cast<T>();
  d.u_axis = axes.col(0);
  d.v_axis = axes.col(1);
  d.normal = axes.col(2);
  if (d.normal.dot(d.center) > T(0)) d.normal = -d.normal;
  d.scale << exp(s.log_scale[0]), exp(s.log_scale[1]);
  d.opacity = T(1) / (T(1) + exp(-s.opacity));
  d.skew.setZero();
  const T length2 = s.skew.squaredNorm();
  if (options.kernel == SurfelKernel::kSkewNormal) {
    d.skew = s.skew * T(options.max_skew);  // tanh(n) / n is 1 at 0
    if (length2 > T(0)) d.skew *= tanh(sqrt(length2)) / sqrt(length2);
  }
  const Eigen::Matrix<T, 2, 1> depths(d.scale[0] * d.u_axis.z(), d.scale[1] * d.v_axis.z());
  const T z = d.center.z();
  d.drawn = z > T(0) && depths.squaredNorm() * T(options.cutoff * options.cutoff) < z * z &&
            (options.near == 0 || z - options.cutoff * sqrt(depths.squaredNorm()) > options.near);
  return d;
}

/// Alpha of a disk at a pixel and the depth there.
template <typename T>
T reference_surfel_alpha(const ReferenceDisk<T>& d, const View& view, double x, double y,
                         const SurfelOptions& options, T* depth) {
  using std::abs;
  using std::erfc;
  using std::min;
  const Camera& camera = view.camera;
  const Eigen::Matrix<T, 3, 1> ray = camera.ray({x, y}).cast<T>();
  const Eigen::Matrix<T, 2, 1> away(T(x) - (camera.fx * d.center.x() / d.center.z() + camera.cx),
                                    T(y) - (camera.fy * d.center.y() / d.center.z() + camera.cy));
  const T lowpass = reference_profile(
      T(away.squaredNorm() / (options.lowpass_px * options.lowpass_px)), options.cutoff);
  T value(0), z = d.center.z();
  const T height = d.normal.dot(d.center);
  if (abs(height) > options.min_cosine * d.center.norm()) {
    const T along = height / d.normal.dot(ray);  // NaN or infinite: compares as not in the disk
    const Eigen::Matrix<T, 3, 1> offset = along * ray - d.center;
    const T u = offset.dot(d.u_axis) / d.scale[0], v = offset.dot(d.v_axis) / d.scale[1];
    if (along > T(0) && u * u + v * v < T(options.cutoff * options.cutoff)) {
      z = along;
      const T slope = d.skew[0] * u + d.skew[1] * v;
      value = reference_profile(T(u * u + v * v), options.cutoff) * erfc(-slope / std::sqrt(2.0));
    }
  }
  if (lowpass > value) {
    value = lowpass;
    z = d.center.z();
  }
  *depth = z;
  const T alpha = d.opacity * value;
  return alpha < T(options.max_alpha) ? alpha : T(options.max_alpha);
}

/// All images at a pixel; `disks`: reference_disk of the surfels.
template <typename T>
ReferenceSurfelPixel<T> reference_surfel_pixel(const std::vector<ReferenceSurfel<T>>& surfels,
                                               const std::vector<ReferenceDisk<T>>& disks,
                                               const View& view, int x, int y,
                                               const SurfelOptions& options) {
  std::vector<int> order(surfels.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = int(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return disks[i].center.z() < disks[j].center.z(); });
  ReferenceSurfelPixel<T> p;
  p.color.setZero();
  p.normal.setZero();
  p.alpha = p.depth = p.median_depth = T(0);
  T light(1);
  for (const int i : order) {
    if (!disks[i].drawn) continue;
    T z;
    const T alpha = reference_surfel_alpha(disks[i], view, x, y, options, &z);
    if (!(alpha > T(0))) continue;
    const T w = light * alpha;
    p.color += w * surfels[i].color;
    p.normal += w * disks[i].normal;
    p.alpha += w;
    p.depth += w * z;
    const T before = light;
    light *= T(1) - alpha;
    if (before > T(0.5) && light <= T(0.5)) p.median_depth = z;
    if (light < T(options.min_transmittance)) break;
  }
  return p;
}

}  // namespace sketchsplat

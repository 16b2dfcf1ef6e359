// SPDX-License-Identifier: MIT
#include "raster/surfels/surfel_footprint.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "datasets/types/parallel.h"
#include "raster/splats/lanes.h"

namespace sketchsplat {
namespace {

// What forward and backward share: a surfel in the camera frame.
struct Disk {
  Eigen::Vector4d quaternion;  // normalised
  double length;               // of the quaternion before
  Eigen::Matrix3d axes;        // camera from surfel, rotation
  Eigen::Vector2d scale;
  Eigen::Matrix3d H;     // (u, v, 1) to the point in the camera: [scale_u axis_u, ..., centre]
  Eigen::Matrix3d rays;  // (dx, dy, 1) to the ray with z = 1
  Eigen::Vector3d center() const { return H.col(2); }
  bool faces_away() const { return axes.col(2).dot(H.col(2)) > 0; }
};

Eigen::Matrix3d rotation_of(const Eigen::Vector4d& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

Disk disk_of(const SurfelCloud& cloud, int i, const View& view) {
  Disk d;
  d.length = cloud.rotation.col(i).norm();
  d.quaternion = cloud.rotation.col(i) / d.length;
  d.axes = view.cam_from_world.rotation * rotation_of(d.quaternion);
  d.scale = cloud.log_scale.col(i).array().exp();
  d.H << d.scale[0] * d.axes.col(0), d.scale[1] * d.axes.col(1),
      view.cam_from_world * cloud.center.col(i);
  const Eigen::Vector3d p = d.center();
  d.rays << 1 / view.camera.fx, 0, p.x() / p.z(), 0, 1 / view.camera.fy, p.y() / p.z(), 0, 0, 1;
  return d;
}

double sigmoid(double logit) { return 1 / (1 + std::exp(-logit)); }

// f(n) = tanh(n) / n and f'(n) / n.
void tanh_over(double n, double* f, double* slope) {
  if (n < 1e-3) {
    *f = 1 - n * n / 3;
    *slope = -2.0 / 3 + 8.0 / 15 * n * n;
  } else {
    const double t = std::tanh(n);
    *f = t / n;
    *slope = ((1 - t * t) * n - t) / (n * n * n);
  }
}

// Comparisons are written so that a NaN fails them.
bool is_drawable(const SurfelCloud& cloud, int i, const Disk& d, const SurfelOptions& options) {
  const double reach = options.cutoff * d.H.row(2).head<2>().norm();
  return d.H.allFinite() && d.center().z() - reach > options.near && d.center().z() > reach &&
         std::isfinite(cloud.opacity[i]) && cloud.color.col(i).allFinite() &&
         (options.kernel == SurfelKernel::kGaussian || cloud.skew.col(i).allFinite());
}

// Box of the image of the disk of radius `cutoff`, joined with that of the smallest footprint;
// false if no pixel is in it. The tangents of the conic, as in 2DGS.
bool set_box(const Disk& d, const Camera& camera, const SurfelOptions& options,
             SurfelFootprint* f) {
  const double radius2 = options.cutoff * options.cutoff;
  const Eigen::RowVector3d w = d.H.row(2);
  const Eigen::RowVector3d weight = Eigen::RowVector3d(radius2, radius2, -1) /
                                    (radius2 * (w[0] * w[0] + w[1] * w[1]) - w[2] * w[2]);
  const auto clip = [&](const Eigen::RowVector3d& row, double mean, int size, int* first,
                        int* last) {
    const double middle = (weight.array() * row.array() * w.array()).sum();
    const double square = middle * middle - (weight.array() * row.array().square()).sum();
    const double half = std::sqrt(std::max(square, 0.0)),
                 least = options.cutoff * options.lowpass_px;
    const double low = std::min(middle - half, mean - least);
    const double high = std::max(middle + half, mean + least);
    if (!(high >= 0 && low <= size - 1)) return false;
    *first = int(std::ceil(std::max(low, 0.0)));
    *last = int(std::floor(std::min(high, size - 1.0)));
    return *first <= *last;
  };
  return clip(camera.fx * d.H.row(0) + camera.cx * w, f->mean.x(), camera.width, &f->x0, &f->x1) &&
         clip(camera.fy * d.H.row(1) + camera.cy * w, f->mean.y(), camera.height, &f->y0, &f->y1);
}

bool seen_edge_on(const Disk& d, const SurfelOptions& options) {
  return !(std::abs(d.axes.col(2).dot(d.center())) > options.min_cosine * d.center().norm());
}

// The plane's part of the footprint.
void set_plane(const Disk& d, const SurfelOptions& options, const Profile& profile,
               SurfelFootprint* f) {
  f->a00 = f->a01 = f->a10 = f->a11 = f->b0 = f->b1 = 0;
  f->facing = -1;
  f->rim.setZero();
  if (seen_edge_on(d, options)) return;
  const Eigen::Matrix3d B = d.center().z() * d.H.inverse() * d.rays;
  // Beyond this floats overflow; such a surfel is no more than a point.
  if (!B.allFinite() || !(B.cwiseAbs().maxCoeff() < 1e12)) return;
  f->a00 = float(profile.whiten * B(0, 0));
  f->a01 = float(profile.whiten * B(0, 1));
  f->a10 = float(profile.whiten * B(1, 0));
  f->a11 = float(profile.whiten * B(1, 1));
  f->b0 = float(B(2, 0));
  f->b1 = float(B(2, 1));
  f->facing = 1;
  const Eigen::Vector3d square(1, 1, -options.cutoff * options.cutoff);
  f->rim = B.transpose() * square.asDiagonal() * B;
}

bool project(const SurfelCloud& cloud, int i, const View& view, const SurfelOptions& options,
             const Profile& profile, SurfelFootprint* f) {
  const Disk d = disk_of(cloud, i, view);
  if (!is_drawable(cloud, i, d, options)) return false;
  f->surfel = i;
  f->mean = view.camera.project(d.center());
  if (!set_box(d, view.camera, options, f)) return false;
  set_plane(d, options, profile, f);
  f->depth = float(d.center().z());
  f->opacity = float(sigmoid(cloud.opacity[i]) * profile.scale);
  f->skew_u = f->skew_v = 0;
  if (options.kernel == SurfelKernel::kSkewNormal) {
    const Eigen::Vector2d latent = cloud.skew.col(i);
    double shrink, slope;
    tanh_over(latent.norm(), &shrink, &slope);
    const Eigen::Vector2d skew = options.max_skew * shrink / profile.whiten * latent;
    f->skew_u = float(skew[0]);
    f->skew_v = float(skew[1]);
  }
  for (int k = 0; k < 3; ++k) {
    f->color[k] = float(cloud.color(k, i));
    f->normal[k] = float(d.faces_away() ? -d.axes(k, 2) : d.axes(k, 2));
  }
  return true;
}

// Gradient by a quaternion of any length, given that by its rotation matrix.
Eigen::Vector4d quaternion_backward(const Eigen::Vector4d& q, double length,
                                    const Eigen::Matrix3d& G) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double x_yz = G(2, 1) - G(1, 2), x_zx = G(0, 2) - G(2, 0), x_xy = G(1, 0) - G(0, 1);
  const double s_yz = G(2, 1) + G(1, 2), s_zx = G(0, 2) + G(2, 0), s_xy = G(1, 0) + G(0, 1);
  const Eigen::Vector4d by_unit =
      2 * Eigen::Vector4d(x * x_yz + y * x_zx + z * x_xy,
                          w * x_yz + y * s_xy + z * s_zx - 2 * x * (G(1, 1) + G(2, 2)),
                          w * x_zx + x * s_xy + z * s_yz - 2 * y * (G(0, 0) + G(2, 2)),
                          w * x_xy + x * s_zx + y * s_yz - 2 * z * (G(0, 0) + G(1, 1)));
  return (by_unit - q * q.dot(by_unit)) / length;
}

// Gradient by H, given that by the scaled plane: with B = z H^-1 rays, d(H^-1) = -H^-1 dH H^-1. The
// factors z and rays only scale and shift what is divided out: constants.
Eigen::Matrix3d plane_backward(const Disk& d, const Profile& profile,
                               const Eigen::Matrix3d& by_plane) {
  const Eigen::Vector3d whiten(profile.whiten, profile.whiten, 1);
  const Eigen::Matrix3d back = d.H.inverse().transpose();
  const Eigen::Matrix3d by_inverse =
      d.center().z() * whiten.asDiagonal() * by_plane * d.rays.transpose();
  return -back * by_inverse * back;
}

Eigen::Vector2d skew_backward(const Eigen::Vector2d& latent, const SurfelOptions& options,
                              const Profile& profile, const Eigen::Vector2d& by_skew) {
  double shrink, slope;
  tanh_over(latent.norm(), &shrink, &slope);
  return options.max_skew / profile.whiten *
         (shrink * by_skew + slope * latent.dot(by_skew) * latent);
}

}  // namespace

std::vector<SurfelFootprint> project_surfels(const SurfelCloud& cloud, const View& view,
                                             const SurfelOptions& options) {
  const Profile profile(options.cutoff);
  const int count = cloud.size();
  std::vector<SurfelFootprint> all(count);
  std::vector<double> depths(count);
  std::vector<char> drawn(count);
  parallel_for(count, 256, [&](int i) {
    drawn[i] = project(cloud, i, view, options, profile, &all[i]);
    depths[i] = view.cam_from_world.rotation.row(2).dot(cloud.center.col(i));
  });
  std::vector<int> order;
  order.reserve(count);
  for (int i = 0; i < count; ++i) {
    if (drawn[i]) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return depths[i] < depths[j] || (depths[i] == depths[j] && i < j);
  });
  std::vector<SurfelFootprint> footprints;
  footprints.reserve(order.size());
  for (const int i : order) footprints.push_back(all[i]);
  return footprints;
}

void project_surfel_backward(const SurfelCloud& cloud, const View& view,
                             const SurfelOptions& options, const SurfelFootprint& f,
                             const SurfelFootprintGradient& g, SurfelGradient* gradient) {
  const Profile profile(options.cutoff);
  const int i = f.surfel;
  const Disk d = disk_of(cloud, i, view);
  const Eigen::Matrix3d& world = view.cam_from_world.rotation;
  Eigen::Matrix3d by_H = Eigen::Matrix3d::Zero();
  if (f.facing > 0) by_H = plane_backward(d, profile, g.plane);
  by_H.col(2) += view.camera.project_jacobian(d.center()).transpose() * g.mean;
  by_H(2, 2) += g.depth;
  gradient->center.col(i) = world.transpose() * by_H.col(2);
  gradient->log_scale.col(i) << by_H.col(0).dot(d.H.col(0)), by_H.col(1).dot(d.H.col(1));
  Eigen::Matrix3d by_axes;
  by_axes << d.scale[0] * by_H.col(0), d.scale[1] * by_H.col(1),
      d.faces_away() ? -g.normal : g.normal;
  gradient->rotation.col(i) =
      quaternion_backward(d.quaternion, d.length, world.transpose() * by_axes);
  const double opacity = sigmoid(cloud.opacity[i]);
  gradient->opacity[i] = g.opacity * profile.scale * opacity * (1 - opacity);
  gradient->color.col(i) = g.color;
  if (options.kernel == SurfelKernel::kSkewNormal) {
    gradient->skew.col(i) = skew_backward(cloud.skew.col(i), options, profile, g.skew);
  }
  const Eigen::Matrix<double, 3, 2> plane =
      (Eigen::Matrix<double, 3, 2>() << f.a00, f.a01, f.a10, f.a11, f.b0, f.b1).finished();
  gradient->in_image.col(i) = g.mean - plane.transpose() * g.plane.col(2);
  gradient->in_image_abs.col(i) = g.in_image_abs;
  gradient->splitting.col(i) = g.splitting;
  gradient->weight[i] = g.weight;
}

}  // namespace sketchsplat

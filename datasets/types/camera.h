// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace sketchsplat {

/// Pinhole camera without distortion. Axes: x right, y down, z forward. Pixel centres are integers.
struct Camera {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]

  /// Pixel of a point with z > 0, in camera coordinates.
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_cam) const {
    return {fx * point_in_cam.x() / point_in_cam.z() + cx,
            fy * point_in_cam.y() / point_in_cam.z() + cy};
  }

  /// d(pixel) / d(point_in_cam), 2 x 3.
  Eigen::Matrix<double, 2, 3> project_jacobian(const Eigen::Vector3d& point_in_cam) const {
    const double iz = 1.0 / point_in_cam.z();
    Eigen::Matrix<double, 2, 3> J;
    J << fx * iz, 0, -fx * point_in_cam.x() * iz * iz,  //
        0, fy * iz, -fy * point_in_cam.y() * iz * iz;
    return J;
  }

  /// Direction in camera coordinates with z = 1 of the ray through a pixel.
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1.0};
  }

  /// Of the part of the image whose top-left pixel is (x0, y0).
  Camera cut(int x0, int y0, int part_width, int part_height) const {
    return {part_width, part_height, fx, fy, cx - x0, cy - y0};
  }

  /// Of the picture that read_picture makes with this denominator: blocks of pixels become one.
  Camera shrunk(int denominator) const {
    const double d = denominator;
    return {(width + denominator - 1) / denominator,
            (height + denominator - 1) / denominator,
            fx / d,
            fy / d,
            (cx + 0.5) / d - 0.5,
            (cy + 0.5) / d - 0.5};
  }

  /// The other way round: of the picture of this size that was made `factor` times smaller.
  Camera enlarged(int factor, int full_width, int full_height) const {
    const double d = factor;
    return {full_width, full_height, d * fx, d * fy, d * (cx + 0.5) - 0.5, d * (cy + 0.5) - 0.5};
  }

  bool contains(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= width - 1 && pixel.y() <= height - 1;
  }
};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/types/camera.h"
#include "datasets/types/image.h"
#include "datasets/types/lens.h"
#include "datasets/types/pose.h"

namespace sketchsplat {

/// One calibrated image. Edgels, and everything that is computed from them, live in the pixels of
/// the ideal pinhole `camera`; what is read from or drawn on the image itself, in the pixels where
/// `lens` puts them. Without distortion these are the same.
struct View {
  std::string name;        ///< file name of the image, as outputs are called
  std::string image_path;  ///< where to read it
  std::string mask_path;   ///< file that is white where the object is; empty if there is none
  bool mask_over_alpha = false;  ///< the mask counts even if the image has an alpha channel
  Camera camera;  ///< width and height are filled from the image if the scene file is silent
  Pose cam_from_world;
  Lens lens;
  /// The image, from any thread, if it is no file; `image_path` is a name then.
  std::function<Picture()> make_picture;
  /// Told of every picture of the view that is read, whole or reduced, from any thread.
  std::function<void(const Picture&)> when_read;

  Eigen::Vector3d center_in_world() const {
    return -(cam_from_world.rotation.transpose() * cam_from_world.translation);
  }
  /// Ideal pixel of a world point; `depth` (z in the camera) may be <= 0, then the pixel means
  /// nothing.
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_world, double* depth) const {
    const Eigen::Vector3d p = cam_from_world * point_in_world;
    *depth = p.z();
    return camera.project(p);
  }

  /// Pixel of the image where the lens draws what is at an ideal pixel, and d(image) / d(ideal) if
  /// that is asked for; false if the lens draws it nowhere. The pixel may lie outside the image.
  bool image_pixel(const Eigen::Vector2d& ideal, Eigen::Vector2d* image,
                   Eigen::Matrix2d* jacobian = nullptr) const {
    if (jacobian) jacobian->setIdentity();
    *image = ideal;
    if (lens.is_identity()) return true;
    const Eigen::Vector2d xy = camera.ray(ideal).head<2>();
    if (!lens.draws(xy)) return false;
    *image = pixel_of(lens.distort(xy));
    if (jacobian) *jacobian = pixel_jacobian(xy);
    return true;
  }
  /// The other way round, with the same jacobian; false if no ideal pixel is drawn there.
  bool ideal_pixel(const Eigen::Vector2d& image, Eigen::Vector2d* ideal,
                   Eigen::Matrix2d* jacobian = nullptr) const {
    if (jacobian) jacobian->setIdentity();
    *ideal = image;
    if (lens.is_identity()) return true;
    Eigen::Vector2d xy;
    if (!lens.undistort(camera.ray(image).head<2>(), &xy)) return false;
    *ideal = pixel_of(xy);
    if (jacobian) *jacobian = pixel_jacobian(xy);
    return true;
  }

 private:
  Eigen::Vector2d pixel_of(const Eigen::Vector2d& xy) const {
    return camera.project({xy.x(), xy.y(), 1});
  }
  Eigen::Matrix2d pixel_jacobian(const Eigen::Vector2d& xy) const {
    Eigen::Matrix2d J = lens.jacobian(xy);
    J(0, 1) *= camera.fx / camera.fy;
    J(1, 0) *= camera.fy / camera.fx;
    return J;
  }
};

}  // namespace sketchsplat

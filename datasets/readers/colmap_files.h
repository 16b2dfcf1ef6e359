// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/readers/colmap_model.h"

namespace sketchsplat {

/// One of COLMAP's camera models (src/colmap/sensor/models.h).
struct ColmapCameraModel {
  int id;
  const char* name;
  int parameters;
  bool known;       ///< by Lens
  LensModel model;  ///< of known ones
};

/// By the id in binary files or the name in text files; null if there is none.
const ColmapCameraModel* find_camera_model(int id);
const ColmapCameraModel* find_camera_model(const std::string& name);

/// From the parameters in COLMAP's order; as many as the model has.
ColmapCamera make_colmap_camera(const ColmapCameraModel& model, const ImageSize& size,
                                const std::vector<double>& parameters);

/// From a quaternion w, x, y, z of any length.
Pose make_colmap_pose(const Eigen::Vector4d& quaternion, const Eigen::Vector3d& translation);

// The files of one kind; `path` is that of the file. All throw InputError.
std::map<std::uint32_t, ColmapCamera> read_cameras_binary(const std::string& path);
std::vector<ColmapImage> read_images_binary(const std::string& path);
std::vector<ColmapPoint> read_points_binary(const std::string& path);
std::uint64_t count_images_binary(const std::string& path);
std::map<std::uint32_t, ColmapCamera> read_cameras_text(const std::string& path);
std::vector<ColmapImage> read_images_text(const std::string& path);
std::vector<ColmapPoint> read_points_text(const std::string& path);

}  // namespace sketchsplat

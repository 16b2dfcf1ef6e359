// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "datasets/io/image_io.h"
#include "datasets/types/lens.h"
#include "datasets/types/pose.h"

namespace sketchsplat {

/// A camera as COLMAP describes it: the centre of the top-left pixel is (0.5, 0.5).
struct ColmapCamera {
  ImageSize size;                         ///< [px]
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
  LensModel model = LensModel::kPinhole;
  Lens::Terms terms;
  std::string unknown;  ///< name of a model that Lens does not know; then the rest means nothing
};

struct ColmapImage {
  std::uint32_t id = 0, camera = 0;
  std::string name;  ///< of its file, with folders
  /// The rotation is zero if the file's quaternion is; numbers that are not finite stay so.
  Pose cam_from_world;
  std::vector<Eigen::Vector2d> features;  ///< [px] points of the image, its corner is (0, 0)
};

struct ColmapPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  struct Element {
    std::uint32_t image = 0, feature = 0;  ///< id of the image, index of its feature
  };
  std::vector<Element> track;  ///< as the file has it
};

/// What the files cameras, images and points3D of a folder say (COLMAP's doc/format.rst); rigs and
/// frames, which versions from 3.12 on add, only repeat it.
struct ColmapModel {
  std::string images_path;                        ///< the file that the images came from
  std::map<std::uint32_t, ColmapCamera> cameras;  ///< by id
  std::vector<ColmapImage> images;                ///< by id, ascending
  std::vector<ColmapPoint> points;
};

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

/// Are cameras and images there, both as .bin or both as .txt?
bool has_colmap_model(const std::string& folder);

/// Number of images in a model, without reading it all. Throws InputError.
std::uint64_t count_colmap_images(const std::string& folder);

/// Reads a model: .bin where both exist, as COLMAP does. points3D may be missing. Throws InputError
/// (truncated files, counts that the file cannot hold, words for numbers).
ColmapModel read_colmap_model(const std::string& folder);

}  // namespace sketchsplat

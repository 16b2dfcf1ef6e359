// SPDX-License-Identifier: MIT
#include "datasets/readers/colmap_model.h"

namespace sketchsplat {
namespace {

constexpr LensModel kNone = LensModel::kPinhole;
constexpr ColmapCameraModel kCameraModels[] = {
    {0, "SIMPLE_PINHOLE", 3, true, LensModel::kPinhole},
    {1, "PINHOLE", 4, true, LensModel::kPinhole},
    {2, "SIMPLE_RADIAL", 4, true, LensModel::kSimpleRadial},
    {3, "RADIAL", 5, true, LensModel::kRadial},
    {4, "OPENCV", 8, true, LensModel::kOpencv},
    {5, "OPENCV_FISHEYE", 8, true, LensModel::kOpencvFisheye},
    {6, "FULL_OPENCV", 12, true, LensModel::kFullOpencv},
    {7, "FOV", 5, false, kNone},
    {8, "SIMPLE_RADIAL_FISHEYE", 4, false, kNone},
    {9, "RADIAL_FISHEYE", 5, false, kNone},
    {10, "THIN_PRISM_FISHEYE", 12, false, kNone},
};

}  // namespace

const ColmapCameraModel* find_camera_model(int id) {
  for (const ColmapCameraModel& model : kCameraModels)
    if (model.id == id) return &model;
  return nullptr;
}

const ColmapCameraModel* find_camera_model(const std::string& name) {
  for (const ColmapCameraModel& model : kCameraModels)
    if (model.name == name) return &model;
  return nullptr;
}

ColmapCamera make_colmap_camera(const ColmapCameraModel& model, const ImageSize& size,
                                const std::vector<double>& p) {
  ColmapCamera camera;
  camera.size = size;
  if (!model.known) {
    camera.unknown = model.name;
    return camera;
  }
  const std::string name = model.name;
  // The simple ones have one focal length.
  const bool one_focal = name == "SIMPLE_PINHOLE" || name == "SIMPLE_RADIAL" || name == "RADIAL";
  const size_t c = one_focal ? 1 : 2;
  camera.fx = p[0], camera.fy = p[c - 1];
  camera.cx = p[c], camera.cy = p[c + 1];
  camera.model = model.model;
  Lens::Terms& k = camera.terms;
  double* const plain[] = {&k.k1, &k.k2, &k.p1, &k.p2, &k.k3, &k.k4, &k.k5, &k.k6};
  double* const fisheye[] = {&k.k1, &k.k2, &k.k3, &k.k4};
  double* const* const terms = model.model == LensModel::kOpencvFisheye ? fisheye : plain;
  for (size_t i = c + 2; i < p.size(); ++i) *terms[i - c - 2] = p[i];
  return camera;
}

Pose make_colmap_pose(const Eigen::Vector4d& quaternion, const Eigen::Vector3d& translation) {
  Pose pose;
  pose.translation = translation;
  const double norm = quaternion.norm();
  if (norm == 0) {
    pose.rotation.setZero();
    return pose;
  }
  const double w = quaternion[0] / norm, x = quaternion[1] / norm;
  const double y = quaternion[2] / norm, z = quaternion[3] / norm;
  pose.rotation << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),               //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return pose;
}

}  // namespace sketchsplat

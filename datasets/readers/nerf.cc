// SPDX-License-Identifier: MIT
// NeRF-synthetic's layout (transforms_train.json, images beside it) and NEF's variant of it.
#include <cmath>
#include <filesystem>

#include "datasets/readers/format.h"
#include "datasets/readers/frame.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

std::string scene_file(const std::string& folder) {
  return (fs::path(folder) / "transforms_train.json").string();
}

bool is_marked(const std::string& folder) {
  std::error_code none;
  return fs::exists(scene_file(folder), none);
}

/// NEF names ./train/<k>_colors, where PiDiNet's edge maps are, and keeps the pictures in
/// train_img/.
void find_picture_of(const SceneSource& source, Frame* frame) {
  const fs::path named = fs::path(frame->name).lexically_normal();
  const fs::path pictures = fs::path(source.folder) / (named.parent_path().string() + "_img");
  std::error_code none;
  if (!named.parent_path().empty() && may_reach(source, pictures.string()) &&
      fs::is_directory(pictures, none)) {
    find_image_of(source, pictures.string(), named.filename().string(), frame);
  } else {
    find_image_of(source, source.folder, named.string(), frame);
  }
}

Eigen::Matrix3d intrinsics_from_angle(double angle_x_rad, const ImageSize& size) {
  const double focal = 0.5 * size.width / std::tan(0.5 * angle_x_rad);
  Eigen::Matrix3d K;
  K << focal, 0, 0.5 * (size.width - 1), 0, focal, 0.5 * (size.height - 1), 0, 0, 1;
  return K;
}

/// Of the frame itself or of all frames; a matrix before an angle.
Eigen::Matrix3d intrinsics_of(const JsonValue& root, const JsonValue& entry,
                              const ImageSize& size) {
  for (const JsonValue* owner : {&entry, &root}) {
    if (owner->has("camera_intrinsics")) return (*owner)["camera_intrinsics"].matrix(3, 3);
  }
  const JsonValue& owner = entry.has("camera_angle_x") ? entry : root;
  return intrinsics_from_angle(owner["camera_angle_x"].number(), size);
}

void read(const SceneSource& source, Scene* scene) {
  const std::string& folder = source.folder;
  const JsonValue root = load_json(scene_file(folder));
  for (const JsonValue& entry : frames_of(root)) {
    Frame frame;
    frame.name = entry["file_path"].text();
    find_picture_of(source, &frame);
    frame.world_from_cam = entry["transform_matrix"].matrix(4, 4);
    frame.world_from_cam.middleCols<2>(1) *= -1;  // OpenGL: y up, z backward
    if (!frame.image_path.empty()) complete_size(&frame);
    frame.intrinsics = intrinsics_of(root, entry, frame.size);
    add_frame(frame, scene);
  }
}

}  // namespace

const SceneFormat kNerfFormat = {"nerf", "transforms_train.json", is_marked, read};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// NeRF-synthetic's layout (transforms_train.json, images beside it), NEF's variant of it, and
// nerfstudio's transforms.json (its docs/quickstart/data_conventions.md), which instant-ngp writes,
// too. `applied_transform` says how an older world was turned into that of the file; every
// transform_matrix holds it already, so that the world here is the file's and it is not looked at.
// Neither are ply_file_path and whatever else is there.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "datasets/readers/format.h"
#include "datasets/readers/frame.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

Eigen::Matrix4d opengl_pose(const JsonValue& entry) {
  Eigen::Matrix4d world_from_cam = entry["transform_matrix"].matrix(4, 4);
  world_from_cam.middleCols<2>(1) *= -1;  // OpenGL: y up, z backward
  return world_from_cam;
}

double focal_length(double angle_rad, int size) { return 0.5 * size / std::tan(0.5 * angle_rad); }

/// Values of a frame, or else of the whole file.
struct Values {
  const JsonValue &root, &entry;

  bool has(const std::string& key) const { return entry.has(key) || root.has(key); }
  JsonValue operator[](const std::string& key) const {
    return entry.has(key) ? entry[key] : root[key];
  }
  double number(const std::string& key, double otherwise) const {
    return has(key) ? (*this)[key].number() : otherwise;
  }
};

// ------------------------------------------------------------------------------- NeRF and NEF

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

/// A matrix before an angle.
Eigen::Matrix3d nerf_intrinsics(const Values& values, const ImageSize& size) {
  if (values.has("camera_intrinsics")) return values["camera_intrinsics"].matrix(3, 3);
  const double focal = focal_length(values["camera_angle_x"].number(), size.width);
  Eigen::Matrix3d K;
  K << focal, 0, 0.5 * (size.width - 1), 0, focal, 0.5 * (size.height - 1), 0, 0, 1;
  return K;
}

void read_nerf(const SceneSource& source, const JsonValue& root, Scene* scene) {
  for (const JsonValue& entry : frames_of(root)) {
    Frame frame;
    frame.name = entry["file_path"].text();
    find_picture_of(source, &frame);
    frame.world_from_cam = opengl_pose(entry);
    if (!frame.image_path.empty()) complete_size(&frame);
    frame.intrinsics = nerf_intrinsics({root, entry}, frame.size);
    add_frame(frame, scene);
  }
}

// ----------------------------------------------------------------------------------- nerfstudio

ImageSize size_of(const Values& values) {
  if (!values.has("w") || !values.has("h")) return {};
  return {values["w"].positive_integer(), values["h"].positive_integer()};
}

/// The file's cx and cy are COLMAP's: the centre of the top-left pixel is (0.5, 0.5).
Eigen::Matrix3d nerfstudio_intrinsics(const Values& values, const ImageSize& size) {
  const bool angle_alone = !values.has("fl_x") && values.has("camera_angle_x");
  const double fx = angle_alone ? focal_length(values["camera_angle_x"].number(), size.width)
                                : values["fl_x"].number();
  double fy = values.number("fl_y", fx);
  if (!values.has("fl_y") && values.has("camera_angle_y"))
    fy = focal_length(values["camera_angle_y"].number(), size.height);
  Eigen::Matrix3d K;
  K << fx, 0, values.number("cx", 0.5 * size.width) - 0.5,  //
      0, fy, values.number("cy", 0.5 * size.height) - 0.5,  //
      0, 0, 1;
  return K;
}

/// nerfstudio calls every perspective camera by one of COLMAP's names and reads k1, k2, k3, p1, p2
/// whatever it is; a fisheye has k1 to k4. Its own undistortion refuses k4 of a perspective one.
Lens lens_of(const Values& values) {
  const std::string name = values.has("camera_model") ? values["camera_model"].text() : "OPENCV";
  Lens::Terms k;
  for (const auto& [key, term] : {std::pair{"k1", &k.k1},
                                  {"k2", &k.k2},
                                  {"k3", &k.k3},
                                  {"k4", &k.k4},
                                  {"p1", &k.p1},
                                  {"p2", &k.p2}})
    *term = values.number(key, 0);
  if (name == "OPENCV_FISHEYE") {
    k.p1 = k.p2 = 0;
    return {LensModel::kOpencvFisheye, k};
  }
  const char* perspective[] = {"OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL"};
  if (std::none_of(std::begin(perspective), std::end(perspective),
                   [&](const char* known) { return name == known; }))
    values["camera_model"].complain(
        "OPENCV, OPENCV_FISHEYE, PINHOLE, SIMPLE_PINHOLE, SIMPLE_RADIAL or RADIAL (colmap "
        "image_undistorter turns other models into PINHOLE)");
  if (k.k4 != 0) values["k4"].complain("0 with a camera model that is no fisheye");
  return {LensModel::kFullOpencv, k};
}

/// Images beside those of the frames that are none of them.
void warn_of_images_without_pose(const std::string& folder, const std::vector<std::string>& used,
                                 Scene* scene) {
  std::map<fs::path, std::vector<std::string>> by_folder;
  for (const std::string& path : used)
    by_folder[fs::path(path).parent_path()].push_back(fs::path(path).filename().string());
  std::vector<std::string> without;
  for (auto& [place, names] : by_folder) {
    if (place.lexically_relative(folder) == ".") continue;  // masks and results may lie there, too
    std::sort(names.begin(), names.end());
    for (const std::string& name : list_images(place.string(), false))
      if (!std::binary_search(names.begin(), names.end(), name))
        without.push_back((place.lexically_relative(folder) / name).string());
  }
  warn_of("images without a pose", without, scene);
}

void read_nerfstudio(const SceneSource& source, const JsonValue& root, Scene* scene) {
  const std::string& folder = source.folder;
  std::vector<std::string> used, without_file, without_mask;
  for (const JsonValue& entry : frames_of(root)) {
    const Values values{root, entry};
    Frame frame;
    frame.name = entry["file_path"].text();
    find_image_of(source, folder, frame.name, &frame);
    frame.world_from_cam = opengl_pose(entry);
    frame.size = size_of(values);
    if (!frame.image_path.empty()) complete_size(&frame);
    frame.intrinsics = nerfstudio_intrinsics(values, frame.size);
    frame.lens = lens_of(values);
    if (entry.has("mask_path")) {
      const std::string mask = entry["mask_path"].text();
      if (may_reach(source, (fs::path(folder) / mask).string()))
        frame.mask_path = find_image(folder, mask);
      if (frame.mask_path.empty()) without_mask.push_back(mask);
    }
    if (frame.image_path.empty() && !frame.is_outside) {
      without_file.push_back(frame.name);
      continue;
    }
    if (add_frame(frame, scene) || !frame.is_outside) used.push_back(frame.image_path);
  }
  warn_of("poses without an image", without_file, scene);
  warn_of_images_without_pose((fs::path(folder) / "").lexically_normal().string(), used, scene);
  warn_of("masks that are missing or outside of the scene", without_mask, scene);
}

}  // namespace

const SceneFormat kNerfFormat = {"nerf", "transforms_train.json", read_nerf};
const SceneFormat kNerfstudioFormat = {"nerfstudio", "transforms.json", read_nerfstudio};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// COLMAP's folders: a model in sparse/0, sparse or the folder itself; images/; masks/.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>
#include <utility>

#include "datasets/readers/colmap_model.h"
#include "datasets/readers/format.h"
#include "datasets/readers/frame.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

bool has_model_of_colmap(const std::string& folder) {
  std::error_code none;
  return fs::is_directory(folder + "/sparse", none) || fs::exists(folder + "/cameras.bin", none) ||
         fs::exists(folder + "/cameras.txt", none);
}

/// Models in numbered folders: COLMAP's mapper makes a new one where it cannot go on.
std::vector<std::string> numbered_models(const std::string& folder) {
  std::vector<int> numbers;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    const bool number = name.size() <= 6 && std::all_of(name.begin(), name.end(), [](char c) {
                          return c >= '0' && c <= '9';
                        });
    if (number && has_colmap_model(entry.path().string())) numbers.push_back(std::stoi(name));
  }
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::string> folders;
  for (const int n : numbers) folders.push_back(folder + "/" + std::to_string(n));
  return folders;
}

/// The folder of the model to use: the one with the most images if there are several.
std::string find_model(const std::string& folder, Scene* scene) {
  const std::vector<std::string> models = numbered_models(folder + "/sparse");
  if (models.empty()) {
    for (const std::string& place : {folder + "/sparse", folder})
      if (has_colmap_model(place)) return place;
    throw InputError(folder,
                     "a model of COLMAP (cameras and images, .bin or .txt) in sparse/0, "
                     "sparse or beside it",
                     "none");
  }
  if (models.size() == 1) return models[0];
  std::vector<std::uint64_t> sizes;
  for (const std::string& model : models) sizes.push_back(count_colmap_images(model));
  const size_t best = size_t(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  scene->warnings.push_back(std::to_string(models.size()) +
                            " models that do not meet: " + models[best] +
                            " is used, it has most images (" + std::to_string(sizes[best]) + ")");
  return models[best];
}

/// A path of its own where an image may lie, or an empty one.
std::string image_file(const std::string& folder, const std::string& name) {
  const std::string path = (fs::path(folder) / name).lexically_normal().string();
  std::error_code none;
  return fs::is_regular_file(path, none) ? path : "";
}

Frame make_frame(const ColmapImage& image, const ColmapCamera& camera) {
  Frame frame;
  frame.name = image.name;
  frame.size = camera.size;
  // COLMAP's pixel centres are at + 0.5, ours at integers.
  frame.intrinsics << camera.fx, 0, camera.cx - 0.5, 0, camera.fy, camera.cy - 0.5, 0, 0, 1;
  const Eigen::Matrix3d back = image.cam_from_world.rotation.transpose();
  frame.world_from_cam.topLeftCorner<3, 3>() = back;
  frame.world_from_cam.topRightCorner<3, 1>() = -(back * image.cam_from_world.translation);
  frame.lens = Lens(camera.model, camera.terms);
  return frame;
}

// A view and the features of its image, by the image's id.
using UsedImages =
    std::unordered_map<std::uint32_t, std::pair<int, const std::vector<Eigen::Vector2d>*>>;

void add_points(const ColmapModel& model, const UsedImages& used, Scene* scene) {
  for (const ColmapPoint& point : model.points) {
    if (!point.position.allFinite()) continue;
    ScenePoint out;
    out.position = point.position;
    for (const auto& [image, feature] : point.track) {
      const auto found = used.find(image);
      if (found == used.end()) continue;
      const auto& [view, features] = found->second;
      Eigen::Vector2d pixel = Eigen::Vector2d::Constant(NAN);
      if (feature < features->size()) pixel = (*features)[feature].array() - 0.5;
      out.sights.push_back({view, pixel});
    }
    std::stable_sort(out.sights.begin(), out.sights.end(),
                     [](const PointSight& a, const PointSight& b) { return a.view < b.view; });
    const auto repeated =
        std::unique(out.sights.begin(), out.sights.end(),
                    [](const PointSight& a, const PointSight& b) { return a.view == b.view; });
    out.sights.erase(repeated, out.sights.end());
    if (!out.sights.empty()) scene->points.push_back(std::move(out));
  }
}

void warn_of_images_without_pose(const std::string& images, bool deep, const ColmapModel& model,
                                 Scene* scene) {
  std::vector<std::string> posed, without;
  for (const ColmapImage& image : model.images)
    posed.push_back(fs::path(image.name).lexically_normal().string());
  std::sort(posed.begin(), posed.end());
  for (const std::string& name : list_images(images, deep))
    if (!std::binary_search(posed.begin(), posed.end(), name)) without.push_back(name);
  warn_of("images without a pose", without, scene);
}

void read_colmap(const SceneSource& source, Scene* scene) {
  const std::string& folder = source.folder;
  const ColmapModel model = read_colmap_model(find_model(folder, scene));
  check_frame_count(model.images_path, model.images.size());
  std::error_code none;
  const bool inside = fs::is_directory(folder + "/images", none);
  const std::string images = inside ? folder + "/images" : folder;
  UsedImages used;
  std::vector<std::string> without_file;
  for (const ColmapImage& image : model.images) {
    const auto camera = model.cameras.find(image.camera);
    if (camera == model.cameras.end())
      throw InputError(model.images_path, "a camera of " + image.name + " in the file of cameras",
                       "no camera " + std::to_string(image.camera));
    if (!camera->second.unknown.empty())
      throw InputError(model.images_path,
                       "SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV or "
                       "OPENCV_FISHEYE as the camera model of " +
                           image.name + " (colmap image_undistorter turns the others into PINHOLE)",
                       camera->second.unknown);
    Frame frame = make_frame(image, camera->second);
    frame.is_outside = !may_reach(source, (fs::path(images) / image.name).string());
    if (!frame.is_outside) {
      frame.image_path = image_file(images, image.name);
      frame.mask_path = find_mask(folder + "/masks", image.name);
    }
    if (frame.image_path.empty() && !frame.is_outside) {
      without_file.push_back(image.name);
    } else if (add_frame(frame, scene)) {
      used[image.id] = {int(scene->views.size()) - 1, &image.features};
    }
  }
  warn_of("poses without an image", without_file, scene);
  warn_of_images_without_pose(images, inside, model, scene);
  add_points(model, used, scene);
}

}  // namespace

const SceneFormat kColmapFormat = {"colmap", "sparse/ or cameras.{bin,txt}", nullptr,
                                   has_model_of_colmap, read_colmap};

}  // namespace sketchsplat

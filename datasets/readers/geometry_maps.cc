// SPDX-License-Identifier: MIT
#include "datasets/types/geometry_maps.h"

#include <filesystem>

#include "datasets/io/float_image_io.h"
#include "datasets/io/normal_map.h"
#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

std::string path_of(const std::string& folder, const View& view, const std::string& ending) {
  const std::string path = file_of_view(folder, view, ending);
  if (path.empty()) throw InputError(folder, "a map of " + view.name + " (" + ending + ")", "none");
  return path;
}

void check_size(const std::string& path, const Image<float>& map, const Camera& camera) {
  if (map.width == camera.width && map.height == camera.height) return;
  const auto text = [](int w, int h) { return std::to_string(w) + " x " + std::to_string(h); };
  throw InputError(path, "a map of " + text(camera.width, camera.height) + " px",
                   text(map.width, map.height));
}

// The channels of an EXR file, as many as are wanted and all of the view's size.
std::vector<FloatChannel> read_channels(const std::string& path, size_t count,
                                        const Camera& camera) {
  std::vector<FloatChannel> channels = read_exr(path);
  if (channels.size() < count)
    throw InputError(path, std::to_string(count) + " channels", std::to_string(channels.size()));
  for (const FloatChannel& channel : channels) check_size(path, channel.values, camera);
  return channels;
}

}  // namespace

std::string file_of_view(const std::string& folder, const View& view, const std::string& ending) {
  const std::string colours = "_colors";
  const fs::path image = fs::path(view.name).replace_extension();
  std::string plain = image.string();
  if (plain.size() > colours.size() &&
      plain.compare(plain.size() - colours.size(), colours.size(), colours) == 0)
    plain.resize(plain.size() - colours.size());
  std::error_code none;
  for (const std::string& name : {image.string(), plain}) {
    const std::string path = folder + "/" + name + ending;
    if (fs::is_regular_file(path, none)) return path;
  }
  return "";
}

GeometryMaps read_geometry_maps(const Scene& scene, const View& view, const std::string& normals) {
  GeometryMaps maps;
  const std::string depth = path_of(scene.folder + "/depth", view, ".exr");
  maps.depth = std::move(read_channels(depth, 1, view.camera)[0].values);
  std::error_code none;
  const std::string inner = scene.folder + "/" + normals;
  const std::string folder = fs::is_directory(inner, none) ? inner : normals;
  const std::string path = file_of_view(folder, view, ".exr");
  if (!path.empty()) {
    std::vector<FloatChannel> channels = read_channels(path, 3, view.camera);
    for (int c = 0; c < 3; ++c) maps.normal[c] = std::move(channels[c].values);
  } else {
    maps.normal = read_normal_map(path_of(folder, view, ".png"), view.camera);
  }
  const std::string mask = file_of_view(scene.folder + "/mask", view, ".png");
  if (mask.empty()) {
    maps.alpha = Image<float>(maps.width(), maps.height());
    for (size_t i = 0; i < maps.depth.data.size(); ++i)
      maps.alpha.data[i] = maps.depth.data[i] > 0 ? 1.f : 0.f;
  } else {
    maps.alpha = read_grey(mask);
    check_size(mask, maps.alpha, view.camera);
  }
  return maps;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "datasets/readers/scene.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "datasets/readers/far_views.h"
#include "datasets/readers/format.h"
#include "datasets/readers/open_options.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

/// In the order in which open_scene looks for their markers.
constexpr const SceneFormat* kFormats[] = {&kAbcNefFormat, &kNerfFormat, &kNerfstudioFormat,
                                           &kColmapFormat};

bool is_marked(const SceneFormat& format, const std::string& folder) {
  std::error_code none;
  return format.is_marked ? format.is_marked(folder)
                          : fs::exists(fs::path(folder) / format.marker, none);
}

const SceneFormat& find_format(const std::string& folder, const std::string& name) {
  std::string known, markers;
  for (const SceneFormat* format : kFormats) {
    if (name.empty() ? is_marked(*format, folder) : name == format->name) return *format;
    known += (known.empty() ? "" : ", ") + std::string(format->name);
    markers += (markers.empty() ? "" : " or ") + std::string(format->marker);
  }
  if (name.empty())
    throw InputError(folder, "a scene folder (with " + markers + ")", "none of them");
  throw InputError(folder, "a format that is known (" + known + ")", "\"" + name + "\"");
}

bool equal_ignoring_case(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

/// Subfolders of the scene that may hold maps of the detector, in alphabetical order.
std::vector<fs::path> map_folders(const Scene& scene, const View& view,
                                  const std::string& detector) {
  std::vector<fs::path> folders;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(scene.folder, none)) {
    if (equal_ignoring_case(entry.path().filename().string(), "edge_" + detector)) {
      folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  // NEF: pictures in train_img/, PiDiNet's maps of them in train/.
  const std::string pictures = fs::path(view.image_path).parent_path().string();
  const std::string suffix = "_img";
  if (scene.format == kNerfFormat.name && equal_ignoring_case(detector, "PiDiNet") &&
      pictures.size() > suffix.size() &&
      pictures.compare(pictures.size() - suffix.size(), suffix.size(), suffix) == 0) {
    folders.push_back(pictures.substr(0, pictures.size() - suffix.size()));
  }
  return folders;
}

}  // namespace

Scene open_scene(const std::string& folder, const std::string& format) {
  return open_scene(folder, OpenOptions{format});
}

Scene open_scene(const std::string& folder, const OpenOptions& options) {
  std::error_code none;
  if (!fs::is_directory(folder, none)) {
    throw InputError(folder, "a scene folder", fs::exists(folder, none) ? "a file" : "nothing");
  }
  const SceneFormat& reader = find_format(folder, options.format);
  Scene scene;
  scene.folder = folder;
  scene.format = reader.name;
  const SceneSource source{folder, options.allow_outside};
  if (reader.read_json)
    reader.read_json(source, load_json((fs::path(folder) / reader.marker).string()), &scene);
  else
    reader.read_folder(source, &scene);
  leave_out_far_views(&scene);
  if (scene.views.empty()) {
    throw InputError(folder, "a scene with frames that can be used",
                     scene.warnings.empty() ? "no frame" : "none (" + scene.warnings.front() + ")");
  }
  return scene;
}

bool is_scene_folder(const std::string& folder, const std::string& format) {
  return std::any_of(std::begin(kFormats), std::end(kFormats), [&](const SceneFormat* known) {
    return (format.empty() || format == known->name) && is_marked(*known, folder);
  });
}

std::vector<std::string> scene_formats() {
  std::vector<std::string> names;
  for (const SceneFormat* format : kFormats) names.push_back(format->name);
  return names;
}

std::string edge_map_path(const Scene& scene, const View& view, const std::string& detector) {
  const fs::path image = fs::path(view.image_path).filename();
  std::error_code none;
  for (const fs::path& folder : map_folders(scene, view, detector)) {
    for (const fs::path& name : {image, fs::path(image).replace_extension(".png")}) {
      if (fs::is_regular_file(folder / name, none)) return (folder / name).string();
    }
  }
  return "";
}

}  // namespace sketchsplat

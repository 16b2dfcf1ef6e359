// SPDX-License-Identifier: MIT
#include "pipelines/batch/scene_input.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "datasets/readers/scene.h"
#include "datasets/truth/ground_truth.h"
#include "pipelines/base/hash.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 4;               // folders below a scene that belong to it
constexpr std::uintmax_t kLargest = 1e8;  // [bytes] of a file with cameras; else by its size

bool may_hold_cameras(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".json" || ending == ".txt" || ending == ".bin";
}

}  // namespace

std::string input_hash(const std::string& folder) {
  std::vector<std::string> lines;
  std::error_code error;
  const auto options = fs::directory_options::follow_directory_symlink |
                       fs::directory_options::skip_permission_denied;
  fs::recursive_directory_iterator entry(folder, options, error), end;
  if (error) return "";
  for (; !error && entry != end; entry.increment(error)) {
    if (entry.depth() >= kDeepest - 1) entry.disable_recursion_pending();
    std::error_code none;
    if (!entry->is_regular_file(none)) continue;
    const std::uintmax_t size = entry->file_size(none);
    std::string line =
        entry->path().lexically_relative(folder).string() + " " + std::to_string(size);
    if (may_hold_cameras(entry->path()) && size <= kLargest)
      line += " " + hash_of_file(entry->path());
    lines.push_back(line + "\n");
  }
  std::sort(lines.begin(), lines.end());
  std::string all;
  for (const std::string& line : lines) all += line;
  return hash_of(all);
}

bool has_truth(const std::string& folder) {
  try {
    return has_ground_truth(folder);
  } catch (const std::exception&) {
    return true;  // `evaluate` will say what is wrong with it
  }
}

SceneSize scene_size(const std::string& folder, const OpenOptions& options) {
  SceneSize size;
  try {
    const Scene scene = open_scene(folder, options);
    size.views = int(scene.views.size());
    for (const View& view : scene.views)
      size.pixels += double(view.camera.width) * view.camera.height;
  } catch (const std::exception&) {
    size = {};  // its worker will say why
  }
  return size;
}

}  // namespace sketchsplat

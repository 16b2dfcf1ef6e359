// SPDX-License-Identifier: MIT
#include "pipelines/batch/scene_list.h"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "pipelines/base/fields.h"
#include "pipelines/base/hash.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

// Without "." and "..", and without a slash at its end.
fs::path normal(const fs::path& path) {
  const fs::path clean = (path / ".").lexically_normal().parent_path();
  return clean.empty() ? fs::path(".") : clean;
}

fs::path full_path(const fs::path& path) { return normal(fs::absolute(path)); }

// All scene folders in and below a folder.
class Walk {
 public:
  Walk(const SceneSearch& search, std::vector<std::string>* warnings)
      : search_(search), warnings_(warnings) {
    std::error_code none;
    out_ = fs::canonical(search.out, none);
  }

  void look_into(const fs::path& folder, bool is_root = false) {
    std::error_code error;
    const fs::path place = fs::canonical(folder, error);
    if (error || (place == out_ && !is_root) || !seen_.insert(place).second) return;
    if (is_scene_folder(folder.string(), search_.format)) {
      found.push_back(folder);
      return;
    }
    std::vector<fs::path> below;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
      std::error_code none;
      if (entry->path().filename().string()[0] != '.' && entry->is_directory(none))
        below.push_back(entry->path());
    }
    if (error) warnings_->push_back(folder.string() + ": not looked into: " + error.message());
    std::sort(below.begin(), below.end());
    for (const fs::path& path : below) look_into(path);
  }

  std::vector<fs::path> found;

 private:
  const SceneSearch& search_;
  std::vector<std::string>* warnings_;
  fs::path out_;
  std::set<fs::path> seen_;
};

// The folder from which names are counted.
fs::path base_of(const SceneSearch& search) {
  const bool one = search.roots.size() == 1 && search.list.empty();
  if (one && !is_scene_folder(search.roots[0], search.format)) return full_path(search.roots[0]);
  fs::path base;
  for (const std::vector<std::string>* folders : {&search.roots, &search.list})
    for (const std::string& folder : *folders) {
      const fs::path above = full_path(folder).parent_path(), last = base.empty() ? above : base;
      base.clear();
      for (auto i = last.begin(), j = above.begin();
           i != last.end() && j != above.end() && *i == *j; ++i, ++j)
        base /= *i;
    }
  return base;
}

bool matches(const std::string& name, const std::vector<std::string>& globs) {
  const std::string last = fs::path(name).filename().string();
  return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
           return fnmatch(glob.c_str(), name.c_str(), 0) == 0 ||
                  fnmatch(glob.c_str(), last.c_str(), 0) == 0;
         });
}

// By name, so that a folder stands before what lies in it, if not always next to it.
void check_names(const std::vector<BatchScene>& scenes, const std::string& out) {
  std::set<std::string> names;
  for (const BatchScene& scene : scenes) {
    for (fs::path above = fs::path(scene.name).parent_path(); !above.empty();
         above = above.parent_path())
      if (names.count(above.string()))
        throw UsageError(scene.folder + " lies in the scene " + above.string() +
                         ": expected scenes that do not hold others");
    names.insert(scene.name);
    std::error_code none;
    const fs::path result = fs::path(out) / scene.name;
    if (fs::equivalent(result, scene.folder, none))
      throw UsageError("--out: the result of " + scene.folder + " would overwrite it");
    if (scene.name.rfind(".batch", 0) == 0)
      throw UsageError(scene.folder + ": a scene cannot be called .batch");
  }
}

}  // namespace

std::vector<BatchScene> find_scene_folders(const SceneSearch& search,
                                           std::vector<std::string>* warnings) {
  Walk walk(search, warnings);
  for (const std::string& root : search.roots) {
    std::error_code none;
    if (!fs::is_directory(root, none))
      throw InputError(root, "a folder with scenes", fs::exists(root, none) ? "a file" : "nothing");
    const size_t before = walk.found.size();
    walk.look_into(normal(root), true);
    if (walk.found.size() == before && search.roots.size() > 1)
      warnings->push_back(root + ": no scene in it, or none that is not in another root");
  }
  for (const std::string& folder : search.list) walk.found.push_back(normal(folder));
  const fs::path base = base_of(search);
  std::vector<BatchScene> scenes;
  for (const fs::path& folder : walk.found) {
    const std::string name = full_path(folder).lexically_relative(base).string();
    if (matches(name, search.match)) scenes.push_back({name, folder.string()});
  }
  if (scenes.empty()) {
    const bool none_at_all = walk.found.empty();
    throw InputError(search.roots.empty() ? "--list" : search.roots[0],
                     none_at_all ? "scene folders in it" : "scenes that --match", "none");
  }
  const auto by_name = [](const BatchScene& a, const BatchScene& b) { return a.name < b.name; };
  const auto same = [](const BatchScene& a, const BatchScene& b) { return a.name == b.name; };
  std::stable_sort(scenes.begin(), scenes.end(), by_name);
  scenes.erase(std::unique(scenes.begin(), scenes.end(), same), scenes.end());
  check_names(scenes, search.out);
  return scenes;
}

std::vector<std::string> read_scene_list(const std::string& path) {
  std::ifstream file;
  if (path != "-") {
    file.open(path);
    if (!file) throw InputError(path, "a list of scene folders", "no file that can be read");
  }
  std::istream& in = path == "-" ? std::cin : file;
  std::vector<std::string> folders;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line[0] != '#') folders.push_back(line);
  }
  if (in.bad()) throw InputError(path, "a list of scene folders", "an error while reading");
  if (folders.empty()) throw InputError(path, "scene folders, one a line", "none");
  return folders;
}

bool in_shard(const std::string& name, int shard, int shards) {
  return shards <= 1 || hash_number(name) % std::uint64_t(shards) == std::uint64_t(shard - 1);
}

}  // namespace sketchsplat

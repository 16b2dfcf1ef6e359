// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/readers/scene.h"
#include "sketches/io/json.h"

namespace sketchsplat {

/// Where a scene is read from.
struct SceneSource {
  std::string folder;
  bool allow_outside = false;  ///< may images and masks lie outside of the folder?
};

/// A format of scene folders. One file per format defines its own; scene.cc lists them.
/// Both read views, gt_from_world and warnings, and throw InputError.
struct SceneFormat {
  const char* name;
  const char* marker;  ///< the JSON file that marks the folder, or other files, in words
  /// From that JSON file; null: there is none.
  void (*read_json)(const SceneSource& source, const JsonValue& root, Scene* scene);
  /// Whether other files that mark the folder are there, and what they hold.
  bool (*is_marked)(const std::string& folder) = nullptr;
  void (*read_folder)(const SceneSource& source, Scene* scene) = nullptr;
};

extern const SceneFormat kAbcNefFormat;                   ///< abc_nef.cc
extern const SceneFormat kNerfFormat, kNerfstudioFormat;  ///< nerf.cc
extern const SceneFormat kColmapFormat;                   ///< colmap.cc

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/readers/scene.h"

namespace sketchsplat {

/// Where a scene is read from.
struct SceneSource {
  std::string folder;
  bool allow_outside = false;  ///< may images and masks lie outside of the folder?
};

/// A format of scene folders. One file per format defines its own; scene.cc lists them.
struct SceneFormat {
  const char* name;
  const char* marker;                            ///< in words, for messages
  bool (*is_marked)(const std::string& folder);  ///< whether the marker is there
  void (*read)(const SceneSource& source,
               Scene* scene);  ///< views, gt_from_world, warnings; throws InputError
};

extern const SceneFormat kAbcNefFormat;  ///< abc_nef.cc
extern const SceneFormat kNerfFormat;    ///< nerf.cc
extern const SceneFormat kNerfstudioFormat;  ///< nerfstudio.cc
extern const SceneFormat kColmapFormat;      ///< colmap.cc

}  // namespace sketchsplat

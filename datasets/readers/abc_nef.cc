// SPDX-License-Identifier: MIT
// EMAP's layout (ABC-NEF_Edge): meta_data.json, color/, edge_<detector>/.
#include "datasets/readers/format.h"
#include "datasets/readers/frame.h"

namespace sketchsplat {
namespace {

void read_abc_nef(const SceneSource& source, const JsonValue& root, Scene* scene) {
  if (root.has("worldtogt")) {
    scene->gt_from_world = root["worldtogt"].matrix(4, 4);
    if (!scene->gt_from_world.allFinite()) root["worldtogt"].complain("finite numbers");
  }
  ImageSize size;
  if (root.has("width") && root.has("height")) {
    size = {root["width"].positive_integer(), root["height"].positive_integer()};
  }
  for (const JsonValue& entry : frames_of(root)) {
    Frame frame;
    frame.name = entry["rgb_path"].text();
    find_image_of(source, source.folder + "/color", frame.name, &frame);
    frame.size = size;
    frame.intrinsics = entry["intrinsics"].matrix(3, 3);
    frame.world_from_cam = entry["camtoworld"].matrix(4, 4);
    add_frame(frame, scene);
  }
}

}  // namespace

const SceneFormat kAbcNefFormat = {"abc-nef", "meta_data.json", read_abc_nef};

}  // namespace sketchsplat

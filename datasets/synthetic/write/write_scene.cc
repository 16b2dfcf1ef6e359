// SPDX-License-Identifier: MIT
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "datasets/io/float_image_io.h"
#include "datasets/io/image_io.h"
#include "datasets/synthetic/render/degrade.h"
#include "datasets/synthetic/render/visibility.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/synthetic/write/write_photos.h"
#include "datasets/synthetic/write/write_truth.h"
#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json frame_of_view(const View& view) {
  const Pose world_from_cam = view.cam_from_world.inverse();
  Eigen::Matrix4d camtoworld = Eigen::Matrix4d::Identity();
  camtoworld.topLeftCorner<3, 3>() = world_from_cam.rotation;
  camtoworld.topRightCorner<3, 1>() = world_from_cam.translation;
  Eigen::Matrix3d K;
  K << view.camera.fx, 0, view.camera.cx, 0, view.camera.fy, view.camera.cy, 0, 0, 1;
  return {
      {"rgb_path", view.name}, {"camtoworld", json_rows(camtoworld)}, {"intrinsics", json_rows(K)}};
}

json meta_data(const SyntheticScene& scene) {
  const double e = scene.options.extent;
  const Eigen::Matrix3Xd points = (scene.hints * e).array() + 0.5 * e;
  json frames = json::array();
  for (const View& view :
       stated_views(scene.views, points, scene.options.degrade, scene.options.seed))
    frames.push_back(frame_of_view(view));
  return {{"camera_model", "OPENCV"},
          {"height", scene.options.rig.height},
          {"width", scene.options.rig.resolution},
          {"worldtogt", json_rows(Eigen::Matrix4d::Identity())},
          {"scene_box",
           {{"aabb", {{-e, -e, -e}, {e, e, e}}},
            {"near", 2 * e},
            {"far", 6 * e},
            {"radius", e},
            {"collider_type", "box"}}},
          {"frames", frames}};
}

void write_outputs(const SyntheticScene& scene, int k, const RenderedView& view,
                   const std::string& folder, const Outputs& outputs) {
  const auto file = [&](const char* subfolder, const char* ending) {
    return folder + "/" + subfolder + "/" + std::to_string(k) + ending;
  };
  if (outputs.mask) write_png(file("mask", ".png"), view.mask);
  if (outputs.depth) write_exr(file("depth", ".exr"), {{"Z", view.depth}}, /*half=*/false);
  if (outputs.normal)
    write_exr(file("normal", ".exr"),
              {{"R", view.normal_x}, {"G", view.normal_y}, {"B", view.normal_z}}, /*half=*/true);
  if (!outputs.edges) return;
  const VisibleEdges edges =
      visible_edges(scene.unit_views[k], scene.tracer, scene.unit_curves, scene.lift);
  const Camera& camera = scene.unit_views[k].camera;
  write_png(file("edges_visible", ".png"), draw(edges, camera.width, camera.height));
  write_whole(file("edges_visible", ".json"), to_json(edges));
}

void make_folders(const std::string& folder, const Outputs& outputs) {
  const std::pair<const char*, bool> wanted[] = {{"color", true},
                                                 {"mask", outputs.mask},
                                                 {"depth", outputs.depth},
                                                 {"normal", outputs.normal},
                                                 {"edges_visible", outputs.edges}};
  for (const auto& [name, is_wanted] : wanted)
    if (is_wanted) make_folder(folder + "/" + name);
}

}  // namespace

void write_scene(const SyntheticScene& scene, const std::string& folder) {
  if (scene.photo) {
    write_photos(scene, folder);
    return;
  }
  const Outputs outputs = parse_outputs(scene.options.outputs);
  make_folders(folder, outputs);
  const int n = int(scene.views.size());
  const std::vector<Fate> fate = fates(n, scene.options.degrade, scene.options.seed);
  parallel_for(n, 1, [&](int k) {
    const RenderedView view = render_view(scene, k);
    write_image(folder + "/color/" + scene.views[k].name, fate[k],
                [&](const std::string& path) { write_png(path, view.picture); });
    write_outputs(scene, k, view, folder, outputs);
  });
  write_truth(scene, folder);
  write_whole(folder + "/meta_data.json", json_text(meta_data(scene), 1));
}

}  // namespace sketchsplat

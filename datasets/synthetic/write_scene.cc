// SPDX-License-Identifier: MIT
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "datasets/errors.h"
#include "datasets/float_image_io.h"
#include "datasets/image_io.h"
#include "datasets/synthetic/degrade.h"
#include "datasets/synthetic/synthesize.h"
#include "datasets/synthetic/visibility.h"
#include "datasets/synthetic/write_abc.h"
#include "sketches/io.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void write_text(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw OutputError(path, "no way to write there");
  std::error_code error;
  fs::rename(temporary, path, error);
  if (error) throw OutputError(path, error.message());
}

json rows(const Eigen::MatrixXd& m) {
  json out = json::array();
  for (int r = 0; r < m.rows(); ++r) {
    json row = json::array();
    for (int c = 0; c < m.cols(); ++c) row.push_back(m(r, c));
    out.push_back(row);
  }
  return out;
}

json frame_of_view(const View& view) {
  const Pose world_from_cam = view.cam_from_world.inverse();
  Eigen::Matrix4d camtoworld = Eigen::Matrix4d::Identity();
  camtoworld.topLeftCorner<3, 3>() = world_from_cam.rotation;
  camtoworld.topRightCorner<3, 1>() = world_from_cam.translation;
  Eigen::Matrix3d K;
  K << view.camera.fx, 0, view.camera.cx, 0, view.camera.fy, view.camera.cy, 0, 0, 1;
  return {{"rgb_path", view.name}, {"camtoworld", rows(camtoworld)}, {"intrinsics", rows(K)}};
}

json meta_data(const SyntheticScene& scene) {
  const double e = scene.options.extent;
  const Eigen::Matrix3Xd points = (scene.hints * e).array() + 0.5 * e;
  json frames = json::array();
  for (const View& view :
       stated_views(scene.views, points, scene.options.degrade, scene.options.seed))
    frames.push_back(frame_of_view(view));
  return {{"camera_model", "OPENCV"},
          {"height", scene.options.rig.resolution},
          {"width", scene.options.rig.resolution},
          {"worldtogt", rows(Eigen::Matrix4d::Identity())},
          {"scene_box",
           {{"aabb", {{-e, -e, -e}, {e, e, e}}},
            {"near", 2 * e},
            {"far", 6 * e},
            {"radius", e},
            {"collider_type", "box"}}},
          {"frames", frames}};
}

json ground_truth(const Truth& truth) {
  json out = json::array();
  for (const TruthCurve& curve : truth.curves)
    out.push_back({{"type", curve.type},
                   {"closed", curve.closed},
                   {"dihedral_deg", curve.dihedral_deg},
                   {"visible_views", curve.visible_views},
                   {"points", rows(curve.points.transpose())}});
  return out;
}

// The image, or what is left of it; of an earlier one with that name, nothing.
void write_image(const std::string& path, const Picture& picture, Fate fate) {
  std::error_code error;
  if (fate == Fate::kMissing) {
    fs::remove(path, error);
  } else {
    write_png(path, picture);
    if (fate == Fate::kTruncated) fs::resize_file(path, fs::file_size(path) / 2, error);
  }
  if (error) throw OutputError(path, error.message());
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
  write_text(file("edges_visible", ".json"), to_json(edges));
}

void make_folders(const std::string& folder, const Outputs& outputs) {
  const std::pair<const char*, bool> wanted[] = {{"/color", true},
                                                 {"/groundtruth/abc/feat", true},
                                                 {"/groundtruth/abc/obj", true},
                                                 {"/mask", outputs.mask},
                                                 {"/depth", outputs.depth},
                                                 {"/normal", outputs.normal},
                                                 {"/edges_visible", outputs.edges}};
  for (const auto& [name, is_wanted] : wanted) {
    std::error_code error;
    if (is_wanted) fs::create_directories(folder + name, error);
    if (error) throw OutputError(folder + name, error.message());
  }
}

}  // namespace

void write_scene(const SyntheticScene& scene, const std::string& folder) {
  const Outputs outputs = parse_outputs(scene.options.outputs);
  make_folders(folder, outputs);
  const int n = int(scene.views.size());
  const std::vector<Fate> fate = fates(n, scene.options.degrade, scene.options.seed);
  std::vector<std::exception_ptr> failures(n);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < n; ++k) {
    try {
      const RenderedView view = render_view(scene, k);
      write_image(folder + "/color/" + scene.views[k].name, view.picture, fate[k]);
      write_outputs(scene, k, view, folder, outputs);
    } catch (...) {
      failures[k] = std::current_exception();
    }
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  write_text(folder + "/groundtruth/gt.json", ground_truth(scene.truth).dump());
  std::ostringstream sketch;
  write_sketch_json(sketch, scene.truth.sketch);
  write_text(folder + "/groundtruth/sketch.json", sketch.str());
  for (const auto& [name, text] : abc_files(scene))
    write_text(folder + "/groundtruth/abc/" + name, text);
  write_text(folder + "/meta_data.json", meta_data(scene).dump(1));
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/errors.h"
#include "datasets/scene.h"
#include "datasets/synthetic/synthesize.h"
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
  json frames = json::array();
  for (const View& view : scene.views) frames.push_back(frame_of_view(view));
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

}  // namespace

void write_scene(const SyntheticScene& scene, const std::string& folder) {
  std::error_code error;
  for (const char* name : {"/color", "/groundtruth"}) {
    fs::create_directories(folder + name, error);
    if (error) throw OutputError(folder + name, error.message());
  }
  const int n = int(scene.views.size());
  std::vector<std::exception_ptr> failures(n);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < n; ++k) {
    try {
      write_png(folder + "/color/" + scene.views[k].name, render(scene, k));
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
  write_text(folder + "/meta_data.json", meta_data(scene).dump(1));
}

}  // namespace sketchsplat

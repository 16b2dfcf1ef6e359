// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write/write_photos.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/io/image_io.h"
#include "datasets/synthetic/photo/tie_points.h"
#include "datasets/synthetic/render/degrade.h"
#include "datasets/synthetic/render/pose_error.h"
#include "datasets/synthetic/write/write_colmap.h"
#include "datasets/synthetic/write/write_truth.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using nlohmann::json;

constexpr int kUsualQuality = 92;

Vector3d to_world(const SyntheticScene& scene, const Vector3d& unit) {
  return (unit.array() + 0.5).matrix() * scene.options.extent;
}

// What the scene says of its cameras.
std::vector<View> stated_cameras(const SyntheticScene& scene, const Eigen::Matrix3Xd& edges) {
  const SynthesizeOptions& o = scene.options;
  std::vector<View> views = stated_views(scene.views, edges, o.degrade, o.seed);
  if (!o.photo.state_lens)
    for (View& view : views) view.lens = Lens();
  return with_pose_error(views, edges, o.photo.pose_error_px, o.seed);
}

json facts(const SyntheticScene& scene, double error_px) {
  const SynthesizeOptions& o = scene.options;
  const View& view = scene.views.at(0);
  const Lens::Terms& k = view.lens.terms();
  const Vector3d up = scene.photo->room.up(),
                 table = to_world(scene, scene.photo->room.unit_from_room.translation());
  json exposures = json::array();
  for (size_t i = 0; i < scene.views.size(); ++i)
    exposures.push_back(exposure_of(o.render, o.seed, int(i)));
  json out = {{"lens",
               {{"fx", view.camera.fx},
                {"fy", view.camera.fy},
                {"cx", view.camera.cx},
                {"cy", view.camera.cy},
                {"k1", k.k1},
                {"k2", k.k2},
                {"p1", k.p1},
                {"p2", k.p2}}},
              {"width", view.camera.width},
              {"height", view.camera.height},
              {"up", {up.x(), up.y(), up.z()}},
              {"table_height", table.dot(up)},
              {"exposures", exposures},
              {"stated_error_px", error_px}};
  if (scene.photo->room.has_tag) {
    Eigen::Matrix<double, 3, 4> corners = scene.photo->room.tag_corners;
    for (int i = 0; i < 4; ++i) corners.col(i) = to_world(scene, corners.col(i));
    out["tag"] = {{"family", "tag36h11"},
                  {"id", o.photo.tag},
                  {"size", (corners.col(1) - corners.col(0)).norm()},
                  {"corners", json_rows(corners.transpose())}};
  }
  return out;
}

void write_photo(const SyntheticScene& scene, int k, Fate fate, const std::string& folder) {
  const RenderedView view = render_view(scene, k);
  const int quality = scene.options.render.jpeg;
  write_image(folder + "/images/" + scene.views[k].name, fate, [&](const std::string& path) {
    write_jpeg(path, view.picture, quality > 0 ? quality : kUsualQuality);
  });
  if (!scene.options.photo.masks) return;
  const std::string name = fs::path(scene.views[k].name).replace_extension(".png").string();
  write_png(folder + "/masks/" + name, view.mask);
}

void write_model(const std::vector<View>& views, const std::vector<TiePoint>& points,
                 const std::string& folder) {
  make_folder(folder);
  write_colmap(views, points, folder);
}

}  // namespace

void write_photos(const SyntheticScene& scene, const std::string& folder) {
  const SynthesizeOptions& o = scene.options;
  make_folder(folder + "/images");
  if (o.photo.masks) make_folder(folder + "/masks");
  const int n = int(scene.views.size());
  const std::vector<Fate> fate = fates(n, o.degrade, o.seed);
  for (int k = 0; k < n; ++k) write_photo(scene, k, fate[k], folder);
  write_truth(scene, folder);

  const PhotoShader shader(*scene.photo, {o.photo.surface, o.seed}, scene.lift);
  std::vector<TiePoint> points =
      tie_points(*scene.photo, shader, scene.unit_views, scene.lift, o.seed);
  for (TiePoint& point : points) point.point = to_world(scene, point.point);
  const Eigen::Matrix3Xd edges = ((scene.hints.array() + 0.5) * o.extent).matrix();
  const std::vector<View> stated = stated_cameras(scene, edges);
  const double error = rms_shift(scene.views, stated, edges);
  const bool err = error > 0 || !o.photo.state_lens;
  write_model(stated, err ? triangulated(points, stated) : points, folder + "/sparse/0");
  if (err) write_model(scene.views, points, folder + "/true");
  write_whole(folder + "/scene.json", json_text(facts(scene, error), 1));
}

}  // namespace sketchsplat

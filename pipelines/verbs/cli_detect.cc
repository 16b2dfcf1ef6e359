// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "datasets/readers/open_options.h"
#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "datasets/types/geometry_maps.h"
#include "datasets/types/parallel.h"
#include "edges/image/undistort.h"
#include "eval/metrics/edge_maps.h"
#include "eval/metrics/map_errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/command/cli.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/options/options.h"
#include "pipelines/results/geometry_files.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

constexpr double kTolerance = 1.5;  // [px] of --score

struct DetectArguments {
  std::string scene, out, masks;
  OpenOptions open;
  DetectionOptions detection;
  double ridge_px = 0.7;  // half of the width in which people and networks draw edges
  bool score = false;
  bool geometry = false;
};

// Errors of a view's maps.
struct ViewScore {
  EdgeMapScore edges;
  MapErrors maps;
  bool has_maps = false;
};

// DIR/edge_image, DIR/edge_DexiNed: where readers of ABC-NEF look for edge maps.
std::string map_folder(const DetectArguments& arguments) {
  const std::string& detector = arguments.detection.detector;
  const size_t colon = detector.find(':');
  return arguments.out + "/edge_" +
         (colon == std::string::npos ? detector : detector.substr(colon + 1));
}

void write_map(const View& view, const EdgelMap& map, const DetectArguments& arguments) {
  // Edge maps are PNG, whatever the picture was.
  const std::string name = std::filesystem::path(view.name).replace_extension(".png").string();
  write_png(map_folder(arguments) + "/" + name,
            draw_edge_map(distort_edgels(map, view), arguments.ridge_px));
}

EdgeMapScore score_view(const Scene& scene, const View& view, const EdgelMap& map) {
  const std::string folder = scene.folder + "/edges_visible";
  const std::string path = file_of_view(folder, view, ".json");
  if (path.empty()) throw InputError(folder, "the true edges of " + view.name + " (.json)", "none");
  const EdgelMap seen = distort_edgels(map, view);
  Eigen::Matrix2Xd points(2, seen.edgels.size());
  for (size_t i = 0; i < seen.edgels.size(); ++i)
    points.col(i) << seen.edgels[i].x, seen.edgels[i].y;
  return score_edge_points(points, read_edge_polylines(path), kTolerance);
}

// Depth and normals, if the detector has its own: to files, and against the true ones.
void look_at_geometry(const Scene& scene, const Detector& detector, const View& view,
                      const DetectArguments& arguments, ViewScore* score) {
  const bool compare = arguments.score && detector.learns() &&
                       !file_of_view(scene.folder + "/depth", view, ".exr").empty();
  GeometryMaps maps;
  if ((!compare && !arguments.geometry) || !detector.geometry(scene, view, &maps)) return;
  if (arguments.geometry) write_geometry_maps(arguments.out, view, maps);
  if (!compare) return;
  score->maps = score_geometry(maps, read_geometry_maps(scene, view), view.camera);
  score->has_maps = true;
}

// Writes the maps view by view, and scores them if asked to.
std::vector<ViewScore> write_maps(const Scene& scene, const Detector& detector,
                                  const std::vector<Detection>& found,
                                  const DetectArguments& arguments) {
  const int n = int(found.size());
  std::vector<ViewScore> scores(n);
  parallel_for(n, 1, [&](int i) {
    if (!found[i].complaint.empty()) return;
    write_map(scene.views[i], found[i].map, arguments);
    if (arguments.score) scores[i].edges = score_view(scene, scene.views[i], found[i].map);
    look_at_geometry(scene, detector, scene.views[i], arguments, &scores[i]);
  });
  return scores;
}

// Mean over the views that have maps; `maps`: their number.
MapErrors mean_map_errors(const std::vector<ViewScore>& scores, int* maps) {
  MapErrors sum;
  *maps = 0;
  for (const ViewScore& s : scores) {
    if (!s.has_maps) continue;
    ++*maps;
    sum.normal_deg += s.maps.normal_deg, sum.depth_px += s.maps.depth_px;
    sum.covered += s.maps.covered;
  }
  const double n = std::max(1, *maps);
  sum.normal_deg /= n, sum.depth_px /= n, sum.covered /= n;
  return sum;
}

// What --score prints.
void print_scores(const EdgeMapScore& mean, int maps, const std::vector<ViewScore>& scores) {
  char line[160];
  std::snprintf(
      line, sizeof line,
      "within %.1f px, mean of %d views: precision %.1f, recall %.1f, F %.1f, rms %.3f px\n",
      kTolerance, maps, 100 * mean.precision, 100 * mean.recall, 100 * mean.f, mean.rms_px);
  std::cout << line;
  int views = 0;
  const MapErrors errors = mean_map_errors(scores, &views);
  if (views == 0) return;
  std::snprintf(line, sizeof line,
                "mean of %d views: normals %.2f deg, depth %.2f pixel footprints (median), "
                "covered %.1f %%\n",
                views, errors.normal_deg, errors.depth_px, 100 * errors.covered);
  std::cout << line;
}

Json json_of_scores(const EdgeMapScore& mean, const std::vector<ViewScore>& scores) {
  Json json = {{"tolerance_px", kTolerance},
               {"precision", 100 * mean.precision},
               {"recall", 100 * mean.recall},
               {"f", 100 * mean.f},
               {"rms_px", mean.rms_px}};
  int views = 0;
  const MapErrors errors = mean_map_errors(scores, &views);
  if (views > 0)
    json["geometry"] = {{"views", views},
                        {"normal_deg", errors.normal_deg},
                        {"depth_footprints", errors.depth_px},
                        {"covered", 100 * errors.covered}};
  return json;
}

// Prints what was written, and its scores.
void print_result(const std::vector<Detection>& found, const std::vector<ViewScore>& scores,
                  const DetectArguments& arguments, bool json) {
  int maps = 0;
  EdgeMapScore mean;
  for (size_t i = 0; i < found.size(); ++i) {
    if (!found[i].complaint.empty()) continue;
    ++maps;
    const EdgeMapScore& s = scores[i].edges;
    mean.precision += s.precision, mean.recall += s.recall, mean.f += s.f, mean.rms_px += s.rms_px;
  }
  const double n = std::max(1, maps);
  mean.precision /= n, mean.recall /= n, mean.f /= n, mean.rms_px /= n;
  if (json) {
    Json out = {{"folder", map_folder(arguments)}, {"maps", maps}};
    if (arguments.score) out["score"] = json_of_scores(mean, scores);
    print_json(out);
    return;
  }
  std::cout << map_folder(arguments) << ": " << maps << " edge maps\n";
  if (arguments.score) print_scores(mean, maps, scores);
}

void run_detect(DetectArguments arguments, const CommonOptions& common, Progress* progress) {
  arguments.detection.seed = common.seed;
  Scene scene = open_scene(arguments.scene, arguments.open);
  if (!arguments.masks.empty()) use_masks(arguments.masks, &scene);
  for (const std::string& warning : scene.warnings) progress->warn(warning);
  prepare_output_folder(map_folder(arguments));
  const std::unique_ptr<Detector> detector = make_detector(arguments.detection);
  if (arguments.geometry) prepare_geometry_folders(arguments.out);
  const std::vector<Detection> found = detect_all(scene, detector.get(), {nullptr, progress});
  const std::vector<ViewScore> scores = write_maps(scene, *detector, found, arguments);
  const std::string surfels = detector->surfels();
  if (arguments.geometry && !surfels.empty())
    write_atomically(arguments.out + "/surfels.ply", [&](std::ostream& file) { file << surfels; });
  print_result(found, scores, arguments, common.json);
}

}  // namespace

Verb detect_verb() {
  const auto arguments = std::make_shared<DetectArguments>();
  Fields f;
  f.group("Arguments");
  Field& scene = f.add("scene", &arguments->scene, "SCENE", "The folder with calibrated images");
  scene.required = scene.positional = true;
  Field& out =
      f.add("out", &arguments->out, "DIR", "Maps go to DIR/edge_<detector>/, named as images");
  out.required = true;
  out.short_name = "o";
  list_open_fields(&arguments->open, &f);
  f.add("masks", &arguments->masks, "DIR",
        "Folder of masks, white on the object; preferred to those of the scene");
  list_fields(&arguments->detection, &f);
  f.group("Maps");
  f.add("ridge", &arguments->ridge_px, "px", 0.3, 10, "Width (one sigma) of the drawn edges");
  f.add("score", &arguments->score, "Compare with the true edges in edges_visible/ of the scene");
  f.add("geometry", &arguments->geometry,
        "Also write depth/, normal/, alpha/ and surfels.ply, if the detector has them");
  Verb verb;
  verb.name = "detect";
  verb.summary = "Write the edge map of every image";
  verb.examples = {"sketchsplat detect scenes/part --out out/part",
                   "sketchsplat detect scenes/part --out out/part --detector geometry --score"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_detect(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

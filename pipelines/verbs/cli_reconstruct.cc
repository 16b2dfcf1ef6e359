// SPDX-License-Identifier: MIT
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "datasets/readers/frame.h"
#include "datasets/readers/open_options.h"
#include "datasets/types/errors.h"
#include "edges/views/lift.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/cameras/find_cameras.h"
#include "pipelines/command/cli.h"
#include "pipelines/method/estimate.h"
#include "pipelines/method/reconstruct.h"
#include "pipelines/method/scene_tags.h"
#include "pipelines/pages/page_photos.h"
#include "pipelines/results/known_scale.h"
#include "pipelines/results/outputs.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

struct ReconstructArguments {
  std::string scene, out;
  OpenOptions open;
  bool dry_run = false;
  std::string images;  // photographs without cameras, instead of a scene
  std::string masks;
  ReconstructOptions method;
  OutputOptions output;
};

// Number of views without an edge map.
int missing_maps(const Scene& scene, const std::string& detector) {
  const std::string prefix = "maps:";
  if (detector.rfind(prefix, 0) != 0) return 0;
  return int(std::count_if(scene.views.begin(), scene.views.end(), [&](const View& view) {
    return edge_map_path(scene, view, detector.substr(prefix.size())).empty();
  }));
}

// Photographs as a scene without cameras: only their sizes are known.
Scene photographs_in(const std::string& folder) {
  Scene scene;
  scene.folder = folder;
  scene.format = "photographs without cameras";
  for (const std::string& name : list_images(folder, true)) {
    View view;
    view.image_path = folder + "/" + name;
    try {
      const ImageSize size = read_image_size(view.image_path);
      view.camera.width = size.width;
      view.camera.height = size.height;
      scene.views.push_back(view);
    } catch (const InputError& e) {
      scene.warnings.push_back(e.what());
    }
  }
  if (scene.views.empty()) throw InputError(folder, "photographs", "none");
  return scene;
}

void print_scale(const KnownScale& scale) {
  if (scale.source.empty()) return;
  std::cout << scale.source << ": a world unit is " << scale.units_per_world << " "
            << length_unit_names()[int(scale.unit)];
  if (!std::isnan(scale.sigma_relative))
    std::cout << ", with a standard deviation of " << 100 * scale.sigma_relative << " %";
  std::cout << "\n";
}

// Prints what would be read, and the expected time and memory.
void print_plan(const Scene& scene, const ReconstructArguments& arguments, bool json,
                Progress* progress) {
  double pixels = 0;
  for (const View& view : scene.views) pixels += double(view.camera.width) * view.camera.height;
  const bool photographs = !arguments.images.empty();
  const int views = int(scene.views.size()), threads = omp_get_max_threads();
  const Load load = expected_load(views, pixels, arguments.method, threads);
  const int missing = missing_maps(scene, arguments.method.detector);
  KnownScale scale;
  if (arguments.method.tags && !photographs)
    scale = known_scale(arguments.output.cad, {}, 0, measure_tags(scene, {nullptr, progress}));
  if (json) {
    const Json size = scale.source.empty() ? Json() : parse_json<Json>(scale_json(scale));
    print_json({{"scale", size},
                {"scene", scene.folder},
                {"format", scene.format},
                {"views", views},
                {"pixels", pixels},
                {"left_out", scene.warnings.size()},
                {"missing_maps", missing},
                {"threads", threads},
                {"expected_seconds", load.seconds},
                {"expected_mb", load.memory_mb}});
    return;
  }
  std::cout << scene.folder << ": " << scene.format << ", " << views << " views, "
            << std::llround(pixels / 1e5) / 10.0 << " million pixels";
  if (!scene.warnings.empty()) std::cout << ", " << scene.warnings.size() << " frames left out";
  if (missing > 0) std::cout << ", " << missing << " edge maps missing";
  std::cout << "\nroughly " << rough_duration(load.seconds) << " with " << threads
            << (threads == 1 ? " thread" : " threads")
            << (photographs ? " after COLMAP, which takes far longer, " : ", ")
            << std::lround(load.memory_mb) << " MB, into " << arguments.out << "\n";
  print_scale(scale);
}

void print_result(const Sketch& sketch, const KnownScale& scale,
                  const ReconstructArguments& arguments, bool json) {
  if (json) {
    Json result = {{"out", arguments.out}};
    result.update(json_of_file(arguments.out + "/report.json"));
    print_json(result);
    return;
  }
  std::cout << arguments.out << "/sketch.step: " << sketch.size() << " curves, "
            << sketch.nodes.cols() << " junctions\n"
            << arguments.out << "/report.html: to look at\n";
  print_scale(scale);
}

// The scene, or photographs with cameras from COLMAP.
Scene open_views(const ReconstructArguments& arguments, const CommonOptions& common,
                 const RunLog& log) {
  Scene scene;
  if (arguments.images.empty()) {
    scene = open_scene(arguments.scene, arguments.open);
  } else {
    prepare_output_folder(arguments.out);
    std::error_code none;
    if (std::filesystem::equivalent(arguments.images, arguments.out, none))
      throw UsageError("--out must be another folder than --images: images are written there");
    const std::string folder = arguments.out + "/colmap";
    find_cameras(arguments.images, {arguments.out, arguments.masks}, folder, common.threads, log);
    scene = open_scene(folder, "colmap");
    scene.folder = arguments.images;  // as users and files call it
  }
  if (!arguments.masks.empty()) use_masks(arguments.masks, &scene);
  for (const std::string& warning : scene.warnings) log.progress->warn(warning);
  return scene;
}

void run_reconstruct(ReconstructArguments arguments, const CommonOptions& common,
                     Progress* progress) {
  arguments.method.seed = common.seed;
  check_scale(arguments.output.cad);
  arguments.method.tags = wants_tags(arguments.output.cad);
  if (!arguments.scene.empty() && !arguments.images.empty())
    throw UsageError("reconstruct takes SCENE or --images DIR, not both");
  if (arguments.dry_run) {
    print_plan(arguments.images.empty() ? open_views(arguments, common, {nullptr, progress})
                                        : photographs_in(arguments.images),
               arguments, common.json, progress);
    return;
  }
  RunReport before;
  const Scene scene = open_views(arguments, common, {&before, progress});
  prepare_output_folder(arguments.out);
  const PhotoAlbum album(scene, meeting_point(scene.views));
  Reconstruction result = reconstruct(arguments.output.overlays > 0 ? album.watched() : scene,
                                      arguments.method, progress);
  RunReport& report = result.report;
  report.started = before.started;
  report.stages.insert(report.stages.begin(), before.stages.begin(), before.stages.end());
  report.warnings.insert(report.warnings.begin(), before.warnings.begin(), before.warnings.end());
  const KnownScale scale = write_outputs(arguments.out, result, scene, album, arguments.method,
                                         arguments.output, progress);
  print_result(result.sketch, scale, arguments, common.json);
}

}  // namespace

Verb reconstruct_verb() {
  const auto arguments = std::make_shared<ReconstructArguments>();
  Fields f;
  f.group("Arguments");
  Field& scene = f.add("scene", &arguments->scene, "SCENE", "The folder with calibrated images");
  scene.required = scene.positional = true;
  scene.unless = "images";
  Field& out = f.add("out", &arguments->out, "DIR", "The folder to write into");
  out.required = true;
  out.short_name = "o";
  list_open_fields(&arguments->open, &f);
  f.add("dry-run", &arguments->dry_run,
        "Only print what would be read, and the expected time and memory");
  f.add("images", &arguments->images, "DIR",
        "Photographs without cameras, which COLMAP finds first");
  f.add("masks", &arguments->masks, "DIR",
        "Folder of masks, white on the object; preferred to those of the scene");
  list_fields(&arguments->method, &f);
  list_fields(&arguments->output, &f);
  Verb verb;
  verb.name = "reconstruct";
  verb.summary = "Reconstruct the edges of an object as curves from calibrated images";
  verb.examples = {"sketchsplat reconstruct scenes/part --out out/part",
                   "sketchsplat reconstruct --images photos -o out/part --masks masks",
                   "sketchsplat reconstruct scenes/part -o out/part --scale-by tag=10mm"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_reconstruct(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

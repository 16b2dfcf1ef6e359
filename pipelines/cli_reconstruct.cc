// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>

#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"
#include "pipelines/find_cameras.h"
#include "pipelines/outputs.h"
#include "pipelines/reconstruct.h"

namespace sketchsplat {
namespace {

struct ReconstructArguments {
  std::string scene, out;
  std::string format;  // empty: found out
  std::string images;  // photographs without cameras, instead of a scene
  std::string masks;
  ReconstructOptions method;
  OutputOptions output;
};

// The scene, or the photographs with the cameras that COLMAP finds.
Scene open_views(const ReconstructArguments& arguments, const CommonOptions& common,
                 RunReport* report, Progress* progress) {
  Scene scene;
  if (arguments.images.empty()) {
    scene = open_scene(arguments.scene, arguments.format);
  } else {
    prepare_output_folder(arguments.out);
    const std::string folder = arguments.out + "/colmap";
    find_cameras(arguments.images, folder, common.threads, report, progress);
    scene = open_scene(folder, "colmap");
    scene.folder = arguments.images;  // that is how users and files call it
  }
  if (!arguments.masks.empty()) use_masks(arguments.masks, &scene);
  for (const std::string& warning : scene.warnings) progress->warn(warning);
  return scene;
}

void run_reconstruct(ReconstructArguments arguments, const CommonOptions& common,
                     Progress* progress) {
  arguments.method.seed = common.seed;
  if (!arguments.scene.empty() && !arguments.images.empty())
    throw UsageError("reconstruct takes SCENE or --images DIR, not both");
  RunReport before;
  const Scene scene = open_views(arguments, common, &before, progress);
  prepare_output_folder(arguments.out);
  Reconstruction result = reconstruct(scene, arguments.method, progress);
  RunReport& report = result.report;
  report.started = before.started;
  report.stages.insert(report.stages.begin(), before.stages.begin(), before.stages.end());
  report.warnings.insert(report.warnings.begin(), before.warnings.begin(), before.warnings.end());
  write_outputs(arguments.out, result, scene, arguments.method, arguments.output, progress);
  std::cout << arguments.out << "/sketch.step: " << result.sketch.size() << " curves, "
            << result.sketch.nodes.cols() << " junctions\n"
            << arguments.out << "/report.html: to look at\n";
}

}  // namespace

Verb reconstruct_verb() {
  const auto arguments = std::make_shared<ReconstructArguments>();
  Fields f;
  f.group("Arguments");
  Field& scene = f.add("scene", &arguments->scene, "SCENE", "The folder with calibrated images");
  scene.required = scene.positional = true;
  scene.unless = "images";
  Field& out = f.add("out", &arguments->out, "DIR", "The folder to write into, made if missing");
  out.required = true;
  out.short_name = "o";
  f.choose("format", &arguments->format, scene_formats(),
           "What the folder is; if left out, its files decide");
  f.add("images", &arguments->images, "DIR",
        "Photographs without cameras: COLMAP finds them first, into colmap/ of --out");
  f.add("masks", &arguments->masks, "DIR", "Masks, white on the object, before those of the scene");
  list_fields(&arguments->method, &f);
  list_fields(&arguments->output, &f);
  Verb verb;
  verb.name = "reconstruct";
  verb.summary = "Turn calibrated images of an object into its edges as curves";
  verb.examples = {"sketchsplat reconstruct scenes/part --out out/part",
                   "sketchsplat reconstruct scenes/part -o out/part --preset accurate --threads 4",
                   "sketchsplat reconstruct scenes/part -o out/part --detector maps:DexiNed",
                   "sketchsplat reconstruct --images photos -o out/part --masks masks"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_reconstruct(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

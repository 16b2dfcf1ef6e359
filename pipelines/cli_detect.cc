// SPDX-License-Identifier: MIT
#include <filesystem>
#include <iostream>
#include <memory>

#include "datasets/errors.h"
#include "datasets/scene.h"
#include "edges/detect.h"
#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"
#include "pipelines/run_report.h"

namespace sketchsplat {
namespace {

struct DetectArguments {
  std::string scene, out, format;
  DetectOptions edges;
  double ridge_px = 0.7;  // half of the width in which people and networks draw edges
};

// What happened to a view: edgels found, or why it is left out.
struct Outcome {
  size_t edgels = 0;
  std::string complaint;
};

Outcome detect_view(const View& view, const DetectArguments& arguments, const std::string& folder) {
  Picture picture;
  try {
    picture = read_picture(view.image_path);
  } catch (const InputError& e) {
    return {0, e.what()};
  }
  const EdgelMap map = detect_edges(picture, arguments.edges);
  // Edge maps are PNG, whatever the picture was.
  const std::string name = std::filesystem::path(view.name).replace_extension(".png").string();
  write_png(folder + "/" + name, draw_edge_map(map, arguments.ridge_px));
  return {map.edgels.size(), ""};
}

void run_detect(const DetectArguments& arguments, Progress* progress) {
  const Scene scene = open_scene(arguments.scene, arguments.format);
  for (const std::string& warning : scene.warnings) progress->warn(warning);
  const std::string folder = arguments.out + "/edge_image";
  prepare_output_folder(folder);

  size_t edgels = 0, maps = 0;
  Stage stage("detect", int(scene.views.size()), nullptr, progress);
  for (const View& view : scene.views) {
    const Outcome outcome = detect_view(view, arguments, folder);
    if (!outcome.complaint.empty())
      progress->warn("view " + view.name + " is left out: " + outcome.complaint);
    else
      ++maps;
    edgels += outcome.edgels;
    stage.step();
  }
  if (maps == 0) throw InputError(arguments.scene, "a view whose image can be read", "none");
  stage.result(std::to_string(edgels) + " edgels");
  std::cout << folder << ": " << maps << " edge maps\n";
}

}  // namespace

Verb detect_verb() {
  const auto arguments = std::make_shared<DetectArguments>();
  Fields f;
  f.group("Arguments");
  Field& scene = f.add("scene", &arguments->scene, "SCENE", "The folder with calibrated images");
  scene.required = scene.positional = true;
  Field& out = f.add("out", &arguments->out, "DIR", "Maps go to DIR/edge_image/, named as images");
  out.required = true;
  out.short_name = "o";
  f.choose("format", &arguments->format, scene_formats(),
           "What the folder is; if left out, its files decide");
  list_fields(&arguments->edges, &f);
  f.group("Maps");
  f.add("ridge", &arguments->ridge_px, "px", 0.3, 10, "Width (one sigma) in which edges are drawn");
  Verb verb;
  verb.name = "detect";
  verb.summary = "Write the edge map of every image";
  verb.examples = {"sketchsplat detect scenes/part --out out/part"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions&, Progress* progress) {
    run_detect(*arguments, progress);
  };
  return verb;
}

}  // namespace sketchsplat

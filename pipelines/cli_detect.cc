// SPDX-License-Identifier: MIT
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>

#include "datasets/errors.h"
#include "datasets/scene.h"
#include "edges/detect.h"
#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"
#include "pipelines/run_report.h"
#include "pipelines/stages.h"

namespace sketchsplat {
namespace {

struct DetectArguments {
  std::string scene, out, format;
  std::string detector = ReconstructOptions().detector;
  DetectOptions edges;
  MapOptions maps;
  double ridge_px = 0.7;  // half of the width in which people and networks draw edges
};

// DIR/edge_image, DIR/edge_DexiNed: where readers of ABC-NEF look for edge maps.
std::string map_folder(const DetectArguments& arguments) {
  const size_t colon = arguments.detector.find(':');
  const std::string name =
      colon == std::string::npos ? arguments.detector : arguments.detector.substr(colon + 1);
  return arguments.out + "/edge_" + name;
}

// Returns the number of edgels.
size_t write_map(const Scene& scene, const View& view, const DetectArguments& arguments) {
  const EdgelMap map =
      detect_view(scene, arguments.detector, arguments.edges, arguments.maps, view);
  // Edge maps are PNG, whatever the picture was.
  const std::string name = std::filesystem::path(view.name).replace_extension(".png").string();
  write_png(map_folder(arguments) + "/" + name, draw_edge_map(map, arguments.ridge_px));
  return map.edgels.size();
}

// What became of a view: edgels found, why it is left out, or what ends the run.
struct Outcome {
  size_t edgels = 0;
  std::string complaint;
  std::exception_ptr failure;
};

std::vector<Outcome> write_maps(const Scene& scene, const DetectArguments& arguments,
                                Stage* stage) {
  std::vector<Outcome> outcomes(scene.views.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (size_t i = 0; i < scene.views.size(); ++i) {
    try {
      outcomes[i].edgels = write_map(scene, scene.views[i], arguments);
    } catch (const InputError& e) {
      outcomes[i].complaint = e.what();
    } catch (...) {
      outcomes[i].failure = std::current_exception();  // must not leave the parallel loop
    }
    stage->step();
  }
  return outcomes;
}

void run_detect(const DetectArguments& arguments, Progress* progress) {
  const Scene scene = open_scene(arguments.scene, arguments.format);
  for (const std::string& warning : scene.warnings) progress->warn(warning);
  prepare_output_folder(map_folder(arguments));

  size_t edgels = 0, maps = 0;
  {
    Stage stage("detect", int(scene.views.size()), nullptr, progress);
    const std::vector<Outcome> outcomes = write_maps(scene, arguments, &stage);
    for (size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i].failure) std::rethrow_exception(outcomes[i].failure);
      edgels += outcomes[i].edgels;
      maps += outcomes[i].complaint.empty();
      if (!outcomes[i].complaint.empty())
        progress->warn("view " + scene.views[i].name + " is left out: " + outcomes[i].complaint);
    }
    if (maps == 0)
      throw InputError(arguments.scene, "a view that can be read", outcomes[0].complaint);
    stage.result(std::to_string(edgels) + " edgels");
  }
  std::cout << map_folder(arguments) << ": " << maps << " edge maps\n";
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
  f.choose("format", &arguments->format, scene_formats(),
           "What the folder is; if left out, its files decide");
  list_detector(&arguments->detector, &f);
  list_fields(&arguments->edges, &f);
  list_fields(&arguments->maps, &f);
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

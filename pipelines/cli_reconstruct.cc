// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>

#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"
#include "pipelines/outputs.h"
#include "pipelines/reconstruct.h"

namespace sketchsplat {
namespace {

struct ReconstructArguments {
  std::string scene, out;
  std::string format;  // empty: found out
  ReconstructOptions method;
  OutputOptions output;
};

void run_reconstruct(ReconstructArguments arguments, const CommonOptions& common,
                     Progress* progress) {
  arguments.method.seed = common.seed;
  const Scene scene = open_scene(arguments.scene, arguments.format);
  for (const std::string& warning : scene.warnings) progress->warn(warning);
  prepare_output_folder(arguments.out);
  const Reconstruction result = reconstruct(scene, arguments.method, progress);
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
  Field& out = f.add("out", &arguments->out, "DIR", "The folder to write into, made if missing");
  out.required = true;
  out.short_name = "o";
  f.choose("format", &arguments->format, scene_formats(),
           "What the folder is; if left out, its files decide");
  list_fields(&arguments->method, &f);
  list_fields(&arguments->output, &f);
  Verb verb;
  verb.name = "reconstruct";
  verb.summary = "Turn calibrated images of an object into its edges as curves";
  verb.examples = {"sketchsplat reconstruct scenes/part --out out/part",
                   "sketchsplat reconstruct scenes/part -o out/part --preset accurate --threads 4",
                   "sketchsplat reconstruct scenes/part -o out/part --detector maps:DexiNed"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_reconstruct(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

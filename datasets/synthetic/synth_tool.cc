// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <map>

#include "datasets/errors.h"
#include "datasets/synthetic/parts.h"
#include "datasets/synthetic/synthesize.h"

namespace {

using namespace sketchsplat;

struct Arguments {
  SynthesizeOptions options;
  std::string out, background = "transparent";
};

void declare(CLI::App& app, Arguments* a) {
  SynthesizeOptions& o = a->options;
  std::string parts;
  for (const std::string& name : part_names()) parts += " " + name;
  app.add_option("part", o.part, "STEP file or one of:" + parts)->required();
  app.add_option("--out", a->out, "scene folder to write")->required();
  app.add_option("--seed", o.seed, "of dimensions, cameras and noise")->capture_default_str();
  app.add_option("--extent", o.extent, "longest side of the object")->capture_default_str();
  app.add_option("--views", o.rig.views, "number of cameras")->capture_default_str();
  app.add_option("--resolution", o.rig.resolution, "px")->capture_default_str();
  app.add_option("--focal", o.rig.focal, "px; 0: as ABC-NEF")->capture_default_str();
  app.add_option("--distance", o.rig.distance, "extents")->capture_default_str();
  app.add_option("--elevation", o.rig.elevation_deg, "deg, of a ring")->capture_default_str();
  const std::map<std::string, RigKind> rigs = {
      {"sphere", RigKind::kSphere}, {"upper", RigKind::kUpper}, {"ring", RigKind::kRing}};
  app.add_option("--rig", o.rig.kind, "where cameras stand")
      ->transform(CLI::CheckedTransformer(rigs));
  app.add_option("--noise", o.render.noise, "sigma, grey levels")->capture_default_str();
  app.add_option("--blur", o.render.blur, "sigma, px")->capture_default_str();
  app.add_option("--exposure", o.render.exposure, "sigma, stops")->capture_default_str();
  app.add_option("--background", a->background, "transparent, or a grey in [0, 1]");
}

void run(Arguments* a) {
  if (a->background != "transparent") {
    a->options.render.transparent = false;
    a->options.render.background = std::stod(a->background);
  }
  const auto start = std::chrono::steady_clock::now();
  const SyntheticScene scene = synthesize(a->options);
  const std::chrono::duration<double> ready = std::chrono::steady_clock::now() - start;
  write_scene(scene, a->out);
  const std::chrono::duration<double> done = std::chrono::steady_clock::now() - start;
  std::map<std::string, int> kinds;
  for (const TruthCurve& curve : scene.truth.curves) ++kinds[curve.type];
  std::printf("%s: %zu curves (", a->options.part.c_str(), scene.truth.curves.size());
  for (const auto& kind : kinds) std::printf(" %d %s", kind.second, kind.first.c_str());
  std::printf(" ), %d strokes, %d nodes, %zu complaints; %.1f s of which %.1f s before rendering\n",
              scene.truth.sketch.size(), int(scene.truth.sketch.nodes.cols()),
              validate(scene.truth.sketch).size(), done.count(), ready.count());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Renders a part with exact ground truth");
  Arguments arguments;
  declare(app, &arguments);
  try {
    app.parse(argc, argv);
    run(&arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  } catch (const OutputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 5;
  }
  return 0;
}

// SPDX-License-Identifier: MIT
#include <dlfcn.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "datasets/synthetic/parts.h"
#include "datasets/synthetic/plugin.h"
#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"
#include "pipelines/run_report.h"

namespace sketchsplat {
namespace {

struct SynthesizeArguments {
  std::string out;
  SynthesizeOptions options;
};

// Beside the executable, where it is installed, or where it was built.
const SynthesisPlugin& load_plugin() {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path bin = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& folder :
       {bin, bin / ".." / "lib" / "sketchsplat", fs::path(SKETCHSPLAT_SYNTHESIS_FOLDER)}) {
    void* library = ::dlopen((folder / kSynthesisPluginFile).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) continue;
    using Get = const SynthesisPlugin*();
    return *reinterpret_cast<Get*>(::dlsym(library, kSynthesisPluginSymbol))();
  }
  throw std::runtime_error(std::string(kSynthesisPluginFile) + " cannot be loaded: " + ::dlerror());
}

void run_synthesize(SynthesizeArguments arguments, const CommonOptions& common,
                    Progress* progress) {
  arguments.options.seed = std::uint64_t(common.seed);
  const SynthesisPlugin& plugin = load_plugin();
  const std::unique_ptr<SyntheticScene, void (*)(SyntheticScene*)> made(
      plugin.synthesize(arguments.options), plugin.release);
  const SyntheticScene& scene = *made;
  prepare_output_folder(arguments.out);
  {
    Stage stage("render", 0, nullptr, progress);
    plugin.write_scene(scene, arguments.out);
    stage.result(std::to_string(scene.views.size()) + " views");
  }
  std::cout << arguments.out << ": " << scene.views.size() << " views, "
            << scene.truth.curves.size() << " true edges\n";
}

std::string part_words() {
  std::string words = "A STEP file, a mesh (OBJ, STL, PLY, OFF) or one of";
  for (const std::string& name : part_names()) words += " " + name;
  return words;
}

void list_scene_fields(SynthesizeOptions* o, Fields* f) {
  f->group("Cameras");
  f->choose("rig", &o->rig.kind, {"sphere", "upper", "ring"}, "Where the cameras stand");
  f->add("views", &o->rig.views, "cameras", 1, 100000, "Number of pictures");
  f->add("resolution", &o->rig.resolution, "px", 16, 8192, "Width and height of the pictures");
  f->add("focal", &o->rig.focal, "px", 0, 1e6, "Focal length; 0 is that of ABC-NEF");
  f->add("distance", &o->rig.distance, "extents", 1.6, 1000, "Of the cameras from the origin");
  f->add("elevation", &o->rig.elevation_deg, "deg", -85, 85, "Of the cameras of a ring");
  f->group("Pictures");
  f->add("noise", &o->render.noise, "grey levels", 0, 100, "Standard deviation of the noise");
  f->add("blur", &o->render.blur, "px", 0, 20, "Standard deviation of the blur");
  f->add("exposure", &o->render.exposure, "stops", 0, 2, "Standard deviation of the exposure");
  f->add("transparent", &o->render.transparent, "Leave the background out (alpha)");
  f->add("background", &o->render.background, "", 0, 1,
         "Grey of the background if it is not left out");
  f->group("Object");
  f->add("extent", &o->extent, "world units", 1e-9, 1e9, "Longest side of the object");
  f->add("smooth-angle", &o->smooth_angle_deg, "deg", 0.01, 89,
         "Faces that meet at less have no edge");
  f->add("crease-angle", &o->crease_deg, "deg", 1, 180,
         "Facets of a mesh that meet at more have an edge");
}

}  // namespace

Verb synthesize_verb() {
  const auto arguments = std::make_shared<SynthesizeArguments>();
  Fields f;
  f.group("Arguments");
  f.add("part", &arguments->options.part, "PART", part_words()).positional = true;
  Field& out = f.add("out", &arguments->out, "SCENE", "The scene folder to write");
  out.required = true;
  out.short_name = "o";
  list_scene_fields(&arguments->options, &f);
  Verb verb;
  verb.name = "synthesize";
  verb.summary = "Render a part with exact ground truth as a scene";
  verb.examples = {"sketchsplat synthesize --out scenes/part",
                   "sketchsplat synthesize bracket.step --out scenes/bracket --views 30 --noise 3",
                   "sketchsplat synthesize bracket.stl --out scenes/bracket --crease-angle 40"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_synthesize(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

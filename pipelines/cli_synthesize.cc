// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>
#include <sstream>

#include "datasets/errors.h"
#include "datasets/synthetic/outputs.h"
#include "datasets/synthetic/part_table.h"
#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"
#include "pipelines/run_report.h"
#include "pipelines/synthesis_plugin.h"

namespace sketchsplat {
namespace {

struct SynthesizeArguments {
  std::string out;
  std::string parameters;  // NAME=VALUE, one a line
  bool list_parts = false;
  SynthesizeOptions options;
};

// The user's NAME=VALUE lines for this part.
PartValues part_values(const std::string& part, const std::string& lines) {
  PartValues values;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const size_t equals = line.find('=');
    Field value;
    double number = 0;
    value.name = "param";
    value.value = &number;
    if (equals == std::string::npos)
      throw UsageError("--param: expected NAME=VALUE, got '" + line + "'");
    assign(value, line.substr(equals + 1));
    values.push_back({line.substr(0, equals), number});
  }
  const PartSpec* spec = find_part(part);
  if (!values.empty() && !spec)
    throw UsageError("--param: only built-in parts have parameters, " + part + " is none");
  const std::string wrong = spec ? wrong_values(*spec, values) : "";
  if (!wrong.empty()) throw UsageError("--param: " + wrong);
  return values;
}

void run_synthesize(SynthesizeArguments arguments, const CommonOptions& common,
                    Progress* progress) {
  if (arguments.list_parts) {
    std::cout << part_listing(part_specs());
    return;
  }
  SynthesizeOptions& options = arguments.options;
  options.seed = std::uint64_t(common.seed);
  if (options.rig.focal > 0 && options.rig.object_size > 0)
    throw UsageError("--object-size sets the focal length: leave --focal out");
  try {
    parse_outputs(options.outputs);
  } catch (const InputError& e) {
    throw UsageError(std::string("--") + e.what());
  }
  options.parameters = part_values(options.part, arguments.parameters);
  const SynthesisPlugin& plugin = synthesis_plugin();
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

void list_camera_fields(SynthesizeOptions* o, Fields* f) {
  f->group("Cameras");
  f->choose("rig", &o->rig.kind, {"sphere", "upper", "ring", "random", "one-sided"},
            "Where the cameras stand");
  f->add("views", &o->rig.views, "cameras", 1, 100000, "Number of pictures");
  f->add("resolution", &o->rig.resolution, "px", 16, 8192, "Width and height of the pictures");
  f->add("focal", &o->rig.focal, "px", 0, 1e6, "Focal length; 0 is that of ABC-NEF");
  f->add("object-size", &o->rig.object_size, "image widths", 0, 10,
         "Of the longest side at --distance, instead of --focal; 0 leaves it to that");
  f->add("distance", &o->rig.distance, "extents", 1.6, 1000, "Of the cameras from the origin");
  f->add("elevation", &o->rig.elevation_deg, "deg", -85, 85, "Of the cameras of a ring");
  f->add("spread", &o->rig.spread_deg, "deg", 1, 180, "Half-angle of the cone of a one-sided rig");
}

void list_picture_fields(SynthesizeOptions* o, Fields* f) {
  RenderOptions& r = o->render;
  f->group("Pictures");
  f->choose("style", &r.style, {"plain", "textured", "speckled", "dark", "glossy", "shadowed"},
            "Surface and light of the object");
  f->add("texture-strength", &r.texture_strength, "", 0, 1, "Contrast of what textured and speckled print");
  f->add("even-light", &r.even_light, "share", 0, 1,
         "Of the light comes evenly from all sides, as in a light tent: faces get one shade");
  f->add("noise", &r.noise, "grey levels", 0, 100, "Standard deviation of the noise");
  f->add("blur", &r.blur, "px", 0, 20, "Standard deviation of the blur");
  f->add("exposure", &r.exposure, "stops", 0, 2, "Standard deviation of the exposure");
  f->add("jpeg", &r.jpeg, "quality", 0, 100,
         "Compress and decode the pictures before they are written; 0 does not");
  f->add("clutter", &r.clutter, "Put a room full of things behind the object; no alpha then");
  f->add("transparent", &r.transparent, "Leave the background out (alpha)");
  f->add("background", &r.background, "", 0, 1, "Grey of the background if it is not left out");
  f->add("outputs", &o->outputs, "NAMES",
         "Beside the pictures: all, none or some of mask,depth,normal,edges");
  f->group("Damage");
  DegradeOptions& d = o->degrade;
  f->add("pose-noise", &d.pose_noise_px, "px", 0, 100,
         "Mean shift of the object's points by errors of the poses as stated");
  f->add("focal-error", &d.focal_error_percent, "%", -50, 50,
         "How much the focal length as stated is too large");
  f->add("missing", &d.missing, "share", 0, 1, "Of the frames have no image file");
  f->add("truncated", &d.truncated, "share", 0, 1, "Of the frames have half an image file");
}

void list_object_fields(SynthesizeOptions* o, Fields* f) {
  f->group("Object");
  f->add("extent", &o->extent, "world units", 1e-9, 1e9, "Longest side of the object");
  f->add("smooth-angle", &o->smooth_angle_deg, "deg", 0.01, 89,
         "Faces that meet at less have no edge");
  f->add("crease-angle", &o->crease_deg, "deg", 1, 180,
         "Facets of a mesh that meet at more have an edge");
}

void list_part_fields(SynthesizeArguments* a, Fields* f) {
  Field& param = f->add("param", &a->parameters, "NAME=VALUE",
                        "A dimension of a built-in part, otherwise drawn; may be repeated");
  param.several = true;
  f->add("list-parts", &a->list_parts, "Print the built-in parts and their dimensions, no scene")
      .alone = true;
}

}  // namespace

Verb synthesize_verb() {
  const auto arguments = std::make_shared<SynthesizeArguments>();
  Fields f;
  f.group("Arguments");
  f.add("part", &arguments->options.part, "PART",
        "A STEP file, a mesh (OBJ, STL, PLY, OFF) or a built-in part: see --list-parts")
      .positional = true;
  Field& out = f.add("out", &arguments->out, "SCENE", "The scene folder to write");
  out.required = true;
  out.short_name = "o";
  list_camera_fields(&arguments->options, &f);
  list_picture_fields(&arguments->options, &f);
  list_object_fields(&arguments->options, &f);
  list_part_fields(arguments.get(), &f);
  Verb verb;
  verb.name = "synthesize";
  verb.summary = "Render a part with exact ground truth as a scene";
  verb.examples = {
      "sketchsplat synthesize --out scenes/part",
      "sketchsplat synthesize rib-plate --out scenes/narrow --param gap=0.01",
      "sketchsplat synthesize bracket.step --out scenes/bracket --views 30 --noise 3",
      "sketchsplat synthesize bracket.stl --out scenes/bracket --crease-angle 40",
      "sketchsplat synthesize flange --out scenes/hard --style glossy --clutter --jpeg 80"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_synthesize(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

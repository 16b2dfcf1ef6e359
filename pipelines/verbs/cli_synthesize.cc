// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "datasets/synthetic/catalogue/outputs.h"
#include "datasets/synthetic/catalogue/part_table.h"
#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/run_report.h"
#include "pipelines/command/cli.h"
#include "pipelines/verbs/synthesis_plugin.h"
#include "sketches/io/json.h"

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
  for (const std::string& line : lines_of(lines)) {
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

Json json_of_parts() {
  Json parts = Json::object();
  for (const PartSpec& spec : part_specs()) {
    parts[spec.name] = Json::object();
    for (const PartParameter& p : spec.parameters)
      parts[spec.name][p.name] = {
          {"unit", p.unit}, {"drawn", {p.low, p.high}}, {"allowed", {p.least, p.most}}};
  }
  return parts;
}

void run_synthesize(SynthesizeArguments arguments, const CommonOptions& common,
                    Progress* progress) {
  if (arguments.list_parts) {
    if (common.json)
      print_json(json_of_parts());
    else
      std::cout << part_listing(part_specs());
    return;
  }
  SynthesizeOptions& options = arguments.options;
  options.seed = std::uint64_t(common.seed);
  if (options.rig.focal > 0 && options.rig.object_size > 0)
    throw UsageError("--object-size sets the focal length: leave --focal out");
  if (options.rig.distance > 0 && options.rig.distance < 1.6)
    throw UsageError("--distance: expected 1.6 or more, or 0, got " +
                     std::to_string(options.rig.distance));
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
    Stage stage("render", {nullptr, progress});
    plugin.write_scene(scene, arguments.out);
    stage.result(std::to_string(scene.views.size()) + " views");
  }
  if (common.json)
    print_json({{"scene", arguments.out},
                {"views", scene.views.size()},
                {"true_edges", scene.truth.curves.size()}});
  else
    std::cout << arguments.out << ": " << scene.views.size() << " views, "
              << scene.truth.curves.size() << " true edges\n";
}

void list_camera_fields(SynthesizeOptions* o, Fields* f) {
  f->group("Cameras");
  f->choose("rig", &o->rig.kind,
            {"sphere", "upper", "ring", "random", "one-sided", "hemisphere", "auto"},
            "Arrangement of the cameras; auto: hemisphere with --style photo, else sphere");
  f->add("views", &o->rig.views, "cameras", 1, 100000, "Number of images");
  f->add("resolution", &o->rig.resolution, "px", 16, 8192, "Width of the images");
  f->add("height", &o->rig.height, "px", 0, 8192,
         "Height of the images; 0: the width, with --style photo three quarters of it");
  f->add("focal", &o->rig.focal, "px", 0, 1e6,
         "Focal length; 0: that of ABC-NEF, with --style photo 1.15 widths");
  f->add("object-size", &o->rig.object_size, "image widths", 0, 10,
         "Size of the object in the images, instead of --focal; 0: by the focal length");
  f->add("distance", &o->rig.distance, "extents", 0, 1000,
         "Distance of the cameras from the object; 0: 4, with --style photo 2.6");
  f->add("elevation", &o->rig.elevation_deg, "deg", -85, 85, "Elevation of the cameras of a ring");
  f->add("spread", &o->rig.spread_deg, "deg", 1, 180, "Half-angle of the cone of a one-sided rig");
}

void list_picture_fields(SynthesizeOptions* o, Fields* f) {
  RenderOptions& r = o->render;
  f->group("Pictures");
  f->choose("style", &r.style,
            {"plain", "textured", "speckled", "dark", "glossy", "shadowed", "photo"},
            "Surface and light of the object; photo: JPEG photographs on a table in a room");
  f->add("texture-strength", &r.texture_strength, "", 0, 1,
         "Contrast of textured and speckled surfaces");
  f->add("even-light", &r.even_light, "share", 0, 1,
         "Share of the light that comes evenly from all sides, as in a light tent");
  f->add("noise", &r.noise, "grey levels", 0, 100, "Standard deviation of the noise");
  f->add("blur", &r.blur, "px", 0, 20, "Standard deviation of the blur");
  f->add("exposure", &r.exposure, "stops", 0, 2, "Standard deviation of the exposure");
  f->add("jpeg", &r.jpeg, "quality", 0, 100,
         "Compress the images once before they are written; 0: not; with --style photo the quality "
         "of the files, 0: 92");
  f->add("clutter", &r.clutter, "Put a cluttered room behind the object; then without alpha");
  f->add("transparent", &r.transparent, "Make the background transparent (alpha)");
  f->add("background", &r.background, "", 0, 1, "Grey of the background if it is not transparent");
  f->add("outputs", &o->outputs, "NAMES",
         "More files: all, none or some of mask,depth,normal,edges; not with --style photo");
  f->group("Damage");
  DegradeOptions& d = o->degrade;
  f->add("pose-noise", &d.pose_noise_px, "px", 0, 100,
         "Mean shift of the object's points by errors of the stated poses");
  f->add("focal-error", &d.focal_error_percent, "%", -50, 50, "Error of the stated focal length");
  f->add("missing", &d.missing, "share", 0, 1, "Share of the frames without an image file");
  f->add("truncated", &d.truncated, "share", 0, 1, "Share of the frames with half an image file");
}

void list_photo_fields(SynthesizeOptions* o, Fields* f) {
  f->group("Photographs (--style photo)");
  PhotoOptions& p = o->photo;
  f->choose("surface", &p.surface, {"painted", "metal", "printed", "speckled"},
            "Material of the part; printed: in layers");
  f->choose("up", &p.up, {"z", "-z", "y", "-y", "x", "-x"}, "Axis of the part that points up");
  f->add("distortion", &p.distortion, "", 0, 3,
         "Strength of the lens distortion; 0: pinhole, 1: usual");
  f->add("state-lens", &p.state_lens, "Write the lens into the model; without it, a pinhole");
  f->add("masks", &p.masks, "Write masks of the part");
  f->add("tag", &p.tag, "id", -1, 586, "AprilTag 36h11 on the table; -1: none");
  f->add("tag-size", &p.tag_size, "world units", 0, 1e9,
         "Edge of the tag's black square; 0: a quarter of the extent");
  f->add("pose-error", &p.pose_error_px, "px", 0, 50,
         "RMS shift of the part's edges by errors of the model's cameras, which are correlated "
         "as COLMAP's are");
}

void list_object_fields(SynthesizeOptions* o, Fields* f) {
  f->group("Object");
  f->add("extent", &o->extent, "world units", 1e-9, 1e9, "Longest side of the object");
  f->add("smooth-angle", &o->smooth_angle_deg, "deg", 0.01, 89,
         "Faces that meet at a smaller angle have no edge");
  f->add("crease-angle", &o->crease_deg, "deg", 1, 180,
         "Facets of a mesh that meet at a larger angle have an edge");
}

void list_part_fields(SynthesizeArguments* a, Fields* f) {
  Field& param = f->add("param", &a->parameters, "NAME=VALUE",
                        "A dimension of a built-in part, otherwise random; may be repeated");
  param.several = true;
  f->add("list-parts", &a->list_parts, "Only print the built-in parts and their dimensions").alone =
      true;
}

}  // namespace

Verb synthesize_verb() {
  const auto arguments = std::make_shared<SynthesizeArguments>();
  Fields f;
  f.group("Arguments");
  f.add("part", &arguments->options.part, "PART",
        "A STEP file, a mesh (OBJ, STL, PLY, OFF) or a built-in part (--list-parts)")
      .positional = true;
  Field& out = f.add("out", &arguments->out, "SCENE", "The scene folder to write");
  out.required = true;
  out.short_name = "o";
  list_camera_fields(&arguments->options, &f);
  list_picture_fields(&arguments->options, &f);
  list_photo_fields(&arguments->options, &f);
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
      "sketchsplat synthesize flange --out scenes/hard --style glossy --clutter --jpeg 80",
      "sketchsplat synthesize flange --out scenes/photos --style photo --views 30 --tag 0"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_synthesize(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

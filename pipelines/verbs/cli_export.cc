// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/sketch_input.h"
#include "pipelines/command/cli.h"
#include "pipelines/pages/overlay.h"
#include "pipelines/results/brep_plugin.h"
#include "pipelines/results/known_scale.h"
#include "pipelines/results/outputs.h"
#include "pipelines/results/report.h"
#include "pipelines/survey/confidence.h"
#include "sketches/io/io.h"
#include "sketches/io/io_glb.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

struct ExportArguments {
  std::string sketch, out, solid;
  std::string format;  // empty: by the ending of `out`
  CadOptions cad;
  double min_confidence = 0;
  double deflection = 1e-4;
  double spacing = kPointSpacing;
};

constexpr char kNoTags[] = "--scale-by tag is for reconstruct: a sketch holds no tags";

const std::vector<std::string> kFormats = {"step", "dxf",        "obj",   "glb",
                                           "ply",  "parametric", "sketch"};

// The format that the ending of a file name stands for; empty if none.
std::string format_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".step" || ending == ".stp") return "step";
  for (const char* same : {"dxf", "obj", "glb", "ply"})
    if (ending == std::string(".") + same) return same;
  if (ending == ".json") return "parametric";
  return "";
}

// Members of sketch.json beside the sketch: the options, the names of the views.
std::string other_members(const std::string& path, const KnownScale& scale) {
  std::ifstream in(path);
  Json j = parse_json<Json>(in, path);
  for (const char* key : {"format_version", "nodes", "strokes"}) j.erase(key);
  if (!scale.source.empty()) j["scale"] = parse_json<Json>(scale_json(scale));
  return json_text(j);
}

// From the options, or else from the file.
KnownScale scale_of(const Sketch& sketch, const ExportArguments& arguments) {
  const CadOptions& cad = arguments.cad;
  if (!cad.scale_given && !has_reference(cad))
    return stated_scale(cad, sketch_file(arguments.sketch));
  return known_scale(cad, sketch, sketch_origin(arguments.sketch).footprint, {});
}

void write(std::ostream& out, const Sketch& sketch, const ExportArguments& arguments,
           const KnownScale& scale, const std::string& format) {
  const std::string name = std::filesystem::path(arguments.out).stem().string();
  const CadOptions cad = at_scale(arguments.cad, scale);
  if (format == "step") {
    write_step(out, sketch, step_options(sketch, name, cad));
  } else if (format == "dxf") {
    write_dxf(out, sketch, {cad.scale, cad.unit});
  } else if (format == "obj") {
    write_obj(out, sketch, arguments.deflection, cad.scale);
  } else if (format == "glb") {
    write_glb(out, sketch, {name, cad.scale * millimetres(cad.unit) / 1000});
  } else if (format == "ply") {
    const double size = sketch_extent(sketch).size;
    write_edge_points(out, sketch, arguments.spacing * (size > 0 ? size : 1));
  } else if (format == "parametric") {
    write_parametric_edges(out, sketch);
  } else {
    write_sketch_json(out, sketch, other_members(sketch_file(arguments.sketch), scale));
  }
}

// Refuses options that do not apply to the format.
void check(const ExportArguments& arguments, const std::string& format) {
  const bool cad = format == "step" || format == "dxf" || format == "obj" || format == "glb";
  check_scale(arguments.cad);
  if (wants_tags(arguments.cad)) throw UsageError(kNoTags);
  if (!cad && format != "sketch" && has_reference(arguments.cad))
    throw UsageError("--scale-by is for step, dxf, obj and sketch: " + format +
                     " is in the scene's own units");
  if (!cad && arguments.cad.scale != 1)
    throw UsageError("--scale is for step, dxf, obj and glb: " + format +
                     " is in the scene's own units");
  if (format != "step" && arguments.cad.faces)
    throw UsageError("--faces is for step: " + format + " holds curves only");
}

// Strokes of unknown confidence stay.
Sketch confident(const Sketch& sketch, double least, const std::string& path, Progress* progress) {
  if (!(least > 0)) return sketch;
  const bool known = std::any_of(sketch.evidence.begin(), sketch.evidence.end(),
                                 [](const Evidence& e) { return !std::isnan(e.confidence); });
  if (!known && sketch.size() > 0)
    progress->warn(path + " has no confidences: --min-confidence leaves nothing out");
  return keep_confident(sketch, least);
}

// The solid that reconstruct chose; without images none can be searched for.
void export_solid(const ExportArguments& arguments, bool json) {
  const Solid solid = read_solid(arguments.sketch);
  const CadOptions& options = arguments.cad;
  const KnownScale scale = options.scale_given || has_reference(options)
                               ? scale_of(read_sketch(arguments.sketch), arguments)
                               : stated_scale(options, solid_file(arguments.sketch));
  const CadOptions cad = at_scale(options, scale);
  const std::string name = std::filesystem::path(arguments.solid).stem().string();
  const SolidCheck check =
      brep_plugin().write_solid_step(solid, arguments.solid, {name, cad.scale, cad.unit});
  if (!check.valid) throw InputError(solid_file(arguments.sketch), "a closed solid", check.why);
  if (json)
    print_json({{"file", arguments.solid}, {"format", "step"}, {"faces", solid.faces.size()}});
}

void run_export(const ExportArguments& arguments, bool json, Progress* progress) {
  if (!arguments.solid.empty()) {
    check_scale(arguments.cad);
    if (wants_tags(arguments.cad)) throw UsageError(kNoTags);
    export_solid(arguments, json && arguments.out.empty());
    if (arguments.out.empty()) return;
  }
  const std::string format = arguments.format.empty() ? format_of(arguments.out) : arguments.format;
  if (format.empty())
    throw UsageError("--format: expected one of step, dxf, obj, glb, ply, parametric, sketch, as " +
                     arguments.out + " has none of their endings");
  check(arguments, format);
  const Sketch all = read_sketch(arguments.sketch);
  const Sketch sketch = confident(all, arguments.min_confidence, arguments.sketch, progress);
  const KnownScale scale = scale_of(all, arguments);
  write_atomically(arguments.out,
                   [&](std::ostream& out) { write(out, sketch, arguments, scale, format); });
  const int left_out = all.size() - sketch.size();
  if (json)
    print_json({{"file", arguments.out},
                {"format", format},
                {"curves", sketch.size()},
                {"left_out", left_out}});
  else if (arguments.min_confidence > 0)
    std::cout << sketch.size() << " curves, " << left_out << " less probable ones left out\n";
}

}  // namespace

Verb export_verb() {
  const auto arguments = std::make_shared<ExportArguments>();
  Fields f;
  f.group("Arguments");
  Field& sketch = f.add("sketch", &arguments->sketch, "SKETCH.json",
                        "The sketch.json of a reconstruction, or its folder");
  sketch.required = sketch.positional = true;
  Field& out = f.add("out", &arguments->out, "FILE", "The file to write");
  out.required = true;
  out.unless = "solid";
  out.short_name = "o";
  f.add("solid", &arguments->solid, "FILE.step",
        "Write the solid of a reconstruction, from solid.json beside the sketch");
  f.choose("format", &arguments->format, kFormats, "Format of FILE; default: by its ending");
  f.group("Output");
  f.add("min-confidence", &arguments->min_confidence, "", 0, 1,
        "Leave out curves that are less probable than this");
  f.add("deflection", &arguments->deflection, "of the extent", 1e-7, 0.1,
        "Largest distance of a chord to its curve in OBJ");
  f.add("spacing", &arguments->spacing, "of the extent", 1e-5, 1, "Distance of the samples in PLY");
  list_fields(&arguments->cad, &f);
  f.add("faces", &arguments->cad.faces, "Write closed planar loops as faces in STEP");
  Verb verb;
  verb.name = "export";
  verb.summary = "Write a sketch in another format";
  verb.examples = {"sketchsplat export out/part/sketch.json --out part.step --unit inch --scale 2",
                   "sketchsplat export out/part -o part.step --faces --scale 50",
                   "sketchsplat export out/part -o part.dxf --scale-by circle:12=25.4mm",
                   "sketchsplat export out/part -o part.obj --deflection 1e-5",
                   "sketchsplat export out/part --solid part_solid.step --scale 50 --unit cm"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_export(*arguments, common.json, progress);
  };
  return verb;
}

}  // namespace sketchsplat

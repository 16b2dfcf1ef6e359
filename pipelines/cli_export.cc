// SPDX-License-Identifier: MIT
#include <cctype>
#include <filesystem>
#include <fstream>
#include <memory>

#include "datasets/errors.h"
#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"
#include "pipelines/outputs.h"
#include "pipelines/report.h"
#include "sketches/io.h"

namespace sketchsplat {
namespace {

struct ExportArguments {
  std::string sketch, out;
  std::string format;  // empty: by the ending of `out`
  double scale = StepOptions().scale;
  double deflection = 1e-4;
  double spacing = OutputOptions().point_spacing;
};

const std::vector<std::string> kFormats = {"step", "obj", "ply", "parametric", "sketch"};

// The format that the ending of a file name stands for; empty if none.
std::string format_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".step" || ending == ".stp") return "step";
  if (ending == ".obj") return "obj";
  if (ending == ".ply") return "ply";
  if (ending == ".json") return "parametric";
  return "";
}

// Accepts the folder that `reconstruct` wrote, too.
Sketch read_sketch(const std::string& given) {
  namespace fs = std::filesystem;
  std::error_code none;
  const std::string path = fs::is_directory(given, none) ? given + "/sketch.json" : given;
  std::ifstream in(path);
  if (!in) throw InputError(path, "a sketch.json", "no file that can be read");
  return read_sketch_json(in, path);
}

void write(std::ostream& out, const Sketch& sketch, const ExportArguments& arguments,
           const std::string& format) {
  if (format == "step") {
    StepOptions options;
    options.name = std::filesystem::path(arguments.out).stem().string();
    options.scale = arguments.scale;
    write_step(out, sketch, options);
  } else if (format == "obj") {
    write_obj(out, sketch, arguments.deflection);
  } else if (format == "ply") {
    const double size = sketch_extent(sketch).size;
    write_edge_points(out, sketch, arguments.spacing * (size > 0 ? size : 1));
  } else if (format == "parametric") {
    write_parametric_edges(out, sketch);
  } else {
    write_sketch_json(out, sketch);
  }
}

void run_export(const ExportArguments& arguments) {
  const std::string format = arguments.format.empty() ? format_of(arguments.out) : arguments.format;
  if (format.empty())
    throw UsageError("--format is needed: the name " + arguments.out + " does not tell it");
  const Sketch sketch = read_sketch(arguments.sketch);
  write_atomically(arguments.out,
                   [&](std::ostream& out) { write(out, sketch, arguments, format); });
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
  out.short_name = "o";
  f.choose("format", &arguments->format, kFormats, "If left out, the ending of FILE decides");
  f.group("Output");
  f.add("scale", &arguments->scale, "mm per world unit", 1e-9, 1e9, "Size of a world unit in STEP");
  f.add("deflection", &arguments->deflection, "of the extent", 1e-7, 0.1,
        "Largest distance of a chord to its curve in OBJ");
  f.add("spacing", &arguments->spacing, "of the extent", 1e-5, 1, "Distance of the samples in PLY");
  Verb verb;
  verb.name = "export";
  verb.summary = "Write a sketch in another format";
  verb.examples = {"sketchsplat export out/part/sketch.json --format step --out part.step",
                   "sketchsplat export out/part -o part.obj --deflection 1e-5"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions&, Progress*) { run_export(*arguments); };
  return verb;
}

}  // namespace sketchsplat

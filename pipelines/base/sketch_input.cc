// SPDX-License-Identifier: MIT
#include "pipelines/base/sketch_input.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "sketches/io/io.h"
#include "sketches/io/io_solid.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace fs = std::filesystem;

std::string sketch_file(const std::string& given) {
  std::error_code none;
  return fs::is_directory(given, none) ? given + "/sketch.json" : given;
}

Sketch read_sketch(const std::string& given) {
  const std::string path = sketch_file(given);
  std::ifstream in(path);
  if (!in) throw InputError(path, "a sketch.json", "no file that can be read");
  return read_sketch_json(in, path);
}

std::string solid_file(const std::string& given) {
  return (fs::path(sketch_file(given)).parent_path() / "solid.json").string();
}

Solid read_solid(const std::string& given) {
  const std::string path = solid_file(given);
  std::ifstream in(path);
  if (!in) throw InputError(path, "the solid that reconstruct found", "no file that can be read");
  return read_solid_json(in, path);
}

SketchOrigin sketch_origin(const std::string& given) {
  SketchOrigin out;
  const Json sketch = json_of_file(sketch_file(given));
  if (sketch.is_object() && sketch.contains("footprint") && sketch["footprint"].is_number())
    out.footprint = sketch["footprint"].get<double>();
  if (sketch.is_object() && sketch.contains("pose_scale_sigma") &&
      sketch["pose_scale_sigma"].is_number())
    out.pose_scale_sigma = sketch["pose_scale_sigma"].get<double>();
  const Json report =
      json_of_file((fs::path(sketch_file(given)).parent_path() / "report.json").string());
  const auto folder = Json::json_pointer("/scene/folder");
  if (report.is_object() && report.contains(folder) && report[folder].is_string())
    out.scene = report[folder].get<std::string>();
  std::error_code none;
  if (!out.scene.empty() && !fs::is_directory(out.scene, none)) out.scene.clear();
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/results/solid_output.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/results/brep_plugin.h"
#include "sketches/io/io_solid.h"
#include "sketches/io/json.h"

namespace sketchsplat {

namespace {

constexpr double kDeflection = 2e-3;  // of the extent: of meshes to look at
constexpr const char* kFiles[] = {"/solid.step", "/solid.json", "/surfaces.csv", "/dimensions.csv"};

// Checks a solid and, if it is valid, writes it to `path`.
SolidCheck checked(const Solid& solid, const std::string& path, const StepSolidOptions& options) {
  try {
    return brep_plugin().write_solid_step(solid, path, options);
  } catch (const OutputError&) {
    throw;
  } catch (const std::runtime_error& e) {  // the plug-in is not installed
    SolidCheck none;
    none.why = e.what();
    return none;
  }
}

void write_tables(const std::string& folder, const SolidOutputOptions& options, SolidOutcome* out) {
  std::vector<double> areas;
  for (const FaceMesh& face : out->mesh) areas.push_back(face.area);
  TableScale scale;
  if (!options.scale.source.empty())
    scale = {length_unit_names()[int(options.scale.unit)], options.scale.units_per_world,
             options.scale.sigma_relative};
  out->tables = solid_tables(*out->search.solid, areas, options.sigma, scale);
  write_text(folder + "/surfaces.csv", out->tables->surfaces_csv);
  write_text(folder + "/dimensions.csv", out->tables->dimensions_csv);
  write_atomically(folder + "/solid.json", [&](std::ostream& file) {
    write_solid_json(file, *out->search.solid, options.extra);
  });
}

}  // namespace

SolidOutcome write_solid(const std::string& folder, const SolidSearch& search,
                         const SolidOutputOptions& options) {
  SolidOutcome out;
  out.search = search;
  out.why = search.why;
  std::error_code ignored;
  for (const char* file : kFiles) std::filesystem::remove(folder + file, ignored);
  if (search.solid) {
    out.check = checked(*search.solid, folder + "/solid.step", options.step);
    out.written = out.check.valid;
    out.why = out.check.why;
  }
  if (out.written) {
    out.mesh = brep_plugin().mesh_solid(*search.solid, kDeflection);
    write_tables(folder, options, &out);
  }
  return out;
}

namespace {

std::map<std::string, int> faces_by_kind(const Solid& solid) {
  std::map<std::string, int> faces;
  for (const SolidFace& face : solid.faces)
    ++faces[surface_name(solid.surfaces[face.surface].kind)];
  return faces;
}

}  // namespace

std::string solid_json(const SolidOutcome& outcome) {
  Json json = {{"written", outcome.written}};
  if (!outcome.written) json["why"] = outcome.why;
  const SolidSearch& search = outcome.search;
  json["doubtful_curves"] = search.doubtful;
  json["margin_nat"] = search.margin;
  json["mask_rays"] = search.rays;
  json["mask_rays_contradicted"] = search.contradicted;
  json["surfaces_tried"] = search.surfaces;
  json["cells_tried"] = search.cells;
  if (search.solid) {
    const Solid& solid = *search.solid;
    json["faces"] = faces_by_kind(solid);
    json["inferred_edges"] = std::count(solid.inferred.begin(), solid.inferred.end(), true);
    json["gap"] = solid.gap;
  }
  if (outcome.written) {
    json["volume"] = outcome.check.volume;
    json["area"] = outcome.check.area;
    json["tolerance"] = outcome.check.tolerance;
  }
  if (outcome.tables) {
    json["unit"] = outcome.tables->unit;
    json["surfaces"] = parse_json<Json>(outcome.tables->surfaces_json);
    json["dimensions"] = parse_json<Json>(outcome.tables->dimensions_json);
  }
  return json_text(json);
}

}  // namespace sketchsplat

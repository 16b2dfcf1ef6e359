// SPDX-License-Identifier: MIT
#include "pipelines/results/solid_output.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "datasets/types/errors.h"
#include "pipelines/results/brep_plugin.h"

namespace sketchsplat {

SolidOutcome write_solid(const std::string& folder, const SolidSearch& search,
                         const StepSolidOptions& options) {
  SolidOutcome out{search, {}, false, search.why};
  const std::string path = folder + "/solid.step";
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  if (!search.solid) return out;
  try {
    out.check = brep_plugin().write_solid_step(*search.solid, path, options);
    out.written = out.check.valid;
    out.why = out.check.why;
  } catch (const OutputError&) {
    throw;
  } catch (const std::runtime_error& e) {  // the plug-in is not installed
    out.why = e.what();
  }
  return out;
}

std::string solid_json(const SolidOutcome& outcome) {
  using Json = nlohmann::ordered_json;
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
    std::map<std::string, int> faces;
    for (const SolidFace& face : solid.faces)
      ++faces[surface_name(solid.surfaces[face.surface].kind)];
    json["faces"] = faces;
    json["inferred_edges"] = std::count(solid.inferred.begin(), solid.inferred.end(), true);
    json["gap"] = solid.gap;
  }
  if (outcome.written) {
    json["volume"] = outcome.check.volume;
    json["area"] = outcome.check.area;
    json["tolerance"] = outcome.check.tolerance;
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sketchsplat

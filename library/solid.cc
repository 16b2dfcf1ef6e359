// SPDX-License-Identifier: MIT
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "library/access.h"
#include "pipelines/results/brep_plugin.h"
#include "sketchsplat/curves.h"

namespace sketchsplat {

std::optional<CurveSolid> CurveSketchAccess::make(const Solid& solid, std::string* why) {
  SolidCheck check;
  try {
    check = brep_plugin().write_solid_step(solid, "", {});
  } catch (const std::runtime_error& e) {  // the plug-in is not installed
    check.why = e.what();
  }
  *why = check.why;
  if (!check.valid) return std::nullopt;
  CurveSolid out;
  for (const SolidFace& face : solid.faces)
    ++out.faces[surface_name(solid.surfaces[face.surface].kind)];
  out.volume = check.volume, out.area = check.area;
  out.inside_ = std::make_shared<const CurveSolid::Inside>(CurveSolid::Inside{solid});
  return out;
}

void CurveSolid::write(const std::string& path, const WriteOptions& options) const {
  if (ending_of(path) != ".step") throw std::invalid_argument(path + ": expected .step");
  if (!(options.scale > 0)) throw std::invalid_argument("scale: expected a positive number");
  if (!inside_) throw std::invalid_argument(path + ": expected a solid that was found");
  const std::string name = std::filesystem::path(path).stem().string();
  const SolidCheck check = brep_plugin().write_solid_step(
      inside_->solid, path, {name, options.scale, unit_of(options.unit)});
  if (!check.valid) throw std::runtime_error(path + ": " + check.why);
}

}  // namespace sketchsplat

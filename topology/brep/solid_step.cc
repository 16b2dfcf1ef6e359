// SPDX-License-Identifier: MIT
#include "topology/brep/solid_step.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Trsf.hxx>

#include "datasets/types/errors.h"
#include "sketches/curve/curve.h"
#include "topology/brep/build_solid.h"
#include "topology/brep/check.h"
#include "topology/brep/geometry.h"
#include "topology/brep/step_writer.h"

namespace sketchsplat {
namespace {

// Longest side of the box about the edges and the surfaces that have none.
double extent_of(const Solid& solid) {
  double extent = largest_extent(solid.edges);
  for (const SolidFace& face : solid.faces) {
    if (!face.loops.empty() || face.surface < 0 || face.surface >= int(solid.surfaces.size()))
      continue;
    const Surface& s = solid.surfaces[face.surface];
    extent = std::max(extent, 2 * (s.radius + s.minor_radius));
  }
  return extent;
}

SolidCheck refused(const std::string& why) {
  SolidCheck check;
  check.why = why;
  return check;
}

void write_scaled(const TopoDS_Shape& shape, double millimetres_per_unit, const std::string& path,
                  const StepSolidOptions& options) {
  gp_Trsf scale;
  scale.SetScaleFactor(millimetres_per_unit);
  BRepBuilderAPI_Transform transform(shape, scale, /*theCopyGeom=*/true);
  brep::write_step_file(transform.Shape(), options.name, options.unit, path);
}

}  // namespace

SolidCheck write_solid_step(const Solid& solid, const std::string& path,
                            const StepSolidOptions& options) {
  const double extent = extent_of(solid);
  if (!std::isfinite(extent) || !(extent > 0)) return refused("it has no extent");
  // OpenCASCADE's tolerances are absolute, meant for parts of some hundred units. A power of two
  // leaves all digits as they are.
  const double factor = std::exp2(7 - std::ceil(std::log2(extent)));
  SolidCheck check;
  try {
    brep::BuiltSolid built = brep::build_solid(scaled(solid, factor), extent * factor);
    check = brep::check_solid(solid, extent * factor, &built);
    check.volume /= factor * factor * factor;
    check.area /= factor * factor;
    check.tolerance /= factor;
    if (check.valid && !path.empty())
      write_scaled(built.shape, options.scale * millimetres(options.unit) / factor, path, options);
  } catch (const brep::Refused& why) {
    return refused(why.what());
  } catch (const Standard_Failure& failure) {
    const std::string what = failure.GetMessageString() ? failure.GetMessageString() : "";
    return refused("OpenCASCADE gives up" + (what.empty() ? "" : ": " + what));
  }
  return check;
}

}  // namespace sketchsplat

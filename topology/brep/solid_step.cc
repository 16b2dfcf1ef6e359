// SPDX-License-Identifier: MIT
#include "topology/brep/solid_step.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <cmath>
#include <gp_Trsf.hxx>
#include <new>
#include <vector>

#include "datasets/types/errors.h"
#include "topology/brep/build_solid.h"
#include "topology/brep/check.h"
#include "topology/brep/geometry.h"
#include "topology/brep/step_writer.h"

namespace sketchsplat {
namespace {

SolidCheck refused(const std::string& why) {
  SolidCheck check;
  check.why = why;
  return check;
}

void write_scaled(const brep::BuiltSolid& built, double millimetres_per_unit,
                  const std::string& path, const StepSolidOptions& options) {
  gp_Trsf scale;
  scale.SetScaleFactor(millimetres_per_unit);
  BRepBuilderAPI_Transform transform(built.shape, scale, /*theCopyGeom=*/true);
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Face& face : built.faces) faces.push_back(transform.ModifiedShape(face));
  brep::write_step_file(transform.Shape(), options.name, options.unit, path, faces);
}

}  // namespace

SolidCheck write_solid_step(const Solid& solid, const std::string& path,
                            const StepSolidOptions& options) {
  const double extent = brep::extent_of(solid);
  if (!std::isfinite(extent) || !(extent > 0)) return refused("it has no extent");
  const double factor = brep::working_scale(extent);
  SolidCheck check;
  try {
    brep::BuiltSolid built =
        brep::build_solid(scaled(solid, factor), extent * factor, options.open);
    check = options.open ? brep::check_shell(solid, extent * factor, built)
                         : brep::check_solid(solid, extent * factor, &built);
    check.volume /= factor * factor * factor;
    check.area /= factor * factor;
    check.tolerance /= factor;
    if (check.valid && !path.empty())
      write_scaled(built, options.scale * millimetres(options.unit) / factor, path, options);
  } catch (const brep::Refused& why) {
    return refused(why.what());
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    const std::string what = failure.GetMessageString() ? failure.GetMessageString() : "";
    return refused("OpenCASCADE gives up" + (what.empty() ? "" : ": " + what));
  }
  return check;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "topology/brep/solid_step.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <gp_Trsf.hxx>
#include <vector>

#include "topology/brep/build_solid.h"
#include "topology/brep/check.h"
#include "topology/brep/geometry.h"
#include "topology/brep/step_writer.h"

namespace sketchsplat {
namespace {

void write_scaled(const brep::BuiltSolid& built, const std::string& path,
                  const StepSolidOptions& options) {
  gp_Trsf scale;
  scale.SetScaleFactor(options.scale * millimetres(options.unit) / built.scale);
  BRepBuilderAPI_Transform transform(built.shape, scale, /*theCopyGeom=*/true);
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Face& face : built.faces) faces.push_back(transform.ModifiedShape(face));
  brep::write_step_file(transform.Shape(), options.name, options.unit, path, faces);
}

}  // namespace

SolidCheck write_solid_step(const Solid& solid, const std::string& path,
                            const StepSolidOptions& options) {
  try {
    return brep::with_refusals([&] {
      brep::BuiltSolid built = brep::build_solid(solid);
      const SolidCheck check = brep::check_solid(solid, &built);
      if (check.valid && !path.empty()) write_scaled(built, path, options);
      return check;
    });
  } catch (const brep::Refused& why) {
    SolidCheck check;
    check.why = why.what();
    return check;
  }
}

}  // namespace sketchsplat

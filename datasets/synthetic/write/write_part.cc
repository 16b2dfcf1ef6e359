// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write/write_part.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <gp_Trsf.hxx>

#include "topology/brep/step_writer.h"

namespace sketchsplat {

void write_part(const Brep& brep, const UnitFrame& frame, double extent, const std::string& path) {
  const double scale = frame.scale * extent;
  const Eigen::Vector3d shift = Eigen::Vector3d::Constant(0.5 * extent) - scale * frame.centre;
  gp_Trsf to_world;
  to_world.SetValues(scale, 0, 0, shift.x(), 0, scale, 0, shift.y(), 0, 0, scale, shift.z());
  BRepBuilderAPI_Transform transform(*brep.shape, to_world, /*theCopyGeom=*/true);
  brep::write_step_file(transform.Shape(), "part", LengthUnit::kMillimetre, path);
}

}  // namespace sketchsplat

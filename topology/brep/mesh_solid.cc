// SPDX-License-Identifier: MIT
#include "topology/brep/mesh_solid.h"

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <cmath>
#include <utility>

#include "topology/brep/build_solid.h"
#include "topology/brep/geometry.h"
#include "topology/brep/meshed_face.h"

namespace sketchsplat {
namespace {

FaceMesh mesh_of(const TopoDS_Face& face, double deflection, double scale) {
  const brep::MeshedFace meshed(face, deflection);
  FaceMesh out;
  for (const Eigen::Vector3d& p : meshed.points()) out.points.push_back(p / scale);
  out.triangles = meshed.triangles();
  if (face.Orientation() == TopAbs_REVERSED)
    for (std::array<int, 3>& t : out.triangles) std::swap(t[1], t[2]);
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  out.area = std::abs(properties.Mass()) / (scale * scale);
  return out;
}

}  // namespace

std::vector<FaceMesh> mesh_solid(const Solid& solid, double deflection) {
  try {
    return brep::with_refusals([&] {
      const brep::BuiltSolid built = brep::build_solid(solid);
      brep::mesh(built.shape, deflection * built.extent);
      std::vector<FaceMesh> out;
      for (const TopoDS_Face& face : built.faces)
        out.push_back(mesh_of(face, deflection * built.extent, built.scale));
      return out;
    });
  } catch (const brep::Refused&) {
    return {};
  }
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "topology/brep/mesh_solid.h"

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <cmath>
#include <new>
#include <utility>

#include "topology/brep/build_solid.h"
#include "topology/brep/geometry.h"
#include "topology/brep/meshed_face.h"

namespace sketchsplat {
namespace {

FaceMesh mesh_of(const TopoDS_Face& face, double deflection, double factor) {
  const brep::MeshedFace meshed(face, deflection);
  FaceMesh out;
  for (const Eigen::Vector3d& p : meshed.points()) out.points.push_back(p / factor);
  out.triangles = meshed.triangles();
  if (face.Orientation() == TopAbs_REVERSED)
    for (std::array<int, 3>& t : out.triangles) std::swap(t[1], t[2]);
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  out.area = std::abs(properties.Mass()) / (factor * factor);
  return out;
}

}  // namespace

std::vector<FaceMesh> mesh_solid(const Solid& solid, double deflection) {
  const double extent = brep::extent_of(solid);
  std::vector<FaceMesh> out;
  if (!std::isfinite(extent) || !(extent > 0)) return out;
  const double factor = brep::working_scale(extent);
  try {
    const brep::BuiltSolid built =
        brep::build_solid(scaled(solid, factor), extent * factor, /*open=*/true);
    brep::mesh(built.shape, deflection * extent * factor);
    for (const TopoDS_Face& face : built.faces)
      out.push_back(mesh_of(face, deflection * extent * factor, factor));
  } catch (const brep::Refused&) {
    out.clear();
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure&) {
    out.clear();
  }
  return out;
}

}  // namespace sketchsplat

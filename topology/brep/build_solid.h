// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat::brep {

struct BuiltSolid {
  /// The solid is so many times larger: OpenCASCADE's tolerances are absolute, meant for parts of
  /// some hundred units. A power of two, which leaves all digits as they are.
  double scale = 1;
  double extent = 0;               ///< longest side of its box, larger too
  TopoDS_Shape shape;              ///< a solid
  std::vector<TopoDS_Face> faces;  ///< those of Solid::faces
};
/// The exact boundary representation: edges shared by their two faces, one shell for each set of
/// connected faces. Not checked yet. Throws Refused if it has no extent, a stroke is not run once
/// in either direction, a loop is not closed, or a face cannot be.
BuiltSolid build_solid(const Solid& solid);

}  // namespace sketchsplat::brep

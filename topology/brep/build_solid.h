// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat::brep {

struct BuiltSolid {
  TopoDS_Solid shape;
  std::vector<TopoDS_Face> faces;  ///< those of Solid::faces
};
/// The exact boundary representation, in the solid's units: edges shared by their two faces, one
/// shell for each set of connected faces. Not checked yet; `extent` is the longest side of its box,
/// for tolerances. Throws Refused if a stroke is not run once in either direction, a loop is not
/// closed, or a face cannot be.
BuiltSolid build_solid(const Solid& solid, double extent);

}  // namespace sketchsplat::brep

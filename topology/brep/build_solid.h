// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat::brep {

/// Longest side of the box about the edges and the surfaces that have none.
double extent_of(const Solid& solid);

/// Factor by which solids are built larger: OpenCASCADE's tolerances are absolute, meant for parts
/// of some hundred units. A power of two, which leaves all digits as they are.
double working_scale(double extent);

struct BuiltSolid {
  TopoDS_Shape shape;              ///< a solid; of open shells, a shell or a compound of them
  std::vector<TopoDS_Face> faces;  ///< those of Solid::faces
};
/// The exact boundary representation, in the solid's units: edges shared by their two faces, one
/// shell for each set of connected faces. Not checked yet; `extent` is the longest side of its box,
/// for tolerances. Throws Refused if a stroke is not run once in either direction, a loop is not
/// closed, or a face cannot be. If it is `open`, strokes may bound one face.
BuiltSolid build_solid(const Solid& solid, double extent, bool open = false);

}  // namespace sketchsplat::brep

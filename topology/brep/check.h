// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>

#include "topology/brep/build_solid.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat::brep {

/// Turns the solid inside out if need be, and measures and checks it, in units of the solid.
SolidCheck check_solid(const Solid& solid, BuiltSolid* built);

/// What BRepCheck_Analyzer finds first, as a clause; empty if the shape is valid.
std::string fault_of(const TopoDS_Shape& shape);

/// Where it runs through itself beyond the tolerances, as a clause; empty if it does not.
std::string self_intersection(const Solid& solid, const BuiltSolid& built, double tolerance);

std::string kind_of(const TopoDS_Shape& shape);  ///< "face", "edge", ...

double volume_of(const TopoDS_Shape& shape);  ///< negative of one that looks inwards

/// Largest tolerance of an edge or a vertex.
double tolerance_of(const TopoDS_Shape& shape);

}  // namespace sketchsplat::brep

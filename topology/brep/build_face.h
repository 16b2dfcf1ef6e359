// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Face.hxx>

#include "topology/brep/edge_table.h"
#include "topology/brep/face_plan.h"

namespace sketchsplat::brep {

/// The face over the edges of the table, which gets its curves in the chart; tolerances grow to
/// what separates curves and surface.
TopoDS_Face build_face(const FacePlan& plan, const EdgeTable& edges);

}  // namespace sketchsplat::brep

// SPDX-License-Identifier: MIT
#pragma once

#include <ShapeBuild_ReShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat::brep {

/// The strokes as edges between shared vertices, with their exact curves and none on surfaces.
/// `flat`: sagitta of arcs that are lines, and how far curves may be from their surfaces.
std::vector<TopoDS_Edge> build_edges(const Solid& solid, double flat);

/// The face that these edges bound. Seams, edges of no length in poles, curves in the parameters of
/// its surface and the tolerances are those of ShapeFix_Face; `context` notes edges that a seam
/// cuts, and is to be applied to faces that were built before. Throws Refused if the loops do not
/// bound one piece of the surface. `near`: distance of places that are one.
TopoDS_Face build_face(const Solid& solid, const SolidFace& face,
                       const std::vector<TopoDS_Edge>& edges, double near,
                       const Handle(ShapeBuild_ReShape) & context);

}  // namespace sketchsplat::brep

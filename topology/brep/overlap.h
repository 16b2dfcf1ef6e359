// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <vector>

#include "topology/brep/meshed_face.h"

namespace sketchsplat::brep {

/// Intersection over union of what two closed meshes enclose, by lines along the three axes: to
/// about 1e-3. 0 if they enclose nothing.
double overlap_by_lines(const std::vector<MeshedFace>& a, const std::vector<MeshedFace>& b);

/// The same by a boolean operation; negative if OpenCASCADE cannot.
double overlap_by_boolean(const TopoDS_Shape& a, const TopoDS_Shape& b);

}  // namespace sketchsplat::brep

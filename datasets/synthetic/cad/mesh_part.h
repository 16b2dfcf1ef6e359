// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/synthetic/cad/brep.h"
#include "datasets/synthetic/cad/mesh_file.h"
#include "datasets/synthetic/cad/truth.h"

namespace sketchsplat {

/// A mesh as a part, in the unit frame.
struct MeshPart {
  SurfaceMesh surface;  ///< normals smooth across gentle edges; faces: what feature edges enclose
  Truth truth;          ///< feature edges; points lie on the mesh's own edges
  UnitFrame frame;
};

/// Feature edges are those whose triangles meet at more than `crease_deg` (1 to 180) [deg], that
/// bound one triangle or that more than two share. They are chained where two meet without a corner
/// and cut into lines, arcs, circles, ellipses and cubics through their vertices. Throws
/// InputError(`name`, ...) if no triangle has an area.
MeshPart make_mesh_part(const TriangleMesh& mesh, double crease_deg, const std::string& name);

}  // namespace sketchsplat

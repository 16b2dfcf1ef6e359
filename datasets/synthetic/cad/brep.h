// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

class TopoDS_Shape;

namespace sketchsplat {

/// A boundary representation, in the units of whoever made it. OpenCASCADE stays behind the
/// pointer.
struct Brep {
  std::shared_ptr<const TopoDS_Shape> shape;
};

/// Reads every solid, shell and face of a STEP file (AP203, AP214, AP242), in millimetres. What
/// OpenCASCADE crashes on, here or when it is asked for bounds and edges, is found in a child
/// process. Throws InputError if the file is missing, is no STEP file, holds no face, or is such a
/// one.
Brep read_step(const std::string& path);

/// Model units -> the unit frame: longest side of the bounding box 1, box centred at the origin.
struct UnitFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the box, model units
  double scale = 1.0;                                ///< unit lengths per model unit
  Eigen::Vector3d size = Eigen::Vector3d::Ones();    ///< of the box, model units
  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return (x - centre) * scale; }
};

/// From the exact geometry: no tolerance and no triangle enlarges the box.
/// Throws InputError(`name`, ...) if the shape is empty, infinite or a point.
UnitFrame unit_frame(const Brep& brep, const std::string& name);

/// Triangles of a B-rep in the unit frame. Corners carry the normal of the exact surface, so that
/// shading knows no facets; faces share the points along their common edges (watertight).
struct SurfaceMesh {
  std::vector<Eigen::Vector3f> points;           ///< per face, not shared between faces
  std::vector<Eigen::Vector3f> normals;          ///< one per point, unit, along the triangles' side
  std::vector<std::array<unsigned, 3>> corners;  ///< one per triangle, into points
  std::vector<int> face;                         ///< one per triangle: which face of the B-rep
};

/// `deflection`: largest distance of triangles from the surface, unit lengths, > 0.
/// Throws InputError(`name`, ...) if a face that could be seen has no triangles.
SurfaceMesh tessellate(const Brep& brep, const UnitFrame& frame, double deflection,
                       const std::string& name = "the part");

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <GeomAbs_SurfaceType.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopoDS_Face.hxx>
#include <array>
#include <vector>

namespace sketchsplat::brep {

/// Triangles of a face that lead to places on it and to distances from it.
class MeshedFace {
 public:
  /// Of a face of a shape that BRepMesh has been over with this deflection.
  MeshedFace(const TopoDS_Face& face, double deflection);

  GeomAbs_SurfaceType kind() const { return kind_; }
  double area() const { return area_; }  ///< of the triangles
  const Eigen::AlignedBox3d& box() const { return box_; }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

  /// Places on the surface itself, about one for each `spacing` squared, none less than `least`,
  /// evenly over the area.
  std::vector<Eigen::Vector3d> places(double spacing, int least) const;

  /// Distance of a point if it is below `bound`, else something at least as large. Of the surface
  /// itself where the foot lies inside of the face.
  double distance(const Eigen::Vector3d& p, double bound) const;

 private:
  struct Chunk {
    Eigen::AlignedBox3d box;
    int begin, end;  // triangles
  };
  void make_chunks();
  double surface_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& foot,
                          const Eigen::Vector2d& uv) const;

  GeomAbs_SurfaceType kind_;
  double deflection_, area_ = 0;
  Handle(ShapeAnalysis_Surface) surface_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector2d> uv_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Chunk> chunks_;
  Eigen::AlignedBox3d box_;
};

/// Chords stay within the deflection and a quarter of a radian of the surfaces.
void mesh(const TopoDS_Shape& shape, double deflection);

/// Meshes a shape and all of its faces.
std::vector<MeshedFace> mesh_faces(const TopoDS_Shape& shape, double deflection);

}  // namespace sketchsplat::brep

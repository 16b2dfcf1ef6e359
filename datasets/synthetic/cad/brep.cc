// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/brep.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Eigen/Geometry>
#include <GProp_GProps.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <cmath>

#include "datasets/step/guarded.h"
#include "datasets/types/errors.h"

namespace sketchsplat {

UnitFrame unit_frame(const Brep& brep, const std::string& name) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(*brep.shape, box, /*useTriangulation=*/false, /*useShapeTolerance=*/false);
  if (box.IsVoid() || box.IsOpen())
    throw InputError(name, "a bounded shape", box.IsVoid() ? "nothing" : "an infinite one");
  Eigen::Vector3d low, high;
  box.Get(low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  // Bnd_Box answers with its gap added on every side; AddOptimal leaves one of its own tolerance.
  low.array() += box.GetGap();
  high.array() -= box.GetGap();
  const double longest = (high - low).maxCoeff();
  constexpr double kLargest = 1e100;  // cubes of it overflow
  if (!(longest > 0) || !(longest < kLargest) || !((low + high).norm() < kLargest))
    throw InputError(name, "a shape with an extent below 1e100",
                     longest > 0 ? "a larger one" : std::to_string(longest));
  return {(low + high) / 2, 1.0 / longest, high - low};
}

namespace {

Eigen::Vector3d to_eigen(const gp_XYZ& v) { return {v.X(), v.Y(), v.Z()}; }

// Normal of the surface at (u, v), zero where it has none (apex of a cone, pole of a sphere).
Eigen::Vector3d surface_normal(const BRepAdaptor_Surface& surface, const gp_Pnt2d& uv) {
  gp_Pnt point;
  gp_Vec du, dv;
  surface.D1(uv.X(), uv.Y(), point, du, dv);
  const Eigen::Vector3d a = to_eigen(du.XYZ()), b = to_eigen(dv.XYZ()), n = a.cross(b);
  if (!(n.norm() > 1e-9 * a.norm() * b.norm())) return Eigen::Vector3d::Zero();
  return n.normalized();
}

// False if the face has no triangles.
bool add_face(const TopoDS_Face& face, int index, const UnitFrame& frame, SurfaceMesh* mesh) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
  if (triangles.IsNull() || triangles->NbTriangles() == 0) return false;
  const unsigned base = unsigned(mesh->points.size());
  const int n = triangles->NbNodes();
  std::vector<Eigen::Vector3d> point(n), facet(n, Eigen::Vector3d::Zero());
  for (int i = 0; i < n; ++i)
    point[i] =
        frame * to_eigen(triangles->Node(i + 1).Transformed(location.Transformation()).XYZ());
  for (int t = 1; t <= triangles->NbTriangles(); ++t) {
    int a, b, c;
    triangles->Triangle(t).Get(a, b, c);
    if (face.Orientation() == TopAbs_REVERSED) std::swap(b, c);
    const Eigen::Vector3d area = (point[b - 1] - point[a - 1]).cross(point[c - 1] - point[a - 1]);
    for (int k : {a, b, c}) facet[k - 1] += area;
    mesh->corners.push_back({base + a - 1, base + b - 1, base + c - 1});
    mesh->face.push_back(index);
  }
  const BRepAdaptor_Surface surface(face, /*Restriction=*/false);
  for (int i = 0; i < n; ++i) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (triangles->HasUVNodes()) normal = surface_normal(surface, triangles->UVNode(i + 1));
    if (normal.isZero()) normal = facet[i].normalized();
    if (normal.dot(facet[i]) < 0) normal = -normal;
    mesh->points.push_back(point[i].cast<float>());
    mesh->normals.push_back(normal.cast<float>());
  }
  return true;
}

double area_of(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  return std::abs(properties.Mass());
}

// In a child: where edges leave their face, the mesher may turn for ever. Ten times what faces
// take.
TopoDS_Shape with_triangles(const TopoDS_Shape& shape, double deflection, const std::string& name) {
  constexpr double kAngle =
      0.25;  // [rad] keeps small fillets round; the deflection rules elsewhere
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  const unsigned seconds = 10 + unsigned(faces.Extent());
  return shape_of(guarded(name, "faces that can be triangulated", seconds, [&] {
    BRepMesh_IncrementalMesh(shape, deflection, /*isRelative=*/false, kAngle,
                             /*isInParallel=*/false);
    return bytes_of(shape);
  }));
}

}  // namespace

SurfaceMesh tessellate(const Brep& brep, const UnitFrame& frame, double deflection,
                       const std::string& name) {
  const TopoDS_Shape shape = with_triangles(*brep.shape, deflection / frame.scale, name);
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  SurfaceMesh mesh;
  int bare = 0;
  // Slivers that no picture shows may stay without triangles.
  const double sliver = 1e-8 / (frame.scale * frame.scale);
  for (int f = 1; f <= faces.Extent(); ++f) {
    const TopoDS_Face face = TopoDS::Face(faces(f));
    if (!add_face(face, f - 1, frame, &mesh) && area_of(face) > sliver) ++bare;
  }
  if (bare > 0)
    throw InputError(
        name, "faces that can be triangulated",
        std::to_string(bare) + " of " + std::to_string(faces.Extent()) + " that cannot");
  return mesh;
}

}  // namespace sketchsplat

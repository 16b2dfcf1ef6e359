// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/shapes.h"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Eigen/Geometry>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>

namespace sketchsplat {
namespace {

gp_Pnt pnt(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }
gp_Vec vec(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
gp_Ax2 axis(const Vector3d& base, const Vector3d& along) {
  return gp_Ax2(pnt(base), gp_Dir(along.x(), along.y(), along.z()));
}

Handle(Geom_BSplineCurve) interpolate(const std::vector<Vector3d>& points, bool closed) {
  const Handle(TColgp_HArray1OfPnt) array = new TColgp_HArray1OfPnt(1, int(points.size()));
  for (size_t i = 0; i < points.size(); ++i) array->SetValue(int(i) + 1, pnt(points[i]));
  GeomAPI_Interpolate maker(array, closed, 1e-7);
  maker.Perform();
  return maker.Curve();
}

}  // namespace

TopoDS_Shape box(const Vector3d& corner, const Vector3d& size) {
  return BRepPrimAPI_MakeBox(pnt(corner), size.x(), size.y(), size.z());
}
TopoDS_Shape box(const Vector3d& size) { return box(Vector3d::Zero(), size); }
TopoDS_Shape box(const Dimensions& d) {
  return box(Vector3d(d["length"], d["width"], d["height"]));
}
TopoDS_Shape cylinder(const Vector3d& base, const Vector3d& along, double radius) {
  return BRepPrimAPI_MakeCylinder(axis(base, along), radius, along.norm());
}
TopoDS_Shape cone(const Vector3d& base, const Vector3d& along, double bottom, double top) {
  return BRepPrimAPI_MakeCone(axis(base, along), bottom, top, along.norm());
}
TopoDS_Shape ball(const Vector3d& centre, double radius) {
  return BRepPrimAPI_MakeSphere(pnt(centre), radius);
}
TopoDS_Shape quarter_torus(double ring, double radius) {
  return BRepPrimAPI_MakeTorus(ring, radius, M_PI / 2);
}
TopoDS_Shape prism(const TopoDS_Face& face, const Vector3d& along) {
  return BRepPrimAPI_MakePrism(face, vec(along));
}
TopoDS_Shape pyramid(const Vector3d& apex, const TopoDS_Face& base) {
  BRepOffsetAPI_ThruSections maker(/*isSolid=*/true, /*ruled=*/true);
  maker.AddVertex(BRepBuilderAPI_MakeVertex(pnt(apex)).Vertex());
  maker.AddWire(BRepTools::OuterWire(base));
  return maker.Shape();
}
TopoDS_Shape revolve(const TopoDS_Face& face) {
  return BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)));
}
TopoDS_Shape turned(const TopoDS_Shape& shape, double angle) {
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), angle);
  return BRepBuilderAPI_Transform(shape, turn, /*Copy=*/true);
}

TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b) { return BRepAlgoAPI_Cut(a, b); }
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Common(a, b);
}
TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  ShapeUpgrade_UnifySameDomain unify(BRepAlgoAPI_Fuse(a, b).Shape());
  unify.Build();
  return unify.Shape();
}
TopoDS_Shape drilled(const TopoDS_Shape& shape, double x, double y, double height, double radius) {
  return cut(shape, cylinder({x, y, -1}, {0, 0, height + 2}, radius));
}
TopoDS_Shape drilled_around(TopoDS_Shape shape, int count, double at, double height,
                            double radius) {
  for (int i = 0; i < count; ++i) {
    const double a = 2 * M_PI * i / count;
    shape = drilled(shape, at * std::cos(a), at * std::sin(a), height, radius);
  }
  return shape;
}

std::vector<TopoDS_Edge> edges_where(
    const TopoDS_Shape& shape, const std::function<bool(const Vector3d&, const Vector3d&)>& take) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, TopAbs_EDGE, map);
  std::vector<TopoDS_Edge> edges;
  const auto point = [](const TopoDS_Vertex& v) {
    const gp_Pnt p = BRep_Tool::Pnt(v);
    return Vector3d(p.X(), p.Y(), p.Z());
  };
  for (int i = 1; i <= map.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(map(i));
    if (take(point(TopExp::FirstVertex(edge)), point(TopExp::LastVertex(edge))))
      edges.push_back(edge);
  }
  return edges;
}
bool vertical(const Vector3d& a, const Vector3d& b) {
  return (a - b).head<2>().norm() < 1e-6 * (a - b).norm();
}
TopoDS_Shape fillet(const TopoDS_Shape& shape, const std::vector<TopoDS_Edge>& edges, double r) {
  BRepFilletAPI_MakeFillet maker(shape);
  for (const TopoDS_Edge& edge : edges) maker.Add(r, edge);
  return maker.Shape();
}
TopoDS_Shape chamfer(const TopoDS_Shape& shape, const std::vector<TopoDS_Edge>& edges, double d) {
  BRepFilletAPI_MakeChamfer maker(shape);
  for (const TopoDS_Edge& edge : edges) maker.Add(d, edge);
  return maker.Shape();
}

Outline& Outline::line(const Vector3d& to) {
  edges_.push_back(BRepBuilderAPI_MakeEdge(pnt(at_), pnt(to)).Edge());
  at_ = to;
  return *this;
}
Outline& Outline::arc(const Vector3d& through, const Vector3d& to) {
  const Handle(Geom_TrimmedCurve) curve =
      GC_MakeArcOfCircle(pnt(at_), pnt(through), pnt(to)).Value();
  edges_.push_back(BRepBuilderAPI_MakeEdge(curve).Edge());
  at_ = to;
  return *this;
}
Outline& Outline::ellipse(const Vector3d& centre, const Vector3d& u, const Vector3d& v, double t0,
                          double t1) {
  const Vector3d n = u.cross(v);
  const gp_Ax2 frame(pnt(centre), gp_Dir(n.x(), n.y(), n.z()), gp_Dir(u.x(), u.y(), u.z()));
  const Handle(Geom_Ellipse) curve = new Geom_Ellipse(frame, u.norm(), v.norm());
  edges_.push_back(BRepBuilderAPI_MakeEdge(curve, t0, t1).Edge());
  at_ = centre + std::cos(t1) * u + std::sin(t1) * v;
  return *this;
}
Outline& Outline::spline(const std::vector<Vector3d>& points) {
  std::vector<Vector3d> all = {at_};
  all.insert(all.end(), points.begin(), points.end());
  edges_.push_back(BRepBuilderAPI_MakeEdge(interpolate(all, false)).Edge());
  at_ = points.back();
  return *this;
}
TopoDS_Face Outline::face() {
  if ((at_ - start_).norm() > 1e-6) line(start_);
  BRepBuilderAPI_MakeWire wire;
  for (const TopoDS_Edge& edge : edges_) wire.Add(edge);
  return BRepBuilderAPI_MakeFace(wire.Wire(), /*OnlyPlane=*/true).Face();
}
TopoDS_Face profile(const Vector3d& right, const Vector3d& up, const std::vector<To>& places) {
  const int n = int(places.size());
  const auto at = [&](int i) -> Vector3d { return right * places[i % n].x + up * places[i % n].y; };
  Outline outline(at(0));
  for (int i = 1; i < n; ++i) {
    if (places[i].through)
      outline.arc(at(i), at(i + 1)), ++i;
    else
      outline.line(at(i));
  }
  return outline.face();
}
TopoDS_Shape along_x(const std::vector<To>& places, double length) {
  return prism(profile(Vector3d::UnitY(), Vector3d::UnitZ(), places), {length, 0, 0});
}
TopoDS_Shape along_y(const std::vector<To>& places, double length) {
  return prism(profile(Vector3d::UnitX(), Vector3d::UnitZ(), places), {0, length, 0});
}
TopoDS_Shape along_z(const std::vector<To>& places, double z, double length) {
  const TopoDS_Shape shape =
      prism(profile(Vector3d::UnitX(), Vector3d::UnitY(), places), {0, 0, length});
  gp_Trsf lift;
  lift.SetTranslation(gp_Vec(0, 0, z));
  return BRepBuilderAPI_Transform(shape, lift, /*Copy=*/true);
}
TopoDS_Shape lathed(const std::vector<To>& places) {
  return revolve(profile(Vector3d::UnitX(), Vector3d::UnitZ(), places));
}
TopoDS_Face blob(const std::vector<Vector3d>& points) {
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(interpolate(points, true)).Edge();
  return BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(edge).Wire(), /*OnlyPlane=*/true).Face();
}

}  // namespace sketchsplat

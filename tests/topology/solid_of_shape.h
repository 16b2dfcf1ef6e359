// SPDX-License-Identifier: MIT
#pragma once

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "sketches/curve/curve.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// What a boundary representation is as a Solid: without its seams, so that they must be found
/// again. Nothing if it has curves or surfaces that a Solid does not.
class SolidOfShape {
 public:
  using Vector3d = Eigen::Vector3d;

  static std::optional<Solid> make(const TopoDS_Shape& shape) {
    SolidOfShape maker;
    TopTools_IndexedMapOfShape vertices;
    TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
    maker.node_.assign(size_t(vertices.Extent()) + 1, -1);
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
      if (!maker.add_face(TopoDS::Face(it.Current()), vertices)) return std::nullopt;
    return maker.solid_;
  }

 private:
  static Vector3d vector(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

  bool add_face(const TopoDS_Face& face, const TopTools_IndexedMapOfShape& vertices) {
    Surface surface;
    bool direct = true;
    if (!convert(BRepAdaptor_Surface(face), &surface, &direct)) return false;
    SolidFace out{
        int(solid_.surfaces.size()), (face.Orientation() == TopAbs_REVERSED) == direct, {}};
    solid_.surfaces.push_back(surface);
    for (TopExp_Explorer wire(face, TopAbs_WIRE); wire.More(); wire.Next()) {
      std::vector<LoopStroke> uses;
      for (TopExp_Explorer it(wire.Current(), TopAbs_EDGE); it.More(); it.Next()) {
        const TopoDS_Edge edge = TopoDS::Edge(it.Current());
        if (BRep_Tool::Degenerated(edge) || BRep_Tool::IsClosed(edge, face)) continue;
        const int stroke = stroke_of(edge, vertices);
        if (stroke < 0) return false;
        uses.push_back({stroke, edge.Orientation() == TopAbs_FORWARD});
      }
      if (!chain(uses, &out.loops)) return false;
    }
    solid_.faces.push_back(out);
    return true;
  }

  static bool convert(const BRepAdaptor_Surface& a, Surface* s, bool* direct) {
    const auto place = [&](SurfaceKind kind, const gp_Ax3& frame, double radius) {
      s->kind = kind;
      s->origin = vector(frame.Location().XYZ());
      s->axis = vector(frame.Direction().XYZ());
      s->radius = radius;
      *direct = frame.Direct();
      return true;
    };
    switch (a.GetType()) {
      case GeomAbs_Plane:
        place(SurfaceKind::kPlane, a.Plane().Position(), 0);
        if (!*direct) s->axis = -s->axis, *direct = true;
        return true;
      case GeomAbs_Cylinder:
        return place(SurfaceKind::kCylinder, a.Cylinder().Position(), a.Cylinder().Radius());
      case GeomAbs_Cone:
        s->slope = std::tan(a.Cone().SemiAngle());
        return place(SurfaceKind::kCone, a.Cone().Position(), a.Cone().RefRadius());
      case GeomAbs_Sphere:
        return place(SurfaceKind::kSphere, a.Sphere().Position(), a.Sphere().Radius());
      case GeomAbs_Torus:
        s->minor_radius = a.Torus().MinorRadius();
        return place(SurfaceKind::kTorus, a.Torus().Position(), a.Torus().MajorRadius());
      default:
        return false;
    }
  }

  int node_of(const TopoDS_Vertex& vertex, const TopTools_IndexedMapOfShape& vertices) {
    int& node = node_[size_t(vertices.FindIndex(vertex))];
    if (node < 0) node = solid_.edges.add_node(vector(BRep_Tool::Pnt(vertex).XYZ()));
    return node;
  }

  int stroke_of(const TopoDS_Edge& edge, const TopTools_IndexedMapOfShape& vertices) {
    const int known = edges_.FindIndex(edge);
    if (known > 0) return known - 1;
    edges_.Add(edge);
    solid_.inferred.push_back(false);
    const BRepAdaptor_Curve c(edge);
    const double f = c.FirstParameter(), l = c.LastParameter();
    const auto at = [&](double share) { return vector(c.Value(f + share * (l - f)).XYZ()); };
    const TopoDS_Vertex begin = TopExp::FirstVertex(edge), end = TopExp::LastVertex(edge);
    Sketch& s = solid_.edges;
    if (begin.IsSame(end)) {
      if (c.GetType() == GeomAbs_Circle)
        return s.add_stroke(StrokeKind::kCircle, -1, -1,
                            {vector(c.Circle().Location().XYZ()),
                             vector(c.Circle().Axis().Direction().XYZ()) * c.Circle().Radius()});
      if (c.GetType() != GeomAbs_Ellipse) return -1;
      const gp_Elips e = c.Ellipse();
      return s.add_stroke(
          StrokeKind::kEllipse, -1, -1,
          {vector(e.Location().XYZ()), vector(e.XAxis().Direction().XYZ()) * e.MajorRadius(),
           vector(e.YAxis().Direction().XYZ()) * e.MinorRadius()});
    }
    const int a = node_of(begin, vertices), b = node_of(end, vertices);
    if (c.GetType() == GeomAbs_Line) return s.add_stroke(StrokeKind::kLine, a, b, {});
    if (c.GetType() == GeomAbs_Circle) return s.add_stroke(StrokeKind::kArc, a, b, {at(0.5)});
    if (c.GetType() == GeomAbs_Ellipse)
      return s.add_stroke(StrokeKind::kEllipticArc, a, b,
                          {at(0.5), elliptic_quarter(at(0), at(0.5), at(1), (l - f) / 2)});
    return -1;
  }

  // Uses of a wire without its seams, as one or two loops.
  bool chain(std::vector<LoopStroke> uses, std::vector<Loop>* loops) const {
    const auto end = [&](const LoopStroke& u, bool last) {
      const Stroke& s = solid_.edges.strokes[u.stroke];
      return u.forward == last ? s.end : s.begin;
    };
    while (!uses.empty()) {
      Loop loop = {uses[0]};
      uses.erase(uses.begin());
      while (end(loop.back(), true) != end(loop[0], false)) {
        const auto next = std::find_if(uses.begin(), uses.end(), [&](const LoopStroke& u) {
          return end(u, false) == end(loop.back(), true);
        });
        if (next == uses.end()) return false;
        loop.push_back(*next);
        uses.erase(next);
      }
      loops->push_back(loop);
    }
    return true;
  }

  Solid solid_;
  std::vector<int> node_;
  TopTools_IndexedMapOfShape edges_;
};

}  // namespace sketchsplat

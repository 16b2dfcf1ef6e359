// SPDX-License-Identifier: MIT
#include "topology/brep/build_face.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_Plane.hxx>
#include <Precision.hxx>
#include <ShapeFix_Face.hxx>
#include <ShapeFix_Wire.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>

#include "topology/brep/geometry.h"

namespace sketchsplat::brep {
namespace {

using Eigen::Vector3d;

// Curves that are farther than this from their surfaces stand for where these meet; times what
// arcs may be flat by.
constexpr double kTraced = 50;

// Of every stroke, the surfaces of the faces that it bounds.
std::vector<std::vector<int>> surfaces_beside(const Solid& solid) {
  std::vector<std::vector<int>> out(solid.edges.size());
  for (const SolidFace& face : solid.faces)
    for (const Loop& loop : face.loops)
      for (const LoopStroke& s : loop) out[s.stroke].push_back(face.surface);
  return out;
}

TopoDS_Vertex make_vertex(const Vector3d& p, double tolerance) {
  TopoDS_Vertex vertex;
  BRep_Builder().MakeVertex(vertex, to_point(p), tolerance);
  return vertex;
}

std::vector<Vector3d> border_of(const SolidFace& face, const std::vector<TopoDS_Edge>& edges) {
  constexpr int kSteps = 32;
  std::vector<Vector3d> border;
  for (const Loop& loop : face.loops)
    for (const LoopStroke& s : loop) {
      const BRepAdaptor_Curve curve(edges[s.stroke]);
      const double first = curve.FirstParameter(), last = curve.LastParameter();
      for (int i = 0; i < kSteps; ++i)
        border.push_back(to_eigen(curve.Value(first + (last - first) * i / kSteps)));
    }
  return border;
}

// Turned about its axis so that its own seam lies in the widest gap of the border.
void turn_seam_away(const std::vector<Vector3d>& border, const Handle(Geom_Surface) & surface) {
  const auto round = Handle(Geom_ElementarySurface)::DownCast(surface);
  if (round.IsNull() || surface->IsKind(STANDARD_TYPE(Geom_Plane)) || border.empty()) return;
  const gp_Ax3& frame = round->Position();
  std::vector<double> angles;
  for (const Vector3d& p : border) {
    const gp_Vec from(frame.Location(), to_point(p));
    angles.push_back(std::atan2(from.Dot(frame.YDirection()), from.Dot(frame.XDirection())));
  }
  std::sort(angles.begin(), angles.end());
  double widest = 2 * M_PI - (angles.back() - angles.front()), turn = angles.front() - widest / 2;
  for (size_t i = 0; i + 1 < angles.size(); ++i) {
    if (!(angles[i + 1] - angles[i] > widest)) continue;
    widest = angles[i + 1] - angles[i];
    turn = angles[i] + widest / 2;
  }
  constexpr double kGap = 0.3;  // [rad] of a border that does not run all around
  if (widest > kGap) round->Rotate(round->Axis(), turn);
}

}  // namespace

std::vector<TopoDS_Edge> build_edges(const Solid& solid, double flat) {
  const Sketch& sketch = solid.edges;
  const std::vector<std::vector<int>> beside = surfaces_beside(solid);
  // Seams end in vertices that they run past within these tolerances.
  const double tolerance = std::max(Precision::Confusion(), solid.gap);
  std::vector<TopoDS_Vertex> nodes;
  for (int i = 0; i < sketch.nodes.cols(); ++i)
    nodes.push_back(make_vertex(sketch.nodes.col(i), tolerance));
  std::vector<TopoDS_Edge> out;
  const BRep_Builder builder;
  for (int i = 0; i < sketch.size(); ++i) {
    EdgeCurve c = curve_of(sketch, i, flat);
    if (beside[i].size() == 2)
      trace(sketch, i, kTraced * flat, solid.surfaces[beside[i][0]], solid.surfaces[beside[i][1]],
            &c);
    const Stroke& s = sketch.strokes[i];
    const TopoDS_Vertex begin = c.closed ? make_vertex(to_eigen(c.curve->Value(c.first)), tolerance)
                                         : nodes[s.begin],
                        end = c.closed ? begin : nodes[s.end];
    TopoDS_Edge edge;
    builder.MakeEdge(edge, c.curve, tolerance);
    builder.Add(edge, begin.Oriented(TopAbs_FORWARD));
    builder.Add(edge, end.Oriented(TopAbs_REVERSED));
    builder.Range(edge, c.first, c.last);
    edge.Closed(begin.IsSame(end));
    for (const auto& [vertex, at] : {std::pair(begin, c.first), std::pair(end, c.last)})
      builder.UpdateVertex(vertex, 1.05 * BRep_Tool::Pnt(vertex).Distance(c.curve->Value(at)));
    out.push_back(edge);
  }
  return out;
}

TopoDS_Face build_face(const Solid& solid, const SolidFace& face,
                       const std::vector<TopoDS_Edge>& edges, double near,
                       const Handle(ShapeBuild_ReShape) & context) {
  const std::vector<Vector3d> border = border_of(face, edges);
  const Handle(Geom_Surface) surface = surface_of(solid.surfaces[face.surface], border);
  turn_seam_away(border, surface);
  const BRep_Builder builder;
  TopoDS_Face out;
  if (face.loops.empty()) {
    const SurfaceKind kind = solid.surfaces[face.surface].kind;
    if (kind != SurfaceKind::kSphere && kind != SurfaceKind::kTorus) throw Refused("it has no end");
    out = BRepBuilderAPI_MakeFace(surface, Precision::Confusion()).Face();
    if (face.reversed) out.Reverse();
    return out;
  }
  builder.MakeFace(out, surface, Precision::Confusion());
  for (const Loop& loop : face.loops) {
    TopoDS_Wire wire;
    builder.MakeWire(wire);
    for (const LoopStroke& s : loop)
      builder.Add(wire, s.forward ? edges[s.stroke] : TopoDS::Edge(edges[s.stroke].Reversed()));
    wire.Closed(true);
    builder.Add(out, face.reversed ? wire.Reversed() : wire);
  }
  if (face.reversed) out.Reverse();
  ShapeFix_Face fix;
  fix.SetContext(context);
  fix.Init(out);
  fix.SetPrecision(near);
  fix.SetMaxTolerance(100 * near);
  fix.FixAddNaturalBoundMode() = 1;  // loops on spheres and tori may be holes alone
  fix.Perform();
  const TopoDS_Shape fixed = context->Apply(out);
  TopExp_Explorer it(fixed, TopAbs_FACE);
  if (!it.More()) throw Refused("its loops bound nothing");
  out = TopoDS::Face(it.Current());
  it.Next();
  if (it.More()) throw Refused("its loops bound more than one piece");
  return out;
}

}  // namespace sketchsplat::brep

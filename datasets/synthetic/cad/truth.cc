// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/truth.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <Eigen/Geometry>
#include <Geom2d_Curve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/cad/curve_kind.h"
#include "sketches/curve/conic.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kKindTolerance = 1e-6;   // a stored B-spline this close to a line or circle is one
constexpr double kMostTurn = 6;           // [rad] of an elliptic arc that is not closed
constexpr double kCubicTolerance = 1e-5;  // of the cubics that stand for other curves
constexpr double kDeflection = 1e-5;      // of the sampled truth
constexpr double kSpacing = 0.005;

Vector3d to_eigen(const gp_XYZ& v) { return {v.X(), v.Y(), v.Z()}; }

ParametricCurve in_unit_frame(const BRepAdaptor_Curve& curve, const UnitFrame& frame) {
  ParametricCurve out;
  out.first = curve.FirstParameter();
  out.last = curve.LastParameter();
  out.evaluate = [&curve, &frame](double t, Vector3d* p, Vector3d* d) {
    gp_Pnt point;
    gp_Vec derivative;
    curve.D1(t, point, derivative);
    *p = frame * to_eigen(point.XYZ());
    *d = to_eigen(derivative.XYZ()) * frame.scale;
  };
  return out;
}

std::vector<double> derivative_breaks(const BRepAdaptor_Curve& curve) {
  TColStd_Array1OfReal ends(1, curve.NbIntervals(GeomAbs_C1) + 1);
  curve.Intervals(ends, GeomAbs_C1);
  return {ends.begin() + 1, ends.end() - 1};
}

// Outward normal of a face along one of its edges; zero where the surface has none.
Vector3d face_normal(const TopoDS_Edge& edge, const TopoDS_Face& face, double t) {
  double first, last;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (curve.IsNull()) return Vector3d::Zero();
  const gp_Pnt2d uv = curve->Value(std::clamp(t, first, last));
  const BRepAdaptor_Surface surface(face, /*Restriction=*/false);
  gp_Pnt point;
  gp_Vec du, dv;
  surface.D1(uv.X(), uv.Y(), point, du, dv);
  const Vector3d a = to_eigen(du.XYZ()), b = to_eigen(dv.XYZ()), n = a.cross(b);
  if (!(n.norm() > 1e-9 * a.norm() * b.norm())) return Vector3d::Zero();
  return n.normalized() * (face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0);
}

// One of the two sides of an edge. A seam is used twice by one face, once in each direction.
struct Side {
  TopoDS_Edge edge;
  TopoDS_Face face;
};
std::vector<Side> sides_of(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
  std::vector<Side> sides;
  for (const TopoDS_Shape& face : faces) sides.push_back({edge, TopoDS::Face(face)});
  if (sides.size() == 1 && BRep_Tool::IsClosed(edge, sides[0].face))
    sides.push_back({TopoDS::Edge(edge.Reversed()), sides[0].face});
  return sides;
}

// Fills `outward` and `dihedral_deg`; returns the largest angle between the two normals [deg].
// Measured, because BRepLib::EncodeRegularity leaves many tangent edges of real files unmarked.
double look_around(const std::vector<Side>& sides, const std::vector<double>& parameters,
                   TruthCurve* curve) {
  curve->outward = Matrix3Xd::Zero(3, parameters.size());
  curve->dihedral_deg = 180;
  if (sides.size() != 2) return 180;
  double sum = 0, largest = 0;
  int count = 0;
  for (size_t i = 0; i < parameters.size(); ++i) {
    const Vector3d a = face_normal(sides[0].edge, sides[0].face, parameters[i]);
    const Vector3d b = face_normal(sides[1].edge, sides[1].face, parameters[i]);
    // The free space lies along the sum of the normals, whether the edge is convex or not.
    if ((a + b).norm() > 1e-3) curve->outward.col(i) = (a + b).normalized();
    if (a.isZero() || b.isZero()) continue;
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
    largest = std::max(largest, angle);
    sum += angle;
    ++count;
  }
  if (count == 0) return 180;
  curve->dihedral_deg = sum / count;
  return largest;
}

class Collector {
 public:
  explicit Collector(const UnitFrame& frame) : frame_(frame) {}

  // Adds the edge if it is sharp.
  void add(const TopoDS_Edge& edge, const std::vector<Side>& sides, double smooth_angle_deg) {
    const BRepAdaptor_Curve adaptor(edge);
    const ParametricCurve curve = in_unit_frame(adaptor, frame_);
    const std::vector<double> breaks = derivative_breaks(adaptor);
    TruthCurve out;
    std::vector<double> parameters;
    out.points = polyline(curve, breaks, kDeflection, kSpacing, &parameters);
    const TopoDS_Vertex first = TopExp::FirstVertex(edge), last = TopExp::LastVertex(edge);
    out.closed = first.IsNull() || first.IsSame(last);
    if (look_around(sides, parameters, &out) < smooth_angle_deg) return;
    add_strokes(adaptor, curve, breaks, first, last, &out);
    truth_.curves.push_back(std::move(out));
  }

  Truth take() { return std::move(truth_); }

 private:
  int node(const TopoDS_Vertex& vertex) {
    const int key = vertices_.Add(vertex);
    if (key > int(node_of_vertex_.size()))
      node_of_vertex_.push_back(
          truth_.sketch.add_node(frame_ * to_eigen(BRep_Tool::Pnt(vertex).XYZ())));
    return node_of_vertex_[key - 1];
  }

  void stroke(StrokeKind kind, int begin, int end, const std::vector<Vector3d>& handles) {
    truth_.sketch.add_stroke(kind, begin, end, handles);
    truth_.curve_of_stroke.push_back(int(truth_.curves.size()));
  }

  void add_strokes(const BRepAdaptor_Curve& adaptor, const ParametricCurve& curve,
                   const std::vector<double>& breaks, const TopoDS_Vertex& first,
                   const TopoDS_Vertex& last, TruthCurve* out) {
    const CurveShape shape = recognise(curve, kKindTolerance);
    if (shape.kind == CurveShape::kLine && !out->closed) {
      out->type = "Line";
      stroke(StrokeKind::kLine, node(first), node(last), {});
    } else if (shape.kind == CurveShape::kCircular) {
      out->type = "Circle";
      if (out->closed) {
        stroke(StrokeKind::kCircle, -1, -1,
               {shape.centre, shape.u.cross(shape.v).normalized() * shape.u.norm()});
      } else {
        const Vector3d apex = curve.point((curve.first + curve.last) / 2);
        stroke(StrokeKind::kArc, node(first), node(last), {apex});
      }
    } else if (shape.kind == CurveShape::kElliptic && out->closed) {
      out->type = "Ellipse";
      stroke(StrokeKind::kEllipse, -1, -1, {shape.centre, shape.u, shape.v});
    } else if (shape.kind == CurveShape::kElliptic && shape.turn < kMostTurn) {
      out->type = "Ellipse";
      const Vector3d begin = curve.point(curve.first) - shape.centre;
      const double angle = std::atan2(begin.dot(shape.v) / shape.v.squaredNorm(),
                                      begin.dot(shape.u) / shape.u.squaredNorm());
      const ControlPoints c =
          elliptic_arc(shape.centre, shape.u, shape.v, angle, angle + shape.turn);
      stroke(StrokeKind::kEllipticArc, node(first), node(last), {c.p[1], c.p[2]});
    } else {
      // A short arc of an ellipse may be a short arc of anything.
      const bool arc = shape.kind == CurveShape::kElliptic || adaptor.GetType() == GeomAbs_Ellipse;
      out->type = arc ? "Ellipse" : "BSpline";
      add_cubics(curve, breaks, first, last);
    }
  }

  void add_cubics(const ParametricCurve& curve, std::vector<double> breaks,
                  const TopoDS_Vertex& first, const TopoDS_Vertex& last) {
    const std::vector<double> knots = hermite_knots(curve, breaks, kCubicTolerance);
    const int begin =
        first.IsNull() ? truth_.sketch.add_node(curve.point(curve.first)) : node(first);
    const int end = first.IsNull() ? begin : node(last);
    int from = begin;
    for (size_t i = 1; i < knots.size(); ++i) {
      const bool at_end = i + 1 == knots.size();
      const int to = at_end ? end : truth_.sketch.add_node(curve.point(knots[i]));
      Vector3d h0, h1;
      hermite_handles(curve, knots[i - 1], knots[i], &h0, &h1);
      stroke(StrokeKind::kBezier, from, to, {h0, h1});
      from = to;
    }
  }

  const UnitFrame& frame_;
  Truth truth_;
  TopTools_IndexedMapOfShape vertices_;
  std::vector<int> node_of_vertex_;
};

}  // namespace

Truth sharp_edges(const Brep& brep, const UnitFrame& frame, double smooth_angle_deg) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
  TopExp::MapShapesAndUniqueAncestors(*brep.shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
  Collector collector(frame);
  for (int i = 1; i <= faces_of_edge.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(faces_of_edge.FindKey(i));
    const std::vector<Side> sides = sides_of(edge, faces_of_edge(i));
    if (sides.empty() || BRep_Tool::Degenerated(edge)) continue;
    collector.add(edge, sides, smooth_angle_deg);
  }
  return collector.take();
}

Truth transformed(const Truth& truth, double scale, const Vector3d& shift) {
  Truth out = truth;
  const auto place = [&](Eigen::Ref<Matrix3Xd> x) { x = ((x * scale).colwise() + shift).eval(); };
  place(out.sketch.nodes);
  for (const Stroke& s : out.sketch.strokes) {
    if (s.handle < 0) continue;
    // The first handle of a closed curve is a point, the others are vectors.
    const int points = is_closed(s.kind) ? 1 : num_handles(s.kind);
    place(out.sketch.handles.middleCols(s.handle, points));
    out.sketch.handles.middleCols(s.handle + points, num_handles(s.kind) - points) *= scale;
  }
  for (TruthCurve& curve : out.curves) place(curve.points);
  return out;
}

}  // namespace sketchsplat

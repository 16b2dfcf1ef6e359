// SPDX-License-Identifier: MIT
#include "topology/brep/build_face.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_Line.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>

namespace sketchsplat::brep {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Part = EdgeTable::Part;

struct PlacedLoop {
  std::vector<Part> parts;
  Trace trace;
};

// An edge in a wire, with its image in the chart.
struct Use {
  TopoDS_Edge edge;  // as the wire runs
  Handle(Geom2d_Curve) curve;
  double gap = 0;
};

CurvePart part_of(const Part& p) { return p.part; }

PlacedLoop place(const Chart& chart, std::vector<Part> parts) {
  std::vector<CurvePart> curves(parts.size());
  std::transform(parts.begin(), parts.end(), curves.begin(), part_of);
  return {std::move(parts), trace(chart, curves)};
}

std::vector<Part> parts_of(const Loop& loop, const EdgeTable& edges) {
  std::vector<Part> out;
  for (const LoopStroke& s : loop)
    for (const Part& p : edges.parts(s.stroke, s.forward)) out.push_back(p);
  return out;
}

void shift(const Vector2d& by, PlacedLoop* loop) {
  for (Matrix2Xd& uv : loop->trace.uv) uv.colwise() += by;
  loop->trace.end += by;
}

// Crossings of a ray along u, counted: odd is inside.
bool is_inside(const Vector2d& p, const Trace& outer) {
  bool inside = false;
  Vector2d a = outer.uv.back().rightCols<1>();
  for (const Matrix2Xd& uv : outer.uv)
    for (int i = 0; i < uv.cols(); ++i) {
      const Vector2d b = uv.col(i);
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        inside = !inside;
      a = b;
    }
  return inside;
}

// Holes belong to the same turn as the wire around them.
void shift_inside(const FacePlan& plan, const Trace* outer, PlacedLoop* hole) {
  const Vector2d p = hole->trace.uv[0].col(0), period = plan.chart.period();
  if (!outer) {
    const int k = plan.winds_in_v ? 1 : 0;
    Vector2d by = Vector2d::Zero();
    by[k] = -period[k] * std::floor((p[k] - plan.at) / period[k]);
    shift(by, hole);
    return;
  }
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      const Vector2d by(i * period[0], j * period[1]);
      if ((i != 0 && period[0] == 0) || (j != 0 && period[1] == 0) || !is_inside(p + by, *outer))
        continue;
      shift(by, hole);
      return;
    }
}

class FaceBuilder {
 public:
  FaceBuilder(const FacePlan& plan, const EdgeTable& edges) : plan_(plan), edges_(edges) {}

  TopoDS_Face build() {
    const TopoDS_Face whole = plan_.loops.empty() ? whole_surface() : TopoDS_Face();
    if (!whole.IsNull()) return oriented(whole);
    TopoDS_Face face;
    builder_.MakeFace(face, plan_.chart.surface(), Precision::Confusion());
    PlacedLoop outer;
    if (plan_.seam) {
      builder_.Add(face, seamed_wire());
    } else {
      outer = place(plan_.chart, parts_of(plan_.loops[plan_.outer], edges_));
      builder_.Add(face, wire_of(outer));
    }
    for (int i = 0; i < int(plan_.loops.size()); ++i) {
      if (i == plan_.outer || i == plan_.lower.loop || i == plan_.upper.loop) continue;
      PlacedLoop hole = place(plan_.chart, parts_of(plan_.loops[i], edges_));
      shift_inside(plan_, plan_.seam ? nullptr : &outer.trace, &hole);
      builder_.Add(face, wire_of(hole));
    }
    return oriented(face);
  }

 private:
  TopoDS_Face whole_surface() const {
    return BRepBuilderAPI_MakeFace(plan_.chart.surface(), Precision::Confusion()).Face();
  }

  TopoDS_Face oriented(TopoDS_Face face) const {
    if (plan_.reversed) face.Reverse();
    return face;
  }

  TopoDS_Wire wire_of(const PlacedLoop& loop) {
    std::vector<Use> uses;
    append(loop, &uses);
    return wire_of(uses);
  }

  // The parts of a loop and the chart's edges at poles between them.
  void append(const PlacedLoop& loop, std::vector<Use>* uses) const {
    const std::vector<Matrix2Xd>& uv = loop.trace.uv;
    for (size_t i = 0; i < uv.size(); ++i) {
      const Part& part = loop.parts[i];
      Use use{part.edge, nullptr, 0};
      // Of what lies in a plane OpenCASCADE finds the exact image itself.
      if (plan_.chart.flat()) use.gap = gap_to_plane(part.part);
      if (!plan_.chart.flat() || (use.gap > Precision::Confusion() && !is_line(part.part)))
        use.curve = curve_in_chart(plan_.chart, part.part, uv[i], &use.gap);
      uses->push_back(use);
      if (loop.trace.pole[i] < 0) continue;
      const double to = i + 1 < uv.size() ? uv[i + 1](0, 0) : loop.trace.end[0];
      uses->push_back(pole_edge(loop.trace.pole[i], uv[i](0, uv[i].cols() - 1), to, part.end));
    }
  }

  static bool is_line(const CurvePart& part) {
    return !Handle(Geom_Line)::DownCast(part.curve).IsNull();
  }

  double gap_to_plane(const CurvePart& part) const {
    constexpr int kSteps = 64;
    double gap = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const Eigen::Vector3d p = part.point(double(i) / kSteps);
      gap = std::max(gap, (plan_.chart.point(plan_.chart.parameters(p)) - p).norm());
    }
    return gap;
  }

  // All of a pole's u are one point.
  Use pole_edge(int pole, double from, double to, const TopoDS_Vertex& vertex) const {
    TopoDS_Edge edge;
    builder_.MakeEdge(edge);
    builder_.Add(edge, vertex.Oriented(TopAbs_FORWARD));
    builder_.Add(edge, vertex.Oriented(TopAbs_REVERSED));
    builder_.Degenerated(edge, true);
    const Handle(Geom2d_Line) line =
        new Geom2d_Line(gp_Pnt2d(0, plan_.chart.pole(pole)), gp_Dir2d(1, 0));
    builder_.UpdateEdge(edge, line, plan_.chart.surface(), TopLoc_Location(),
                        Precision::Confusion());
    builder_.Range(edge, std::min(from, to), std::max(from, to));
    if (from > to) edge.Reverse();
    return {edge, Handle(Geom2d_Curve)(line), 0};
  }

  // Begins at the seam, on its left side or, if `far`, a turn further; a pole has no parts.
  PlacedLoop loop_at_seam(const SeamEnd& end, bool far) const {
    if (end.loop < 0) return {};
    std::vector<Part> parts = parts_of(plan_.loops[end.loop], edges_);
    const TopoDS_Vertex vertex = edges_.vertex(end.stroke, end.parameter);
    const auto begins = [&](const Part& p) { return p.begin.IsSame(vertex); };
    std::rotate(parts.begin(), std::find_if(parts.begin(), parts.end(), begins), parts.end());
    PlacedLoop loop = place(plan_.chart, std::move(parts));
    const int k = plan_.winds_in_v ? 1 : 0;
    const double period = plan_.chart.period()[k], target = plan_.at + (far ? period : 0);
    Vector2d by = Vector2d::Zero();
    by[k] = period * std::round((target - loop.trace.uv[0](k, 0)) / period);
    shift(by, &loop);
    return loop;
  }

  // The other coordinate of the seam's end.
  double end_of(const PlacedLoop& loop, int pole) const {
    return loop.parts.empty() ? plan_.chart.pole(pole)
                              : loop.trace.uv[0](plan_.winds_in_v ? 0 : 1, 0);
  }

  TopoDS_Vertex vertex_of(const SeamEnd& end, int pole) const {
    if (end.loop >= 0) return edges_.vertex(end.stroke, end.parameter);
    TopoDS_Vertex vertex;
    builder_.MakeVertex(vertex, to_point(plan_.chart.point({0, plan_.chart.pole(pole)})),
                        Precision::Confusion());
    return vertex;
  }

  // On a torus the other loop may be found a turn away: the face lies between, not outside.
  void order(const PlacedLoop& lower, PlacedLoop* upper) const {
    const int k = plan_.winds_in_v ? 0 : 1;
    const double period = plan_.chart.period()[k];
    if (!(period > 0)) return;
    const double up = plan_.winds_in_v ? -1 : 1;
    const double rise = up * (end_of(*upper, 1) - end_of(lower, 0));
    Vector2d by = Vector2d::Zero();
    by[k] = -up * period * std::floor(rise / period);
    shift(by, upper);
  }

  TopoDS_Edge seam_edge(double from, double to, const TopoDS_Vertex& lower,
                        const TopoDS_Vertex& upper) const {
    const Handle(Geom_Curve) curve = plan_.winds_in_v ? plan_.chart.surface()->VIso(plan_.at)
                                                      : plan_.chart.surface()->UIso(plan_.at);
    TopoDS_Edge edge;
    builder_.MakeEdge(edge, curve, Precision::Confusion());
    builder_.Add(edge, (from < to ? lower : upper).Oriented(TopAbs_FORWARD));
    builder_.Add(edge, (from < to ? upper : lower).Oriented(TopAbs_REVERSED));
    builder_.Range(edge, std::min(from, to), std::max(from, to));
    if (from > to) edge.Reverse();
    return edge;
  }

  Handle(Geom2d_Line) seam_line(bool far) const {
    const double at = plan_.at + (far ? 2 * M_PI : 0);
    return plan_.winds_in_v ? new Geom2d_Line(gp_Pnt2d(0, at), gp_Dir2d(1, 0))
                            : new Geom2d_Line(gp_Pnt2d(at, 0), gp_Dir2d(0, 1));
  }

  // Around the lower end, up the seam, back around the upper end, down the seam.
  TopoDS_Wire seamed_wire() {
    const PlacedLoop lower = loop_at_seam(plan_.lower, false);
    PlacedLoop upper = loop_at_seam(plan_.upper, true);
    order(lower, &upper);
    const TopoDS_Vertex below = vertex_of(plan_.lower, 0), above = vertex_of(plan_.upper, 1);
    const TopoDS_Edge seam = seam_edge(end_of(lower, 0), end_of(upper, 1), below, above);
    const double at = plan_.at, far = at + 2 * M_PI;
    std::vector<Use> uses;
    if (lower.parts.empty()) uses.push_back(pole_edge(0, at, far, below));
    append(lower, &uses);
    uses.push_back({seam, seam_line(true), 0});
    if (upper.parts.empty()) uses.push_back(pole_edge(1, far, at, above));
    append(upper, &uses);
    uses.push_back({TopoDS::Edge(seam.Reversed()), seam_line(false), 0});
    return wire_of(uses);
  }

  TopoDS_Wire wire_of(const std::vector<Use>& uses) {
    TopoDS_Wire wire;
    builder_.MakeWire(wire);
    std::vector<bool> done(uses.size());
    for (size_t i = 0; i < uses.size(); ++i) {
      builder_.Add(wire, uses[i].edge);
      size_t other = i;  // a seam's edge is here twice
      for (size_t k = i + 1; k < uses.size(); ++k)
        if (uses[k].edge.IsSame(uses[i].edge)) other = k;
      if (!done[i]) attach(uses[i], other == i ? nullptr : &uses[other]);
      done[other] = true;
    }
    wire.Closed(true);
    return wire;
  }

  void attach(const Use& use, const Use* other) {
    const TopLoc_Location none;
    const Handle(Geom_Surface)& surface = plan_.chart.surface();
    const double gap = std::max(use.gap, other ? other->gap : 0) * kPad;
    if (use.curve.IsNull()) {
      builder_.UpdateEdge(use.edge, std::max(gap, Precision::Confusion()));
    } else if (other) {
      const bool forward = use.edge.Orientation() == TopAbs_FORWARD;
      builder_.UpdateEdge(use.edge, forward ? use.curve : other->curve,
                          forward ? other->curve : use.curve, surface, none, gap);
    } else if (!BRep_Tool::Degenerated(use.edge)) {
      builder_.UpdateEdge(use.edge, use.curve, surface, none, gap);
    }
    grow_vertices(use);
    if (other) grow_vertices(*other);
  }

  // Vertices reach the ends of all curves.
  void grow_vertices(const Use& use) const {
    double range[2];
    BRep_Tool::Range(use.edge, range[0], range[1]);
    double first, last;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(use.edge, first, last);
    for (int k = 0; k < 2; ++k) {
      const TopoDS_Vertex vertex =
          k == 0 ? TopExp::FirstVertex(TopoDS::Edge(use.edge.Oriented(TopAbs_FORWARD)))
                 : TopExp::LastVertex(TopoDS::Edge(use.edge.Oriented(TopAbs_FORWARD)));
      const gp_Pnt p = BRep_Tool::Pnt(vertex);
      double off = BRep_Tool::Tolerance(use.edge);
      if (!curve.IsNull()) off = std::max(off, p.Distance(curve->Value(range[k])) * kPad);
      if (!use.curve.IsNull()) {
        const gp_Pnt2d uv = use.curve->Value(range[k]);
        off = std::max(off, p.Distance(plan_.chart.surface()->Value(uv.X(), uv.Y())) * kPad);
      }
      builder_.UpdateVertex(vertex, off);
    }
  }

  static constexpr double kPad = 1.05;  // between the places that were looked at

  const FacePlan& plan_;
  const EdgeTable& edges_;
  BRep_Builder builder_;
};

}  // namespace

TopoDS_Face build_face(const FacePlan& plan, const EdgeTable& edges) {
  return FaceBuilder(plan, edges).build();
}

}  // namespace sketchsplat::brep

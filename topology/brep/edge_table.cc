// SPDX-License-Identifier: MIT
#include "topology/brep/edge_table.h"

#include <BRep_Builder.hxx>
#include <Precision.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>

namespace sketchsplat::brep {
namespace {

TopoDS_Vertex make_vertex(const Eigen::Vector3d& p) {
  TopoDS_Vertex vertex;
  BRep_Builder().MakeVertex(vertex, to_point(p), Precision::Confusion());
  return vertex;
}

TopoDS_Edge make_edge(const CurvePart& part, const TopoDS_Vertex& begin, const TopoDS_Vertex& end) {
  const BRep_Builder builder;
  TopoDS_Edge edge;
  builder.MakeEdge(edge, part.curve, Precision::Confusion());
  builder.Add(edge, begin.Oriented(TopAbs_FORWARD));
  builder.Add(edge, end.Oriented(TopAbs_REVERSED));
  builder.Range(edge, part.first, part.last);
  edge.Closed(begin.IsSame(end));
  return edge;
}

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

}  // namespace

EdgeTable::EdgeTable(const Solid& solid, double flat)
    : nodes_(solid.edges.nodes), near_(flat), strokes_(solid.edges.size()) {
  const Sketch& sketch = solid.edges;
  const std::vector<std::vector<int>> beside = surfaces_beside(solid);
  for (int i = 0; i < sketch.size(); ++i) {
    strokes_[i].curve = curve_of(sketch, i, flat);
    if (beside[i].size() == 2)
      trace(sketch, i, kTraced * flat, solid.surfaces[beside[i][0]], solid.surfaces[beside[i][1]],
            &strokes_[i].curve);
    strokes_[i].begin = sketch.strokes[i].begin;
    strokes_[i].end = sketch.strokes[i].end;
  }
}

CurvePart EdgeTable::whole(int stroke, bool forward) const {
  const EdgeCurve& c = strokes_[stroke].curve;
  const double from =
      c.closed && !strokes_[stroke].cuts.empty() ? strokes_[stroke].cuts[0] : c.first;
  return {c.curve, from, from + c.last - c.first, forward};
}

std::vector<double> EdgeTable::vertices(int stroke) const {
  const Entry& entry = strokes_[stroke];
  std::vector<double> out = entry.cuts;
  if (entry.curve.closed) return out;
  out.insert(out.begin(), entry.curve.first);
  out.push_back(entry.curve.last);
  return out;
}

double EdgeTable::distance(const Entry& entry, double a, double b) const {
  return entry.curve.curve->Value(a).Distance(entry.curve.curve->Value(b));
}

bool EdgeTable::find_vertex(int stroke, double* parameter) const {
  double least = near_, found = *parameter;
  bool any = false;
  for (const double v : vertices(stroke)) {
    const double d = distance(strokes_[stroke], *parameter, v);
    if (!(d <= least)) continue;
    least = d, found = v, any = true;
  }
  *parameter = found;
  return any;
}

void EdgeTable::cut(int stroke, double parameter) {
  if (find_vertex(stroke, &parameter)) return;
  Entry& entry = strokes_[stroke];
  const EdgeCurve& c = entry.curve;
  if (c.closed) {
    const double from = entry.cuts.empty() ? c.first : entry.cuts[0], period = c.last - c.first;
    parameter -= period * std::floor((parameter - from) / period);
  }
  entry.cuts.insert(std::upper_bound(entry.cuts.begin(), entry.cuts.end(), parameter), parameter);
}

void EdgeTable::build() {
  for (int i = 0; i < nodes_.cols(); ++i) node_vertices_.push_back(make_vertex(nodes_.col(i)));
  for (Entry& entry : strokes_) {
    const EdgeCurve& c = entry.curve;
    if (c.closed && entry.cuts.empty()) entry.cuts.push_back(c.first);
    for (const double cut : entry.cuts)
      entry.cut_vertices.push_back(make_vertex(to_eigen(c.curve->Value(cut))));
    std::vector<double> at = entry.cuts;
    std::vector<TopoDS_Vertex> vertices = entry.cut_vertices;
    if (c.closed) {
      at.push_back(at[0] + c.last - c.first);
      vertices.push_back(vertices[0]);
    } else {
      at.insert(at.begin(), c.first);
      at.push_back(c.last);
      vertices.insert(vertices.begin(), node_vertices_[entry.begin]);
      vertices.push_back(node_vertices_[entry.end]);
    }
    for (size_t k = 0; k + 1 < at.size(); ++k) {
      const CurvePart part{c.curve, at[k], at[k + 1], true};
      entry.parts.push_back(
          {part, make_edge(part, vertices[k], vertices[k + 1]), vertices[k], vertices[k + 1]});
    }
  }
}

std::vector<EdgeTable::Part> EdgeTable::parts(int stroke, bool forward) const {
  std::vector<Part> out = strokes_[stroke].parts;
  if (forward) return out;
  std::reverse(out.begin(), out.end());
  for (Part& p : out) {
    p.part.forward = false;
    p.edge.Reverse();
    std::swap(p.begin, p.end);
  }
  return out;
}

TopoDS_Vertex EdgeTable::vertex(int stroke, double parameter) const {
  const Entry& entry = strokes_[stroke];
  find_vertex(stroke, &parameter);
  for (size_t k = 0; k < entry.cuts.size(); ++k)
    if (distance(entry, entry.cuts[k], parameter) <= near_) return entry.cut_vertices[k];
  return node_vertices_[distance(entry, entry.curve.first, parameter) <
                                distance(entry, entry.curve.last, parameter)
                            ? entry.begin
                            : entry.end];
}

}  // namespace sketchsplat::brep

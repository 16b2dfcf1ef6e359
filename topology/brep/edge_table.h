// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <vector>

#include "topology/brep/chart.h"

namespace sketchsplat::brep {

/// The strokes of a solid as edges that faces share; seams may cut them into several.
class EdgeTable {
 public:
  /// `flat`: sagitta of arcs that are lines, and how far curves may be from their surfaces.
  EdgeTable(const Solid& solid, double flat);

  /// Distance of places that are one.
  double near() const { return near_; }
  void set_near(double near) { near_ = near; }
  const EdgeCurve& curve(int stroke) const { return strokes_[stroke].curve; }
  /// A whole stroke; closed ones begin at their first cut.
  CurvePart whole(int stroke, bool forward) const;
  /// Parameters of a stroke where it has a vertex, ascending.
  std::vector<double> vertices(int stroke) const;
  /// The vertex of a stroke nearest to a parameter if it is near; else false.
  bool find_vertex(int stroke, double* parameter) const;
  /// Puts a vertex on a stroke, if there is none near it.
  void cut(int stroke, double parameter);

  /// After the last cut: vertices and edges, with the exact curves.
  void build();
  struct Part {
    CurvePart part;
    TopoDS_Edge edge;
    TopoDS_Vertex begin, end;  ///< along the way
  };
  /// The parts of a stroke along the way.
  std::vector<Part> parts(int stroke, bool forward) const;
  /// The vertex of a stroke near a parameter, which is there.
  TopoDS_Vertex vertex(int stroke, double parameter) const;

 private:
  struct Entry {
    EdgeCurve curve;
    int begin = -1, end = -1;  // nodes
    std::vector<double> cuts;  // ascending, inside of an open stroke
    std::vector<TopoDS_Vertex> cut_vertices;
    std::vector<Part> parts;
  };
  double distance(const Entry& entry, double a, double b) const;

  Eigen::Matrix3Xd nodes_;
  double near_;
  std::vector<Entry> strokes_;
  std::vector<TopoDS_Vertex> node_vertices_;
};

}  // namespace sketchsplat::brep

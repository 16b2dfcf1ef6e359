// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "sketches/graph/face.h"
#include "sketches/graph/sketch.h"
#include "topology/solid/find_surfaces.h"
#include "topology/solid/surface.h"

namespace sketchsplat {

/// A piece of a surface between strokes, none of which crosses it: faces are made of cells.
/// Loops run with the cell on their left, seen against the surface's normal.
struct Cell {
  int surface = -1;
  std::vector<Loop> loops;
  /// Of the loops, in the surface's layout without jumps of a period; one more at the apex of a
  /// cone or the pole of a sphere that it ends in.
  std::vector<Eigen::Matrix2Xd> polygons;
};

/// All bounded cells between the strokes of a surface. Strokes that bound none, and those on both
/// of whose sides the same cell lies, are passed over. A piece up to the apex of a cone or the pole
/// of a sphere counts as bounded. `index` is copied to Cell::surface.
std::vector<Cell> cells_of(const Sketch& sketch, const std::vector<Eigen::Matrix3Xd>& polylines,
                           const SurfaceStrokes& surface, int index);

/// Of every stroke (first) of every surface the cells to its left, along it, and to its right; -1:
/// none.
using CellSides = std::map<std::pair<int, int>, std::pair<int, int>>;
CellSides sides_of(const std::vector<Cell>& cells);

/// Around a cell in its layout.
struct FlatBox {
  Eigen::Vector2d low, size;
  Eigen::Vector2d at(double u, double v) const {
    return low + Eigen::Vector2d(u * size.x(), v * size.y());
  }
};
FlatBox box_of(const Cell& cell);

inline Layout layout_of(const SurfaceStrokes& s) { return Layout(s.surface, s.around_tube); }

/// About `count` points spread evenly over a cell, on the surface and off its border; at least one
/// unless it is too thin.
std::vector<Eigen::Vector3d> points_within(const Cell& cell, const Layout& layout, int count);

/// Pairs of neighbouring points of a grid of `lines` x `lines` over a cell: pieces of its surface,
/// but for the bend between the two.
std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> grid_within(const Cell& cell,
                                                                     const Layout& layout,
                                                                     int lines);

}  // namespace sketchsplat

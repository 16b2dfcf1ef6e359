// SPDX-License-Identifier: MIT
#include "topology/solid/cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "topology/faces/pieces.h"
#include "topology/solid/cell_index.h"

namespace sketchsplat {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

CellSides sides_of(const std::vector<Cell>& cells) {
  CellSides sides;
  for (int c = 0; c < int(cells.size()); ++c)
    for (const Loop& loop : cells[c].loops)
      for (const LoopStroke& s : loop) {
        auto& side =
            sides.emplace(std::pair(s.stroke, cells[c].surface), std::pair(-1, -1)).first->second;
        (s.forward ? side.first : side.second) = c;
      }
  return sides;
}

FlatBox box_of(const Cell& cell) {
  Vector2d low = Vector2d::Constant(HUGE_VAL), high = -low;
  for (const Matrix2Xd& polygon : cell.polygons) {
    low = low.cwiseMin(polygon.rowwise().minCoeff());
    high = high.cwiseMax(polygon.rowwise().maxCoeff());
  }
  return {low, high - low};
}

std::vector<Cell> cells_of(const Sketch& sketch, const std::vector<Eigen::Matrix3Xd>& polylines,
                           const SurfaceStrokes& surface, int index) {
  const Layout layout = layout_of(surface);
  std::vector<Matrix2Xd> lines;
  for (const int s : surface.strokes) lines.push_back(layout.flat(polylines[s]));
  const std::vector<Cycle> cycles = simple_cycles(sketch, surface.strokes, lines, layout.periods());
  const auto across = [](const Cycle& c) { return c.turns_across != 0; };
  if (std::any_of(cycles.begin(), cycles.end(), across)) return {};  // laid out the other way round
  std::vector<Cell> cells;
  for (SurfacePiece& piece :
       pieces_of(cycles, layout.periods(), [&](int side) { return layout.pole(side); })) {
    cells.push_back({index, {}, std::move(piece.polygons)});
    for (const int c : piece.cycles) cells.back().loops.push_back(cycles[c].loop);
  }
  return cells;
}

std::vector<Vector3d> points_within(const Cell& cell, const Layout& layout, int count) {
  const FlatBox box = box_of(cell);
  const CellIndex index(cell, layout);
  std::vector<Vector3d> points;
  for (int finer = 1; finer <= 8 && int(points.size()) < (count + 1) / 2; finer *= 2) {
    points.clear();
    const double step = std::sqrt(box.size.x() * box.size.y() / count) / finer;
    // A sliver has one row, of as many columns as it takes.
    const auto places = [&](double side) {
      return int(std::max(1.0, std::min(side / step, double(count) * finer)));
    };
    const int nx = places(box.size.x()), ny = places(box.size.y());
    for (int i = 0; i < nx; ++i)
      for (int k = 0; k < ny; ++k) {
        const Vector2d p = box.at((i + 0.5) / nx, (k + 0.5) / ny);
        if (index.holds(p)) points.push_back(layout.point(p));
      }
  }
  return points;
}

std::vector<std::pair<Vector3d, Vector3d>> grid_within(const Cell& cell, const Layout& layout,
                                                       int lines) {
  const FlatBox box = box_of(cell);
  const CellIndex index(cell, layout);
  const auto at = [&](int i, int k) { return box.at((i + 0.5) / lines, (k + 0.5) / lines); };
  std::vector<bool> inside(size_t(lines) * lines);
  for (int i = 0; i < lines; ++i)
    for (int k = 0; k < lines; ++k) inside[i * lines + k] = index.holds(at(i, k));
  std::vector<std::pair<Vector3d, Vector3d>> out;
  const auto add = [&](int i, int k, int i2, int k2) {
    if (i2 < lines && k2 < lines && inside[i * lines + k] && inside[i2 * lines + k2])
      out.emplace_back(layout.point(at(i, k)), layout.point(at(i2, k2)));
  };
  for (int i = 0; i < lines; ++i)
    for (int k = 0; k < lines; ++k) {
      add(i, k, i + 1, k);
      add(i, k, i, k + 1);
    }
  return out;
}

}  // namespace sketchsplat

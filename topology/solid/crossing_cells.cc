// SPDX-License-Identifier: MIT
#include "topology/solid/crossing_cells.h"

#include <algorithm>
#include <cmath>

#include "topology/solid/cell_index.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kLines = 12;    // of a grid over a cell, in either direction
constexpr int kHalvings = 4;  // of its lines where the surface bends

struct Segment {
  Vector3d from, to;
};

struct Placed {
  const CellIndex& cell;
  const Layout& layout;
};

// Is a point in a cell, and off its border?
bool holds_well(const Placed& placed, const Vector3d& point, double margin) {
  const Eigen::Vector2d flat = placed.layout.flat(point);
  for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    if (!placed.cell.holds(flat + margin * Eigen::Vector2d(u, v))) return false;
  return true;
}

// Chords of a bent piece of a surface, none of which stands off it by more than `most`: those of a
// coarse grid would run through what lies inside of it.
void add_chords(const Segment& s, const Layout& layout, double most, int depth,
                std::vector<Segment>* out) {
  const Vector3d chord = 0.5 * (s.from + s.to), middle = layout.point(layout.flat(chord));
  if (depth == 0 || (middle - chord).norm() <= most) {
    out->push_back(s);
    return;
  }
  add_chords({s.from, middle}, layout, most, depth - 1, out);
  add_chords({middle, s.to}, layout, most, depth - 1, out);
}

// Does a segment of one cell run through the other?
bool runs_through(const std::vector<Segment>& segments, const Placed& own, const Placed& other,
                  double tolerance) {
  for (const Segment& s : segments) {
    const Crossings at = crossings(other.layout, s.from, s.to);
    for (int k = 0; k < at.count; ++k) {
      const Vector3d p = s.from + at.t[k] * (s.to - s.from);
      if (holds_well(other, p, 2 * tolerance) && holds_well(own, p, 2 * tolerance)) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::pair<int, int>> crossing_cells(const std::vector<SurfaceStrokes>& surfaces,
                                                const std::vector<Cell>& cells, double tolerance) {
  std::vector<Layout> layouts;
  for (const SurfaceStrokes& s : surfaces) layouts.push_back(layout_of(s));
  std::vector<CellIndex> index;
  std::vector<std::vector<Segment>> segments;
  for (const Cell& cell : cells) {
    index.emplace_back(cell, layouts[cell.surface]);
    segments.emplace_back();
    for (const auto& [from, to] : grid_within(cell, layouts[cell.surface], kLines))
      add_chords({from, to}, layouts[cell.surface], tolerance, kHalvings, &segments.back());
  }
  const auto placed = [&](int c) { return Placed{index[c], layouts[cells[c].surface]}; };
  const auto through = [&](int a, int b) {
    return runs_through(segments[a], placed(a), placed(b), tolerance);
  };
  std::vector<std::pair<int, int>> out;
  for (int a = 0; a < int(cells.size()); ++a)
    for (int b = a + 1; b < int(cells.size()); ++b)
      if (cells[a].surface != cells[b].surface && (through(a, b) || through(b, a)))
        out.emplace_back(a, b);
  return out;
}

}  // namespace sketchsplat

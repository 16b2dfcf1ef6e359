// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "edges/surfels/start/cell_grid.h"
#include "edges/surfels/start/edge_planes.h"

namespace sketchsplat {

/// What lines of sight leave of a hull. Planes divide it into regions; a region is empty where
/// lines cross enough of its cells (minimum cut, with a price per area of the new surface: Chauve,
/// Labatut and Pons, Robust piecewise-planar 3D reconstruction and completion from large-scale
/// unstructured point data, CVPR 2010). So the floor and the walls of a plain pocket, of which only
/// the edges can be seen, become flat.
class PlaneCarving {
 public:
  /// At most 64 planes. `hull` must outlive it.
  PlaneCarving(const SureEdges& edges, const std::vector<EdgePlane>& planes, const CellGrid& hull);

  /// Without the regions of which lines cross more than about this share of the cells. Distances
  /// of the field are to the planes, near them. Returns the number of cells that were taken away.
  int carve(double share, CellGrid* grid) const;

 private:
  using Sides = std::uint64_t;  // a bit per plane

  void divide();
  void cross(const std::vector<SightLine>& lines);
  std::vector<char> empty_regions(double share) const;
  double distance(int cell, const std::vector<char>& gone) const;
  Sides sides(const Eigen::Vector3d& p) const;

  const std::vector<EdgePlane> planes_;
  const CellGrid& hull_;
  std::vector<Sides> sides_;   // per cell
  std::vector<int> region_;    // per cell; -1 outside the hull
  std::vector<char> crossed_;  // per cell
  int regions_ = 0;
};

/// Takes away the cells about which, on the mean over their neighbourhood, `least` lines of sight
/// or more go through a cell: bores and whatever else no planes bound. The last cells before an
/// edge stay, for they may hold it. Returns their number.
int carve_crossed(const std::vector<SightLine>& lines, double least, CellGrid* grid);

}  // namespace sketchsplat

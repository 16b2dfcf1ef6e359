// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "topology/solid/cells.h"
#include "topology/solid/contours.h"

namespace sketchsplat {

/// Is a place of an edge seen from a camera?
struct Sight {
  Eigen::Vector3d from, to;  ///< camera centre, place
  bool seen = false;         ///< an edgel lies there; it may be that of another edge
  double weight = 1;         ///< sights of one stroke and view add up to one
};

/// A line of sight through a pixel that surely shows the object, or surely does not.
struct MaskRay {
  Eigen::Vector3d from, to;
  bool object = false;
};

/// What the images say of where matter is, beside the strokes. World units.
struct SolidEvidence {
  std::vector<Sight> sights;
  std::vector<MaskRay> rays;
  std::vector<ContourLine> contours;
};

struct EvidencePrices {
  double seen_through = 0.25;  ///< share of the places behind a face that some edgel lies on
  double seen = 0.95;          ///< share of those in plain view
  double ray = 1;              ///< [nat] of a ray that contradicts its mask
  double most = 60;            ///< [nat] of all that speaks against a cell
  double near = 4e-3;          ///< a line of sight ends this far before its edge; of the extent
};

/// Cells that rays of one outcome meet.
struct Meeting {
  std::vector<int> cells;  ///< ascending
  int rays = 0;
};

struct EvidenceOfCells {
  std::vector<double> against;  ///< [nat] per cell: of its being a part of the boundary
  std::vector<Meeting> object;  ///< rays through the object: a face must stand in each
  std::vector<Meeting> free;    ///< rays beside the object: none does
};

/// Which cells the evidence meets. `extent`: of the object.
EvidenceOfCells weigh_cells(const SolidEvidence& evidence,
                            const std::vector<SurfaceStrokes>& surfaces,
                            const std::vector<Cell>& cells, double extent,
                            const EvidencePrices& prices);

/// Fewest of the cameras that have sights which see a cell's surface at some height along its axis,
/// past the chosen cells: a step instead of it would show to no more of them.
int cameras_at_worst(const SolidEvidence& evidence, const std::vector<SurfaceStrokes>& surfaces,
                     const std::vector<Cell>& cells, const std::vector<bool>& chosen, int cell,
                     double near);

/// Rays that a choice of cells contradicts.
int contradicted(const EvidenceOfCells& weighed, const std::vector<bool>& chosen);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"
#include "topology/solid/contours.h"
#include "topology/solid/find_surfaces.h"
#include "topology/solid/infer_edges.h"

namespace sketchsplat {

/// Where an edge comes from.
enum class EdgeOrigin {
  kSeen,    ///< images show it
  kSmooth,  ///< its surfaces touch along it: no image can show it
  kFaint,   ///< images should have shown it
  kCopy     ///< strokes ask for it: the floor of a pocket of which something else tells how deep
            ///< it is, the third edge of two corners
};

/// A sketch with the edges that its surfaces imply.
struct Completed {
  /// As given, but strokes that run past one another are cut, and rims of extrusions are copies.
  Sketch seen;
  Sketch sketch;  ///< nodes and strokes that are seen, then the others
  std::vector<Eigen::Matrix3Xd> polylines;
  std::vector<SurfaceStrokes> surfaces;
  std::vector<EdgeOrigin> origin;     ///< per stroke
  std::vector<std::vector<int>> now;  ///< of the strokes that were given, those in their place
  std::vector<SurfaceStrokes> more;   ///< spheres, tori and extrusions that the seen ones ask for
  int rims = 0;                       ///< how many of the first others are rims of such
  int most_surfaces = 0;              ///< nothing is added to strokes that ask for more

  void add(const EdgeOrigin& from, StrokeKind kind, int begin, int end,
           const std::vector<Eigen::Vector3d>& handles);
  void add(const ImpliedStroke& implied);
};

/// Adds edges that surfaces imply, and finds all surfaces, until there are no more, or too many.
/// `tolerance`: of a stroke from the surface that it lies on, world units.
void imply(double tolerance, double slide, Completed* all);
/// The strokes, and all that they imply.
Completed complete(const Sketch& seen, const std::vector<ContourLine>& contours, double tolerance,
                   double slide, int most_surfaces);

/// Copies closed loops of strokes in a plane, all of which are `left` (per stroke that is seen: it
/// bounds no face that closes), along the normal of the plane, to the depths that other such
/// strokes tell: lines that lead there from a corner of the loop, and strokes that run below it.
/// Nothing is changed, and false returned, if there is no such loop.
bool copy_loops(const std::vector<bool>& left, double tolerance, double slide,
                Completed* completed);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include "sketches/graph/sketch.h"
#include "topology/core/remap.h"

namespace sketchsplat {

/// What descriptions cost. Every distance is a multiple of `footprint`, so a sketch in other units
/// gives the same result.
struct DescriptionCost {
  double footprint = 0;   ///< world length of one pixel at the object; 0 merges only what coincides
  double sigma_px = 0.2;  ///< standard deviation of what the images say of a place
  double price = 3;       ///< [nat] of a parameter, see SegmentOptions
  double node_price = 20;  ///< [nat] of a node: three times the logarithm of the places it may take
};

struct TopologyOptions : DescriptionCost {
  // Where changes are looked for. Whether they are made is a matter of the description alone.
  double endpoint_px = 3;  ///< between ends that may become one node
  double gap_px = 6;       ///< between the ends of two pieces that may be one curve
  double offset_px = 1.5;  ///< of either from the other where they run side by side
};

// The merges change a sketch where its description becomes shorter: misfit of the points where the
// images put the strokes, plus the price of the nodes and of each curve's parameters between its
// nodes (description.h). Without points the strokes are believed to be where they are
// drawn.
//
// All passes: pure; strokes with NaN or zero length are removed; what comes out is sound
// (validate has no complaint); a second call with the points of the first changes nothing; the
// result does not depend on the order of the strokes (but for their numbers) nor on rotation,
// translation and scale.

/// Ends within reach become one node. Clusters have complete linkage: no two nodes of a cluster are
/// farther apart than `endpoint_px`, however long the chain. The node goes to the point nearest to
/// the tangent lines of all strokes that end in the cluster (their intersection or corner), no
/// farther than that from any of its parts; where the tangents are parallel, to the mean. Strokes
/// follow without kinks. Repeats until no two nodes may be joined.
///   - Two ends are joined only if the way between them along strokes is at least three times as
///     long as their distance: a gap is closed, an edge is not folded. Both ends of an arc make it
///     a circle, those of a cubic a closed cubic.
///   - Afterwards a stroke shorter than the reach may be removed and its ends joined, unless it is
///     part of a loop of such short strokes that is no mere double of a line: a tiny hole made of
///     four arcs stays.
PassResult merge_endpoints(const Sketch& sketch, const TopologyOptions& options,
                           const StrokePoints& points = {});

/// Pieces of one curve that continue one another over a gap or a short overlap become one:
///   line + line -> line; arc + arc -> arc, or circle if they go round; bezier + bezier or arc ->
///   arc or else one cubic; line + arc or bezier -> the same.
/// Never through a node that other strokes share, nor over a gap where another stroke ends.
PassResult merge_collinear(const Sketch& sketch, const TopologyOptions& options,
                           const StrokePoints& points = {});

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "sketches/sketch.h"
#include "topology/remap.h"

namespace sketchsplat {

/// Every distance is a multiple of `footprint`, so a sketch in other units gives the same result.
struct TopologyOptions {
  double footprint = 0;  ///< world length of one pixel at the object; 0 merges only what coincides

  double endpoint_px = 3;         ///< ends at most this far from each other may become one node
  double overlap_px = 2;          ///< of two curves that are drawn twice
  double overlap_share = 0.8;     ///< of the shorter curve's length that must lie on the other
  double overlap_angle_deg = 20;  ///< between their tangents there
  double gap_px = 6;              ///< between the ends of two pieces of one curve
  double offset_px = 1.5;         ///< of the shorter line's ends from the longer line
  double joint_px = 1;            ///< of both pieces from the one curve that replaces them
  double joint_angle_deg = 10;    ///< between tangents where two pieces face each other

  double min_opacity = 0;     ///< see remove_low_opacity
  int min_support_views = 0;  ///< see visibility_filter
  double max_rms_px = std::numeric_limits<double>::infinity();
};

// All passes: pure; strokes with NaN or zero length are removed; what comes out is sound
// (validate has no complaint); a second call changes nothing; the result does not depend on the
// order of the strokes (but for their numbers) nor on rotation, translation and scale.

/// Ends within tolerance become one node. Clusters have complete linkage: no two nodes of a cluster
/// are farther apart than the tolerance, however long the chain. The node goes to the point nearest
/// to the tangent lines of all strokes that end in the cluster (their intersection or corner), no
/// farther than the tolerance from any of its parts; where the tangents are parallel, to the mean.
/// Strokes follow without kinks. Repeats until no two nodes may be joined.
///   - Two ends are joined only if the way between them along strokes is at least three times as
///     long as their distance: a gap is closed, an edge is not folded. Both ends of an arc make it
///     a circle, those of a cubic a closed cubic.
///   - Afterwards a stroke shorter than the tolerance is removed and its ends are joined (again by
///     complete linkage), unless it is part of a loop of such short strokes that is no mere double
///     of a line: a tiny hole made of four arcs stays.
PassResult merge_endpoints(const Sketch& sketch, const TopologyOptions& options);

/// Two curves become one if `overlap_share` of the shorter lies within tolerance of the other with
/// agreeing tangents, and if one curve fits both within tolerance. It is fitted to both, weighted
/// by length times opacity, spans both, and has the kind of the better supported one if that fits,
/// else of the other. Nodes that other strokes share stay where they are.
PassResult merge_overlaps(const Sketch& sketch, const TopologyOptions& options);

/// Pieces of one curve that continue one another over a gap or a short overlap become one:
///   line + line -> line; arc + arc -> arc, or circle if they go round; bezier + bezier or arc ->
///   arc or else one cubic; line + arc or bezier -> the same if the line is short (a third).
/// Never through a node that other strokes share, nor over a gap where another stroke ends.
PassResult merge_collinear(const Sketch& sketch, const TopologyOptions& options);

/// Removes strokes whose opacity is below the threshold, or NaN.
PassResult remove_low_opacity(const Sketch& sketch, double min_opacity);

/// Removes strokes that fewer views see, or that lie farther from their edgels (or NaN).
PassResult visibility_filter(const Sketch& sketch, int min_support_views, double max_rms_px);

}  // namespace sketchsplat

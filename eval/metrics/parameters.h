// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "eval/metrics/prediction.h"
#include "eval/metrics/structure.h"

namespace sketchsplat {

/// What a perfect stroke for this edge would be: "line", "circle" (closed), "arc", "ellipse"
/// (closed), "elliptic_arc", or "bezier" for everything else.
std::string kind_of_edge(const TrueEdge& edge);

/// Numbers that it takes to tell a curve of this kind by itself: line 6 (two ends), circle 6
/// (centre, radius, direction of the axis), arc 8 (that and two angles), ellipse 8 (centre, plane,
/// both axes and their direction), elliptic_arc 10 (that and two angles), bezier 12. 0 for kinds
/// that are not among these.
int degrees_of_freedom(const std::string& kind);

/// Of a polyline: three a vertex.
inline int degrees_of_freedom_of_polyline(int vertices) { return 3 * vertices; }

/// Of all strokes: their degrees of freedom, but 3 less for each end that meets another one, which
/// is told already. `strokes`: samples in order, 3 x N each; `facts` as many.
double count_parameters(const std::vector<Eigen::Matrix3Xd>& strokes,
                        const std::vector<StrokeFacts>& facts);

/// The same of the truth, smooth continuations joined. What is neither line, circle, ellipse nor
/// an arc of these counts as the fewest cubics end to end (each half the length of the one that was
/// too long) that stay within 0.001 of it.
double count_true_parameters(const std::vector<TrueEdge>& edges);

}  // namespace sketchsplat

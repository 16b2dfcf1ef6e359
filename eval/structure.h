// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sketchsplat {

/// A true edge: what kind it is and points along it (3 x N), the object's longest side being 1.
struct TrueEdge {
  std::string type;
  Eigen::Matrix3Xd polyline;
};

/// Joins edges of one type that continue each other where nothing else ends, because files cut a
/// circle into arcs and a long line into pieces: ends within 0.002, directions within 4 degrees
/// (lines) or 12 (other types, whose first and last chords are not their tangents).
std::vector<TrueEdge> merge_smooth(std::vector<TrueEdge> edges);

/// One-to-one agreement of strokes and edges.
struct Structure {
  int strokes = 0, edges = 0;
  int matched = 0;  ///< pairs
  double f = 0;     ///< 2 matched / (strokes + edges), per cent
};

/// A stroke (samples, 3 x N) may be paired with an edge if at least 85 % of it lie within 0.005 of
/// the edge and 85 % of the edge within 0.005 of it; the best pairs are taken first.
Structure match_strokes(const std::vector<Eigen::Matrix3Xd>& strokes,
                        const std::vector<TrueEdge>& edges);

}  // namespace sketchsplat

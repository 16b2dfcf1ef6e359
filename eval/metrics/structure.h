// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "eval/metrics/prediction.h"

namespace sketchsplat {

/// A true edge: what kind it is and points along it (3 x N), the object's longest side being 1.
struct TrueEdge {
  std::string type;
  Eigen::Matrix3Xd polyline;
  std::string name = {};           ///< index in its file; "3+4" after the two were joined
  std::vector<bool> visible = {};  ///< whether each point can be seen; empty if nobody knows
};

/// Joins edges of one type that continue each other where nothing else ends, because files cut a
/// circle into arcs and a long line into pieces: ends within 0.002, directions within 4 degrees
/// (lines) or 12 (other types, whose first and last chords are not their tangents). Arcs of two
/// circles, as of the outline of a bent slot, stay two.
std::vector<TrueEdge> merge_smooth(std::vector<TrueEdge> edges);

/// Points where ends meet, compared with those of the truth. Shares are per cent.
struct Junctions {
  int predicted = 0, truth = 0;
  int matched = 0;  ///< pairs, one to one, nearest first, at most 0.005 apart
  /// NaN if there are none in the truth (recall), or in neither (precision, f).
  double precision = std::numeric_limits<double>::quiet_NaN();
  double recall = std::numeric_limits<double>::quiet_NaN();
  double f = std::numeric_limits<double>::quiet_NaN();
  int truth_visible = 0;  ///< junctions of the truth that can be seen
  double recall_visible = std::numeric_limits<double>::quiet_NaN();  ///< NaN if nobody knows
};

/// One-to-one agreement of strokes and edges. Shares are per cent, NaN where there is nothing to
/// take a share of; lengths are fractions of the object's longest side.
struct Structure {
  int strokes = 0, edges = 0;
  int matched = 0;                         ///< pairs
  std::vector<std::pair<int, int>> pairs;  ///< stroke and edge, best first
  double f = 0;                            ///< 2 matched / (strokes + edges)
  double precision = 0;                    ///< matched / strokes
  double recall = 0;                       ///< matched / edges
  int right_type = 0;  ///< pairs whose stroke is of the edge's kind, see kind_of_edge()
  double right_type_share = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no kinds, no pairs
  double strokes_per_edge = 0;
  Junctions junctions;
  /// Share of the predicted length that runs beside another stroke, see eval/metrics/duplicates.h.
  double duplicated = std::numeric_limits<double>::quiet_NaN();
  double length = 0, true_length = 0;
  double length_error = 0;  ///< (length - true_length) / true_length, per cent
  /// Numbers that the curves are made of, see eval/metrics/parameters.h. NaN if kinds are not
  /// known.
  double parameters = std::numeric_limits<double>::quiet_NaN();
  double true_parameters = 0;
  double parameters_per_true = std::numeric_limits<double>::quiet_NaN();
  /// Edges of which at least half the length can be seen, and how many of these have a partner.
  /// The F is of this recall and the precision above. NaN if nobody knows.
  int visible_edges = 0, visible_matched = 0;
  double recall_visible = std::numeric_limits<double>::quiet_NaN();
  double f_visible = std::numeric_limits<double>::quiet_NaN();
};

/// A stroke (samples, 3 x N) may be paired with an edge if at least 85 % of it lie within 0.005 of
/// the edge and 85 % of the edge within 0.005 of it; the best pairs are taken first. Fills counts,
/// shares and what is visible, nothing else.
Structure match_strokes(const std::vector<Eigen::Matrix3Xd>& strokes,
                        const std::vector<TrueEdge>& edges);

/// All of it. `facts`: as many as strokes, or none. Strokes are joined as the edges are before
/// their junctions are looked for, so that a smooth chain of cubics has none within.
Structure compare_structure(const std::vector<Eigen::Matrix3Xd>& strokes,
                            const std::vector<StrokeFacts>& facts,
                            const std::vector<TrueEdge>& edges);

}  // namespace sketchsplat

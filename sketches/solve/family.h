// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Strokes of two sketches that are the same edge of two siblings.
struct StrokeMatch {
  int other = -1;         ///< stroke of the other sketch; -1: it has none
  bool reversed = false;  ///< the other's stroke runs from end to begin
};

/// For every stroke of `sketch` that of `other`, a sibling in the same frame but for scale, place
/// and proportions. Strokes of one kind are paired, nearest first, where their neighbours' moves
/// (at first: of box onto box) put them; each once.
std::vector<StrokeMatch> match_siblings(const Sketch& sketch, const Sketch& other);

/// What siblings have in common: one graph, and the numbers by which they differ. Coordinates of
/// control points that are equal in every sibling (the height of a face, the radius of two circles)
/// are one number: that is how parts are designed.
struct Family {
  Sketch graph;                 ///< of the sibling that most of the others' strokes are matched to
  std::vector<int> nodes;       ///< 3 N: the number that is this coordinate of a node
  std::vector<int> handles;     ///< 3 M: the same of handles
  std::vector<int> had_by;      ///< per stroke, how many siblings have it
  int siblings = 0;
  Eigen::MatrixXd numbers;      ///< G x siblings: their values, at the graph's scale and place
  Eigen::VectorXd mean;         ///< G
  Eigen::MatrixXd covariance;   ///< G x G of the next sibling's, see learn_family
  Eigen::VectorXd modes;        ///< standard deviations along the principal components, falling

  /// The sibling with these numbers.
  Sketch with(const Eigen::VectorXd& numbers) const;
  /// Prior odds [nat] that a sibling has a stroke: log((k + 1) / (n - k + 1)), k of n have it.
  double log_odds(int stroke) const;
};

/// From at least one sketch with strokes. The covariance is that of the siblings, shrunk towards
/// its diagonal (few siblings tell little of what goes together), times 1 + 1/n, plus what the next
/// one may do that none of these did: a standard deviation of kNovelty / n of the extent.
Family learn_family(const std::vector<Sketch>& siblings);

}  // namespace sketchsplat

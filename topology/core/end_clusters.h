// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "topology/core/draft.h"

namespace sketchsplat {

/// Nodes that are to become one.
struct EndClusters {
  std::vector<int> label;                 ///< cluster of each node: its least member
  std::vector<std::vector<int>> members;  ///< nodes of each cluster, by label
  std::vector<Eigen::Vector3d> at;        ///< where each cluster will be, by label

  /// Every node of the draft alone.
  explicit EndClusters(const Draft& draft);
  /// Returns the label of both together, which will be at `where`.
  int join(int a, int b, const Eigen::Vector3d& where);
};

/// Is it there, and has it ends?
bool is_open(const Piece& piece);

/// The strokes as edges between clusters. Keeps references to both.
class Ways {
 public:
  Ways(const Draft& draft, const EndClusters& clusters);

  /// Strokes that end in a cluster, each once, in their order.
  std::vector<int> strokes_at(int cluster) const;
  /// Length of the shortest way from cluster a to b along strokes that pass `use`; infinite if it
  /// is `limit` or longer.
  double shortest(int a, int b, double limit, const std::function<bool(int)>& use) const;

 private:
  const Draft& draft_;
  const EndClusters& clusters_;
  std::vector<std::vector<int>> at_;  // strokes that end in each node
};

}  // namespace sketchsplat

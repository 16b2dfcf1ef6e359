// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "datasets/types/view.h"
#include "raster/surfels/surfel.h"

namespace sketchsplat {

/// Everything that is fitted of N surfels, as one matrix: a column per surfel.
struct SurfelSet {
  enum Row { kCenter = 0, kRotation = 3, kLogScale = 7, kOpacity = 9, kSkew = 10, kAlbedo = 12 };
  static constexpr int kRows = 15;
  Eigen::MatrixXd values;  ///< kRows x N; fields as in SurfelCloud, then the albedo

  int size() const { return int(values.cols()); }
  Eigen::Vector3d center(int i) const { return values.col(i).segment<3>(kCenter); }
  Eigen::Vector3d normal(int i) const;
  /// Puts surfel i there. Its normal takes the shortest turn, so that scales keep their axes.
  void lay(int i, const Eigen::Vector3d& center, const Eigen::Vector3d& normal);
  Eigen::Matrix3Xd albedo() const { return values.middleRows<3>(kAlbedo); }
  /// The surfels with these colours (3 x N).
  SurfelCloud cloud(const Eigen::Matrix3Xd& color) const;
  /// The matrix of a gradient by a cloud and by its albedo.
  static Eigen::MatrixXd gradient(const SurfelCloud& by_cloud, const Eigen::Matrix3Xd& by_albedo);
};

/// The surfels whose outer side (+ normal) a camera can see, and their indices: of a closed surface
/// nothing else is visible, and what shines through a surface from behind spoils its depth.
SurfelCloud facing_surfels(const SurfelCloud& cloud, const View& view, std::vector<int>* indices);

/// Back to one column per surfel of the whole cloud; the others' are 0.
SurfelGradient spread_gradient(const SurfelGradient& part, const std::vector<int>& indices, int n);

/// What density control does: columns that stay, in their order, then new ones.
struct DensityChange {
  std::vector<int> kept;       ///< indices of the old surfels that stay
  Eigen::MatrixXd added;       ///< kRows x M, appended
  int pruned = 0, split = 0,
      merged = 0;  ///< surfels: gone for nothing; halved; swallowed by others
};

/// Splits where the splitting matrix (3 x N, SurfelGradient) has a negative eigenvalue, the most
/// negative first and no more than `most`: to both sides along its eigenvector, half a standard
/// deviation away, opacity halved (SteepGS). Removes what is fainter than `min_alpha` or makes less
/// than `min_weight` of the images.
DensityChange steep_split(const SurfelSet& set, const Eigen::Matrix3Xd& splitting,
                          const Eigen::VectorXd& weight, double min_alpha, double min_weight,
                          int most);

/// The older rule: the `most` surfels whose footprints are pulled hardest (`pull`, 2 x N) split
/// along their longer axis, scales divided by 1.6; removal as above.
DensityChange clone_split(const SurfelSet& set, const Eigen::Matrix2Xd& pull,
                          const Eigen::VectorXd& weight, double min_alpha, double min_weight,
                          int most);

/// Pairs (i < j) among the nearest `count` neighbours of each whose normals differ by less than
/// `max_angle_deg` and that lie within `reach` of each other.
std::vector<std::pair<int, int>> neighbour_pairs(const SurfelSet& set, int count, double reach,
                                                 double max_angle_deg);

/// Merges pairs whose influence vectors have a cosine above `min_cosine` (PINGS-X), the highest
/// first, no surfel twice: mean weighed by area and opacity, scales by the second moments.
DensityChange merge_pairs(const SurfelSet& set, const std::vector<std::pair<int, int>>& pairs,
                          const Eigen::VectorXd& cosine, double min_cosine);

/// Applies a change to a matrix with a column per surfel; what is new is `fresh` (as many columns
/// as change.added has), or zero if that is empty.
Eigen::MatrixXd apply_change(const Eigen::MatrixXd& columns, const DensityChange& change,
                             const Eigen::MatrixXd& fresh = {});

}  // namespace sketchsplat

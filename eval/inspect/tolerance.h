// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sketchsplat {

/// Probability that a normal number lies within +- half of 0; `sigma` may be 0.
double interval_probability(double mean, double sigma, double half);

/// The same of a normal deviation in the plane and the square of that half side along the axes of
/// its covariance: a product of differences of erf.
double square_probability(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                          double half);

/// How a curve deviates from its nominal one at some places along it: across the nominal curve mean
/// + modes * z, z independent standard normal numbers that all places share.
struct DeviationModel {
  Eigen::Matrix2Xd mean;  ///< 2 x P
  Eigen::MatrixXd modes;  ///< 2 P x M
  /// What a deviation between neighbouring places may be is at most that of the places over this.
  double between = 1;
};

/// One of these or another, all at the same places.
struct DeviationMixture {
  std::vector<DeviationModel> parts;
  std::vector<double> weights;  ///< of the parts, sum 1
};

/// Of the probability that a curve lies within a tube: what is proven, what is likely.
struct TubeProbability {
  double low = 0, likely = 0, high = 0;
};

/// Bounds in closed form, as SPLANNING bounds collisions (Michaux et al., IEEE T-RO 41, 2025), here
/// both ways: at a place the square in the tube's disc is passed less, the square around it more
/// often than the disc; all places are passed at least with 1 - sum (1 - P) (Boole), at most with
/// the least P. `likely` is left alone.
void bound_tube(const std::vector<DeviationMixture>& pieces, double radius,
                TubeProbability* probability);

constexpr int kDraws = 4096;
/// Largest deviations of so many draws of the curve, ascending: the share of them below a radius
/// is the likely probability. The draws are the same in every run.
std::vector<double> draw_largest(const std::vector<DeviationMixture>& pieces);

/// Share of ascending values that are at most `radius`.
double share_within(const std::vector<double>& ascending, double radius);

}  // namespace sketchsplat

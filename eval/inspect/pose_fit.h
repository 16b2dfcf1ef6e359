// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eval/inspect/edge_samples.h"
#include "eval/inspect/nominal.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {

/// A place of the measured sketch beside the nominal edge it lies on.
struct PosePlace {
  Eigen::Vector3d measured;  ///< where the pose puts it
  Eigen::Vector3d gap;       ///< from the nominal curve to it, across the curve
  Eigen::Vector3d tangent;   ///< unit, of the nominal curve
  int sample = 0, edge = 0;  ///< of the measured samples; of the nominal
  double weight = 0;
};

/// Places that want the gap to close along some directions: `across` projects on them.
struct PoseSystem {
  Eigen::Matrix<double, 7, 7> information = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> slope = Eigen::Matrix<double, 7, 1>::Zero();
  double weight = 0;
};

/// The move that closes the gaps, along those combinations of the columns of `basis` (7 x B,
/// orthonormal) of which the system holds more than the share `least` of its weight; `left`, which
/// may be the basis: the columns that are not held, 7 x what is left. May be null.
Eigen::Matrix<double, 7, 1> solve(const PoseSystem& system, const Eigen::MatrixXd& basis,
                                  double least, Eigen::MatrixXd* left);

/// Small moves of the measured sketch about a centre: turn, shift and growth, all as the lengths by
/// which they move what lies `lever` away.
class PoseFit {
 public:
  /// What is in the nominal; samples at most `spacing` apart. `reach`: of all queries, at most.
  PoseFit(const Nominal& nominal, double reach);

  /// Nearest nominal places within `reach` that run the same way. `exact`: on the curve, else on
  /// the tangent of the nearest sample. `every`: of so many samples one.
  std::vector<PosePlace> places(const EdgeSamples& samples, const Similarity& pose, double reach,
                                bool exact, int every) const;

  void add(const PosePlace& place, const Eigen::Matrix3d& across, PoseSystem* system) const;
  /// Derivative of a place by the move.
  Eigen::Matrix<double, 3, 7> jacobian(const Eigen::Vector3d& measured) const;
  Similarity after(const Similarity& pose, const Eigen::Matrix<double, 7, 1>& move) const;

  const Eigen::Vector3d& centre() const { return centre_; }
  double lever() const { return lever_; }
  const EdgeSamples& samples() const { return samples_; }

 private:
  const Nominal& nominal_;
  EdgeSamples samples_;
  SampleGrid grid_;
  Eigen::Vector3d centre_;
  double lever_;
};

/// Scale of the gaps, as the standard deviation of either component: from their median, weighted.
double robust_scale(const std::vector<PosePlace>& places);

/// Multiplies weights by Tukey's biweight of gap / (4.685 scale).
void weigh_down(double scale, std::vector<PosePlace>* places);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eval/inspect/alignment.h"
#include "eval/inspect/edge_samples.h"
#include "eval/inspect/pose_fit.h"

namespace sketchsplat {

/// Share of the weight of a system, below which a direction is not held.
constexpr double kFreeDirection = 1e-6;
constexpr double kLeastGap = 1e-7;  ///< [extents] curves of computers agree to that
constexpr int kMostPoseSteps = 15;

/// Robust least squares of the pose of a measured sketch: distances across nominal edges, with
/// Tukey's biweight about a scale that their median tells. Keeps references to all it is given.
class RobustFit {
 public:
  /// `reach` [extents]: of all queries, at most.
  RobustFit(const Sketch& measured, const Nominal& nominal, const AlignOptions& options,
            double reach);

  const PoseFit& fit() const { return fit_; }
  const Sketch& measured() const { return measured_; }
  const Nominal& nominal() const { return nominal_; }
  const AlignOptions& options() const { return options_; }
  const EdgeSamples& samples() const { return samples_; }  ///< of the measured sketch
  double extent() const { return extent_; }                ///< of the measured sketch
  /// Columns are the moves that are free: 7 x 6, or 7 x 7 if the scale is fitted.
  const Eigen::MatrixXd& basis() const { return basis_; }

  /// Take one sample of so many for about `samples` of them.
  int every(int samples) const;
  /// What lies within the options' reach, with all its weight.
  std::vector<PosePlace> near_places(const Similarity& pose, int every) const;
  /// The same by its sigma and the biweight.
  std::vector<PosePlace> weighed_places(const Similarity& pose, int every) const;
  /// One step of Gauss and Newton along the columns of `basis`.
  Similarity step(const Similarity& pose, const std::vector<PosePlace>& places,
                  const Eigen::MatrixXd& basis) const;
  /// Until it stands still, at most so many steps.
  Similarity fitted(Similarity pose, int every, const Eigen::MatrixXd& basis) const;

 private:
  const Sketch& measured_;
  const Nominal& nominal_;
  const AlignOptions& options_;
  PoseFit fit_;
  double extent_, typical_sigma_;
  EdgeSamples samples_;
  Eigen::MatrixXd basis_;
};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "eval/inspect/nominal.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {

enum class AlignTo { kBestFit, kAsGiven };

struct AlignOptions {
  AlignTo to = AlignTo::kBestFit;
  /// The measured sketch has no scale: it is fitted, and sizes say nothing.
  bool fit_scale = false;
  /// Relative standard deviation of the scale of the measured sketch, because of its cameras; 0: it
  /// is exact. The best fit of all edges then moves it as far as it is not known.
  double scale_sigma = 0;
  /// Names of edges or planes, the first counts most: each holds of the pose what those before it
  /// leave free, the best fit holds the rest. Empty: the best fit of all edges.
  std::vector<std::string> datums = {};
  double reach = 0.015;  ///< [nominal extents] farther away nothing is the same edge
};

/// Where the measured sketch was put.
struct Alignment {
  Similarity pose;          ///< of the measured sketch into the nominal's frame and unit
  double rms = 0;           ///< of the places that hold the pose, across their edges
  double share = 0;         ///< of the measured length that lies within reach of nominal edges
  std::vector<bool> holds;  ///< nominal edges that held the pose; the others had no say
  /// Of a small turn [rad] about `centre` and a shift of the measured sketch, in the nominal's
  /// frame, from the covariances of the strokes that hold the pose.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double scale_sigma = 0;   ///< relative, of the scale as it is then
  int free_directions = 0;  ///< that no edge determines: the spin of a turned part
  int equal_poses = 1;      ///< that fit as well to the last digit: the nominal is symmetric
  /// Cost of the next pose that is not equal over that of this one; infinite if there is none.
  double runner_up = 0;
};

/// Best pose by edges. All poses that directions, inertia and like strokes suggest are tried
/// (pose_candidates), the best by robust least squares of distances across the nominal edges; of
/// poses that fit equally, because the nominal is symmetric, the one with the least turn from how
/// the files stand. Edges far off, moved or missing, have no say in it (Tukey's biweight).
/// Throws InputError if a datum has no such name or nothing was measured near it.
Alignment align(const Sketch& measured, const Nominal& nominal, const AlignOptions& options);

}  // namespace sketchsplat

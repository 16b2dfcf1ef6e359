// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "eval/inspect/alignment.h"
#include "eval/inspect/association.h"
#include "eval/inspect/tolerance.h"
#include "sketches/sketch.h"

namespace sketchsplat {

/// From what the edgels say of a stroke (its covariance) to how far off it is. The numbers are
/// fitted by eval/calibrate_inspection.py, see docs/inspect.md.
struct SigmaOptions {
  double straight = 0.3;   ///< sigma of a line over that of its covariance
  double curved = 0.8;     ///< the same of all other curves
  double place_px = 0.01;  ///< [px] by which a stroke as a whole may be off, in each direction
  /// [px^2] over the radius of curvature [px]: by so much may a curve lie nearer to, or farther
  /// from, its centre of curvature, because blurred edges do.
  double curvature_px2 = 1;
  double tail_share = 0.1;   ///< of strokes are worse
  double tail_factor = 2.5;  ///< by so much
  double scale_percent = 0;  ///< [%] standard deviation of the scale
};

/// Everything that errors are made of. Lengths in the nominal's unit.
struct SigmaModel {
  SigmaOptions options;
  double footprint = 0;  ///< length of a pixel at the part; 0 if nobody knows: no errors in px
  const Alignment* alignment = nullptr;

  Tail tail() const { return {options.tail_share, options.tail_factor}; }
};

/// Covariance of the control points of a stroke (3 n square), calibrated. Without a covariance, of
/// its sigma alone.
Eigen::MatrixXd calibrated_covariance(const Sketch& measured, int stroke,
                                      const SigmaOptions& options);

/// Does the stroke have directions that no edgel determines? They have variance 0, which means
/// nothing.
bool is_open(const Sketch& measured, int stroke);

/// Derivative of the unit tangent by arc length: towards the centre of curvature, 1 / radius long.
Eigen::Vector3d curvature_at(const Sketch& sketch, int stroke, double t);

/// Errors at some places of one stroke that were measured beside a nominal edge.
struct PieceErrors {
  DeviationModel model;
  double sigma = 0;       ///< largest standard deviation, from the edgels
  double systematic = 0;  ///< the same, from what edgels do not know: place, curvature, scale, pose
};
/// `places`: of one stroke; `held`: the edge held the pose. Else errors of the pose are added.
PieceErrors piece_errors(const Sketch& measured, const std::vector<EdgePlace>& places, bool held,
                         const SigmaModel& sigma);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "eval/inspect/alignment.h"
#include "eval/inspect/association.h"
#include "eval/inspect/tolerance.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// From what the edgels say of a stroke to how far off it is. The numbers are fitted by
/// eval/calibrate_inspection.py, see docs/inspect.md.
struct SigmaOptions {
  /// Of lines, then of all other curves. Sigma over that of the covariance: factor (b /
  /// sigma)^power, b the length by which the stroke's views disagree. The covariance knows the
  /// shape of the error; its size is of all strokes together, and knows nothing of the regularities
  /// that average errors away.
  double straight_factor = 0.164, straight_power = 0.4;
  double curved_factor = 0.39, curved_power = 0.48;
  /// By which a stroke is off as a whole, in each direction: shares of b and of the b of all
  /// strokes.
  double straight_place = 0.48, straight_views = 0.22;
  double curved_place = 0.154, curved_views = 0.09;
  double place_px = 0.0003;  ///< [px] and always
  /// [px^2] over the radius of curvature [px]: by so much a curve lies nearer to its centre of
  /// curvature, because blurred edges do, and the standard deviation of that.
  double curvature_px2 = 0.21, curvature_sigma_px2 = 0.26;
  /// [px] standard deviation of what all of a curve lies nearer to its centre of curvature or
  /// farther from it, whatever its radius: pictures are encoded, so that edges lie nearer to their
  /// dark side, which of a hole is inside in all views.
  double dark_side_px = 0.037;
  double tail_share = 0.166;     ///< of strokes are worse
  double straight_tail = 3;  ///< by so much
  double curved_tail = 4.2;
  double scale_percent = 0;  ///< [%] standard deviation of the scale
};

/// The fitted ones, by name.
std::vector<std::pair<std::string, double*>> named_numbers(SigmaOptions* options);

/// Everything that errors are made of. Lengths in the nominal's unit.
struct SigmaModel {
  SigmaOptions options;
  double footprint = 0;  ///< length of a pixel at the part; 0 if nobody knows: no errors in px
  double bias_px = 0;    ///< by which views disagree: median over the strokes
  const Alignment* alignment = nullptr;
  bool without_pull = false;  ///< the mean pull of blur has been taken off what was measured

  double pull_px2() const;  ///< standard deviation of that pull, or its size if it is still there
  /// One standard deviation each of that, and of the dark side, at a place of a stroke.
  Eigen::Matrix<double, 3, 2> radial_errors(const Sketch& measured, int stroke, double t) const;
  double factor(const Stroke& stroke, const Evidence& evidence) const;
  double wide(StrokeKind kind) const;  ///< sigma of the worse ones over the others'
  double place(const Stroke& stroke,
               const Evidence& evidence) const;  ///< by which it is off as a whole
};

/// Median over the strokes of what their views disagree by; 0 if there are none.
double typical_bias_px(const Sketch& measured);

/// Covariance of the control points of a stroke (3 n square), calibrated. Without a covariance, of
/// its sigma alone.
Eigen::MatrixXd calibrated_covariance(const Sketch& measured, int stroke, const SigmaModel& sigma);

/// Was it the faces of a solid that put the stroke there, and no edgels, which others have?
bool is_implied(const Sketch& measured, int stroke, const SigmaModel& sigma);

/// Does the stroke have directions that no edgel determines? They have variance 0, which means
/// nothing.
bool is_open(const Sketch& measured, int stroke);

/// Two unit vectors across a unit tangent, as rows.
Eigen::Matrix<double, 2, 3> frame_across(const Eigen::Vector3d& tangent);

/// By how much a curve may be off towards its centre of curvature, for each px^2 of
/// SigmaOptions::curvature_px2, at most a pixel; zero of lines and without a footprint.
Eigen::Vector3d bend_at(const Sketch& measured, int stroke, double t, double footprint);

/// Errors at some places of one stroke that were measured beside a nominal edge.
struct PieceErrors {
  DeviationModel model;
  /// The stroke is of another kind than the nominal edge, because views could not tell them apart:
  /// what of its shape differs says nothing.
  bool unlike = false;
  double wide = 1;        ///< with the probability of tails, modes are so many times as large
  double sigma = 0;       ///< largest standard deviation, from the edgels
  double systematic = 0;  ///< the same, from what edgels do not know: place, curvature, scale, pose
};
/// `places`: of one stroke; `held`: the edge held the pose. Else errors of the pose are added.
PieceErrors piece_errors(const Sketch& measured, const std::vector<EdgePlace>& places, bool held,
                         const SigmaModel& sigma);

}  // namespace sketchsplat

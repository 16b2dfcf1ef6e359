// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "eval/inspect/alignment.h"
#include "eval/inspect/association.h"
#include "eval/inspect/tolerance.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Errors are so many times as large as SigmaOptions says, each size with a share of a kind of
/// curve: a mixture of normal distributions whose tails are as they were met, whatever they are.
constexpr std::array<double, 9> kErrorSizes = {0.15, 0.25, 0.4, 0.63, 1, 1.6, 2.5, 4, 6.3};
using ErrorShares = std::array<double, kErrorSizes.size()>;  ///< sum 1

/// Root mean square of the sizes.
double spread(const ErrorShares& shares);
/// The sizes over that: of errors whose standard deviation is known.
std::array<double, kErrorSizes.size()> sizes_of(const ErrorShares& shares);
/// Those of the larger sizes.
ErrorShares worse_of(const ErrorShares& a, const ErrorShares& b);

/// From what the edgels say of a stroke to how far off it is. The numbers are fitted by
/// eval/calibrate_inspection.py, see docs/inspect.md.
struct SigmaOptions {
  struct OfKind {
    /// Sigma over that of the covariance: factor (b / sigma)^power, b the length by which the
    /// stroke's views disagree. The covariance knows the shape of the error; its size is of all
    /// strokes together, and knows nothing of the regularities that average errors away.
    double factor, power;
    /// By which a stroke is off as a whole, in each direction: shares of b and of the b of all
    /// strokes.
    double place, views;
    ErrorShares shares;
  };
  OfKind straight = {
      0.16, 0.625, 1.536, 0.48, {0.232, 0.231, 0.238, 0.165, 0.084, 0.036, 0.01, 0.003, 0.001}};
  OfKind closed = {
      0.375, 1.6, 1.92, 0.05, {0.147, 0.212, 0.321, 0.24, 0.063, 0.01, 0.004, 0.002, 0.001}};
  OfKind arc = {
      0.7273, 0.48, 0.1, 0.06, {0.009, 0.017, 0.035, 0.162, 0.528, 0.204, 0.027, 0.009, 0.009}};
  /// Cubics, arcs of ellipses.
  OfKind free = {
      2, 0.6, 0.1, 0.06, {0.007, 0.015, 0.083, 0.408, 0.429, 0.042, 0.008, 0.005, 0.003}};
  double place_px = 0.0008;  ///< [px] and always
  /// [px^2] over the radius of curvature [px]: by so much a curve lies nearer to its centre of
  /// curvature, because blurred edges do, and the standard deviation of that.
  double curvature_px2 = 0.25, curvature_sigma_px2 = 1.25;
  /// [px] standard deviation of what all of a curve lies nearer to its centre of curvature or
  /// farther from it, whatever its radius: pictures are encoded, so that edges lie nearer to their
  /// dark side, which of a hole is inside in all views.
  double dark_side_px = 0.03;
  /// [px] standard deviation of what the shape is off of lines and of other curves that stand for a
  /// nominal edge of a richer kind, because the views could not tell them apart.
  double straight_form_px = 0.25, form_px = 0.0875;
  double scale_percent = 0;  ///< [%] standard deviation of the scale
};

/// Those of a kind of curve: lines; circles and ellipses; arcs of circles; the others.
const SigmaOptions::OfKind& of_kind(const SigmaOptions& options, StrokeKind kind);

/// Errors have the size that is expected of them, no tails.
void without_tails(SigmaOptions* options);

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
  /// Standard deviation of a stroke over that of its covariance.
  double factor(const Stroke& stroke, const Evidence& evidence) const;
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

/// Is the kind of the stroke simpler than that of the nominal edge?
bool is_simpler(StrokeKind stroke, StrokeKind nominal);

/// Errors at some places of one stroke that were measured beside a nominal edge.
struct PieceErrors {
  DeviationModel model;
  ErrorShares shares = {};
  int stated = 0;         ///< of the modes, the last ones: of the scale, whose sigma is known
  /// Its kind than that of the nominal edge, or a spline of fewer cubics: what of its shape differs
  /// says nothing.
  bool simpler = false;
  double sigma = 0;       ///< largest standard deviation, from the edgels
  double systematic = 0;  ///< the same, from what edgels do not know: place, curvature, scale, pose
};
/// `places`: of one stroke; `nominal`: kind of the edge that it stands for; `held`: the edge held
/// the pose. Else errors of the pose are added.
PieceErrors piece_errors(const Sketch& measured, const std::vector<EdgePlace>& places,
                         StrokeKind nominal, bool held, const SigmaModel& sigma);

}  // namespace sketchsplat

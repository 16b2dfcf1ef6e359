// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/fit/run_fit.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct SegmentOptions {
  double sigma = 0.3;        ///< times `unit`: standard deviation of the points, if not given
  double price = 3.0;        ///< [nat] of a parameter: half the logarithm of the number of edgels
  double corner_deg = 25.0;  ///< [deg] turn from point to point that ends a piece
  int min_points = 3;        ///< shorter pieces are dropped
  double min_length = 4.0;   ///< times `unit`: so are these
  bool conics = true;        ///< arcs, circles and ellipses are tried, not lines and cubics alone
  bool elliptic = true;      ///< arcs of ellipses are, too
};

/// Parameters of a curve that goes on from the one before it: where it ends and how it bends.
constexpr int num_parameters(StrokeKind kind) {
  return kind == StrokeKind::kLine          ? 3
         : kind == StrokeKind::kArc         ? 5
         : kind == StrokeKind::kCircle      ? 6
         : kind == StrokeKind::kEllipticArc ? 7
                                            : 8;
}

/// What points at these distances from a curve cost [nat]: their squares in units of 2 sigma^2,
/// each at most kOutlierNats.
constexpr double kOutlierNats = 8;
double misfit(const Eigen::VectorXd& distance, double sigma);

/// Length of a description [nat]: the misfit and the price of the curve's parameters.
double description_length(const Eigen::VectorXd& distance, double sigma, StrokeKind kind,
                          const SegmentOptions& options);

/// What it costs [nat], or saves, that a curve of one kind goes on from one of another within a
/// run:
///   - a cubic after a cubic goes on smoothly, so its first tangent is known;
///   - lines and arcs run into one another, and so do cubics, in a spline; that one turns into the
///     other, or into an arc of an ellipse, is rare on parts, and has to be said.
double joint_cost(StrokeKind before, StrokeKind after, const SegmentOptions& options);

/// Points [first, last) of a run and their curve.
struct RunPiece {
  int first = 0, last = 0;
  RunFit fit;
  double cost = 0;  ///< description length, less what it saves after its neighbour
};

/// Cuts an ordered run into the curves whose description is the shortest: lines, arcs, arcs of
/// ellipses, cubics, or one circle or ellipse if it is closed (then the pieces begin at a cut, and
/// indices go on from n to 2 n). Dynamic programming over cuts (Bellman 1961), then each cut alone
/// is moved to where it is best. `points`, `tangents`: 3 x n, `sigma`: of the points, world units.
std::vector<RunPiece> cut_run(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& tangents,
                              bool closed, double sigma, double unit,
                              const SegmentOptions& options);

/// Cuts a run of points with tangents at its corners, then each part as cut_run does, but never
/// into arcs of ellipses: lifted points scatter too much to tell them. Strokes are
/// appended to `sketch`, with nodes of their own. `unit` is the length that tolerances are measured
/// in (one pixel at the object), world units.
void segment_chain(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& tangents, bool closed,
                   double unit, const SegmentOptions& options, Sketch* sketch);

}  // namespace sketchsplat

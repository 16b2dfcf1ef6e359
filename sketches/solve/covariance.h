// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/curve/sample.h"

namespace sketchsplat {

/// What one view says of a sample: after a move d of the sample its signed distance to the edge is
/// distance_px + direction . d.
struct Sighting {
  int sample = 0;  ///< of a SampleLayout
  int view = 0;
  int edgel =
      0;  ///< of the view: neighbours of a foreshortened stroke find the same, which errs once
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< [px / world unit]
  double distance_px = 0;
};

/// How uncertain a stroke is, from its own sightings: what strokes that share its nodes say is not
/// used, so it is an upper bound of the marginal covariance within the whole sketch.
struct StrokeCovariance {
  /// 3n x 3n for the n control points in the order of StrokeKind, x y z each; world units squared.
  /// Directions that the sightings do not determine - control points that slide along the curve,
  /// the apex of an arc along its chord, the phase of an ellipse - have variance 0: take them as
  /// held, not as known.
  Eigen::MatrixXd matrix;
  /// Directions that are determined: its rank. A shape has 4 (line), 6 (arc, circle), 8 (ellipse)
  /// or 10 (cubic; fewer the straighter it is); less means that the rest is open.
  int determined = 0;
  /// Largest standard deviation of a point of the curve across the curve [world units].
  double sigma = 0;
};

struct CovarianceOptions {
  double reach_px = 1;  ///< [px] of the biweight that the curve was fitted with
  /// Sightings' worth by which a stroke's own scatter is drawn to that of all strokes.
  double pooled = 30;
};

/// Of every stroke of the sketch at its least-squares place; `sightings` in the order of samples.
///   C = K (s^2 sum_e g_e g_e^T + t^2 sum_v g_v g_v^T) K,  K = (sum j j^T)^+,
/// g_e, g_v: sums of j over the sightings of an edgel, of a view;
/// j = derivative of the distance by the control points, of moves across the curve only.
/// s^2: scatter of one sighting, for a robust fit mean psi^2 / (mean psi')^2 with the degrees of
/// freedom taken off (Huber & Ronchetti 2009, Robust Statistics, section 7.6); t^2: variance that a
/// view's sightings of a stroke have in common (errors of poses, of the edge detector), from the
/// means by stroke and view of the whole sketch.
std::vector<StrokeCovariance> stroke_covariances(const Sketch& sketch, const SampleLayout& layout,
                                                 const std::vector<Sighting>& sightings,
                                                 const CovarianceOptions& options = {});

/// Upper triangle of a symmetric matrix, row by row; and back.
std::vector<double> upper_triangle(const Eigen::MatrixXd& matrix);
Eigen::MatrixXd from_upper_triangle(const std::vector<double>& values);

}  // namespace sketchsplat

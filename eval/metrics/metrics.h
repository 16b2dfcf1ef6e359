// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "datasets/truth/ground_truth.h"
#include "eval/metrics/prediction.h"

namespace sketchsplat {

/// Samples of the primitives as the published evaluators take them: curves first, then lines;
/// length // step of each, both ends included, cubics uniform in the parameter, their length by
/// Simpson's rule on 10000 pieces. What is shorter than `step` gives none. 3 x N.
Eigen::Matrix3Xd sample_published(const Prediction& prediction, double step);

/// Samples of the primitives uniform in arc length, int(length / step) pieces of each but at least
/// one, both ends included; cubics as 199 chords. 3 x N.
Eigen::Matrix3Xd sample_arc_length(const Prediction& prediction, double step);

/// Each segment of a polyline (3 x N) cut into int(length / spacing) pieces, at least one.
/// `nearest`: which point of the polyline each sample is nearest to along it.
Eigen::Matrix3Xd densify(const Eigen::Matrix3Xd& polyline, double spacing,
                         std::vector<int>* nearest = nullptr);

/// A polyline (3 x N, N >= 1) at equal steps of its length of at most `spacing`, both ends
/// included.
Eigen::Matrix3Xd resample(const Eigen::Matrix3Xd& polyline, double spacing);

double polyline_length(const Eigen::Matrix3Xd& polyline);

/// Mean of the points in each of `count`^3 voxels over [low, high]^3; points outside fall into
/// voxels beyond and are kept. Ordered by voxel.
Eigen::Matrix3Xd voxel_average(const Eigen::Matrix3Xd& points, int count, double low, double high);

/// Precision, recall and F at one distance, per cent. F = 2PR / (P + R + 1e-7) of the shares.
struct Level {
  double threshold = 0;
  double precision = 0, recall = 0, f = 0;
  /// Recall of the truth that can be seen, and F of that and `precision` (which is against all of
  /// the truth: what nobody sees may still be right). NaN if the truth does not say.
  double recall_visible = std::numeric_limits<double>::quiet_NaN();
  double f_visible = std::numeric_limits<double>::quiet_NaN();
};

/// Of many distances; percentiles interpolated linearly between ranks, as numpy's. NaN if there
/// are none.
struct Spread {
  double median = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
  double worst = std::numeric_limits<double>::quiet_NaN();
};

Spread spread_of(const Eigen::VectorXd& distances);

struct Score {
  int samples = 0;          ///< of the prediction
  int truth_samples = 0;    ///< of the truth
  double accuracy = 0;      ///< mean distance prediction -> truth; NaN if there is no prediction
  double completeness = 0;  ///< mean distance truth -> prediction; NaN if there is no prediction
  std::vector<Level> levels;
  Spread to_truth;          ///< distances prediction -> truth, whose mean is the accuracy
  Spread to_prediction;     ///< distances truth -> prediction, whose mean is the completeness
  int visible_samples = 0;  ///< of the truth; 0 if the truth does not say
  /// Mean distance visible truth -> prediction; NaN if the truth does not say.
  double completeness_visible = std::numeric_limits<double>::quiet_NaN();
};

/// Compares two sets of samples; a distance counts if it is strictly below a threshold.
/// `truth` must not be empty. `visible`: whether each column of the truth can be seen; empty if
/// nobody knows.
Score score(const Eigen::Matrix3Xd& prediction, const Eigen::Matrix3Xd& truth,
            const std::vector<double>& thresholds, const std::vector<bool>& visible = {});

/// Coordinates rounded to float32, as the published evaluators keep them.
Eigen::Matrix3Xd as_float(const Eigen::Matrix3Xd& points);

}  // namespace sketchsplat

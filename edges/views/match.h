// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "edges/views/lift.h"

namespace sketchsplat {

/// Points on curves in space that look for their edgels. Points of a curve are consecutive.
struct CurvePoints {
  Eigen::Matrix3Xd position;  ///< 3 x N, world units
  Eigen::Matrix3Xd tangent;   ///< 3 x N, unit
  std::vector<int> first;     ///< C + 1: curve c owns samples first[c] .. first[c + 1] - 1
  /// 3 x N, towards the centre of curvature, 1 / radius long; empty: blur is not allowed for. An
  /// edge that bends appears nearer to its centre of curvature than it is, see pull_of_blur.
  Eigen::Matrix3Xd curvature = {};
};

/// Whether the points of one curve, two or more that are equally far apart, go around: the last is
/// next to the first.
bool closes(const CurvePoints& curve);

struct MatchOptions {
  double reach_px = 1.5;  ///< [px] largest distance across the edge
  double angle_deg = 15;  ///< [deg] largest angle between the edgel's plane and the tangent
  double min_run = 0.15;  ///< share of a curve's samples below which a view's matches are accidents
  double max_bias =
      0;  ///< [px] a view whose median distance to a curve is larger does not count; 0: off
  bool exclusive = true;  ///< an edgel belongs to the curve that lies nearest to it
  /// So do the edgels between those that neighbouring samples of a curve found: samples are farther
  /// apart than edgels, and what lies beside a visible curve would find the others.
  bool exclusive_between = false;
  bool quadratics = true;  ///< fill in `information` and `slope`
};

/// One edgel that a sample explains.
struct SampleMatch {
  int sample, view, edgel;
  float distance_px;  ///< signed, along the edgel's normal: where it should be minus edgel
  float weight;       ///< in (0, 1], biweight of distance / reach
};

/// All matches, by sample and then by view, and the quadratic that they add up to: the squared
/// pixel distances after moving sample i by d are, to second order, d^T information[i] d + 2
/// slope[i]^T d.
struct Matches {
  std::vector<SampleMatch> matches;
  std::vector<int> first;                    ///< N + 1, into matches
  std::vector<Eigen::Matrix3d> information;  ///< [px^2 / world^2]; empty if not asked for
  Eigen::Matrix3Xd slope;                    ///< 3 x N [px^2 / world]; empty if not asked for
  double sigma_px = 0;                       ///< robust standard deviation of the distances
  int views_of(int sample) const { return first[sample + 1] - first[sample]; }
};
/// Change of a match's distance by a move of its sample, which is at `position` [px / world].
Eigen::Vector3d distance_gradient(const EdgeWorld& world, const SampleMatch& match,
                                  const Eigen::Vector3d& position);
Matches match_samples(const EdgeWorld& world, const CurvePoints& samples,
                      const MatchOptions& options);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/adjust/standard_series.h"

namespace sketchsplat {

/// Lengths that were measured together, in the unit of the series (mm or inch).
struct MeasuredLengths {
  Eigen::VectorXd value;       ///< n
  Eigen::MatrixXd covariance;  ///< n x n, but for the scale
  double scale_sigma = 0;      ///< relative standard deviation of the scale, which all share
  std::vector<char> diameter;  ///< n: series of drills are for these
};

/// One of them that is a standard one.
struct ChosenStandard {
  int length = 0;  ///< which
  StandardLength standard;
  double nats = 0;  ///< by which the description becomes shorter, given those chosen before
};

struct StandardChoice {
  std::vector<ChosenStandard> lengths;
  double scale = 1;        ///< by which lengths are to be multiplied, as they tell together
  double scale_sigma = 0;  ///< relative, then
};

/// The lengths that are told shorter as standard ones, longest saving first. A free number costs
/// -log of its density times its standard deviation and sqrt(2 pi) (Laplace), a standard one that
/// of its density times the spacing, half the squared distance in standard deviations, and `price`
/// [nat] for saying that it is one: the others are free. What was chosen counts as known, so that
/// lengths which share strokes or the scale are judged together: conditional distributions, so
/// that the order in which they are given does not matter. Nothing farther than two standard
/// deviations is tried, neither by itself nor given the others; what the others determine already
/// saves nothing.
StandardChoice choose_standards(const MeasuredLengths& lengths, StandardSystem system,
                                double price);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eval/inspect/association.h"
#include "eval/inspect/sigma_model.h"

namespace sketchsplat {

/// What dimensions are taken between: the line of an edge, the circle of one, the plane of faces.
enum class FeatureKind { kLine, kCircle, kPlane };
struct FeatureRef {
  FeatureKind kind = FeatureKind::kLine;
  int index = 0;  ///< of the nominal edge, or the nominal plane
};

struct Feature {
  Eigen::Vector3d point;      ///< middle of the line or the plane's points; centre of the circle
  Eigen::Vector3d direction;  ///< unit: of the line; normal of circle and plane
  double radius = 0;          ///< of a circle
  bool ok = false;            ///< enough points, not all on a line where that is too little
};

/// Least squares by points (3 x N, with weights); the direction is on the side of `along`.
Feature fit_feature(FeatureKind kind, const Eigen::Matrix3Xd& points,
                    const Eigen::VectorXd& weights, const Eigen::Vector3d& along);

/// A feature as it was measured, and as it would be one standard deviation away in each of the
/// independent errors of its strokes.
struct MeasuredFeature {
  Feature value;
  struct Error {
    int id;           ///< the same error of the same stroke has the same number in all features
    bool systematic;  ///< not from the edgels
    Feature moved;
  };
  std::vector<Error> errors;
  ErrorShares shares = {};  ///< of the sizes of errors, of its worst stroke
};

/// Of the nominal part itself, by the places of its edges.
Feature nominal_feature(const Nominal& nominal, const Association& association,
                        const FeatureRef& ref);

/// `ok` is false if too little of it was measured.
MeasuredFeature measured_feature(const Nominal& nominal, const Association& association,
                                 const Sketch& measured, const SigmaModel& sigma,
                                 const FeatureRef& ref);

}  // namespace sketchsplat

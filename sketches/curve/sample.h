// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Where samples lie on the strokes: discrete, planned once per round, so that positions stay
/// smooth functions of the control points. Samples of a stroke are consecutive, in the order of the
/// strokes.
struct SampleLayout {
  std::vector<int> stroke;     ///< N  stroke of each sample
  std::vector<double> t;       ///< N  curve parameter, middles of equal pieces of arc length
  std::vector<double> length;  ///< N  arc length that the sample stands for, world units
  std::vector<int> first;      ///< S + 1  samples of stroke s are first[s] .. first[s + 1] - 1
  int size() const { return int(stroke.size()); }
};

/// At least one sample per stroke; `spacing` is the largest length of a piece, world units, > 0.
SampleLayout plan_samples(const Sketch& sketch, double spacing);

struct Samples {
  Eigen::Matrix3Xd position;  ///< 3 x N
  Eigen::Matrix3Xd tangent;   ///< 3 x N, unit; zero where the curve stands still
};
Samples evaluate_samples(const Sketch& sketch, const SampleLayout& layout);

/// Derivative of the unit tangent by arc length: towards the centre of curvature, 1 / radius long.
Eigen::Vector3d curvature_at(const Sketch& sketch, int stroke, double t);
/// The same of all samples, 3 x N.
Eigen::Matrix3Xd sample_curvatures(const Sketch& sketch, const SampleLayout& layout);

/// Derivative of a point of a curve by its control points, x y z each, in the order of StrokeKind;
/// the columns that are left over are zero.
using PointJacobian = Eigen::Matrix<double, 3, 12>;
PointJacobian point_jacobian(StrokeKind kind, const ControlPoints& controls, double t);

/// Gradient of a scalar by the control points, shaped like the sketch.
struct SketchGradient {
  Eigen::Matrix3Xd nodes;    ///< 3 x N
  Eigen::Matrix3Xd handles;  ///< 3 x M
};
/// Pulls a gradient by the samples back to nodes and handles (sum over strokes that share a node).
SketchGradient evaluate_samples_backward(const Sketch& sketch, const SampleLayout& layout,
                                         const Samples& gradient);

}  // namespace sketchsplat

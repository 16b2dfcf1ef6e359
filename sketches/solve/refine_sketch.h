// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/curve/sample.h"
#include "sketches/solve/relations.h"

namespace sketchsplat {

/// What the world wants of every sample: a move d costs d^T information d + 2 slope^T d.
struct SampleQuadratics {
  std::vector<Eigen::Matrix3d> information;  ///< symmetric, positive semidefinite
  Eigen::Matrix3Xd slope;                    ///< 3 x N, in the range of `information`
};

struct RefineSketchOptions {
  double stiffness = 1e-4;  ///< prior that holds control points, in units of the mean information
  int max_iterations = 20;
  /// Joints that turn by at most this are smooth: two cubics, or a cubic and a line, and no other
  /// stroke at their node [rad]. 0: none.
  double smooth_angle = 0;
  /// Of nodes: is the joint of an arc with an arc or a line there (find_tangent_joints) held
  /// tangent? Empty: none is.
  std::vector<char> tangent;
  double smooth_weight = 0;  ///< [cost / rad^2] that holds the tangents of such joints together
};

struct RefineSketchResult {
  Sketch sketch;
  double initial_cost = 0, final_cost = 0;  ///< of the quadratics, without the prior
};

/// Moves nodes and handles so that the samples of `layout` reach the least sum of their quadratics.
/// Strokes that share a node stay joined. What the samples do not determine (an end along its line)
/// stays where it is. `relations`, if given, add (residual / sigma)^2 each, in the units of the
/// quadratics; their shared quantities move, too.
RefineSketchResult refine_sketch(const Sketch& sketch, const SampleLayout& layout,
                                 const SampleQuadratics& quadratics,
                                 const RefineSketchOptions& options = {},
                                 Relations* relations = nullptr);

}  // namespace sketchsplat

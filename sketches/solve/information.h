// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>

#include "sketches/solve/refine_sketch.h"

namespace sketchsplat {

/// The quadratics of all samples as one quadratic of the control points, at the sketch as it is: a
/// move x of the N nodes and M handles costs x^T information x + 2 slope^T x. What no sample
/// determines is held by options.stiffness, as in refine_sketch().
struct SketchQuadratic {
  Eigen::SparseMatrix<double> information;  ///< 3 (N + M) square, positive definite
  Eigen::VectorXd slope;                    ///< 3 (N + M)
};
SketchQuadratic sketch_quadratic(const Sketch& sketch, const SampleLayout& layout,
                                 const SampleQuadratics& quadratics,
                                 const RefineSketchOptions& options = {});

}  // namespace sketchsplat

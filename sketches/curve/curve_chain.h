// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// What a CAD program takes for one curve: a stroke, or cubics that continue one another smoothly
/// where nothing else meets, as the spans of a spline do.
struct CurveChain {
  std::vector<int> strokes;    ///< in their order along the curve; of one kind
  std::vector<bool> reversed;  ///< runs a stroke from its end to its begin?
  int begin = -1, end = -1;    ///< nodes; the same one if the chain is closed, -1 as in Stroke
};

/// Turns of the tangent below which cubics count as smooth, and below which they are made so.
constexpr double kSmoothDeg = 0.01;
constexpr double kNearlySmoothDeg = 3;

/// Where two cubics, and nothing else, meet at less than `within_deg`, moves the handles beside the
/// node onto one line through it; their distances from it stay. The sum of the squares of what
/// they move is least.
void smooth_joints(Sketch* sketch, double within_deg = kNearlySmoothDeg);

/// All strokes, each in one chain, in the order of their first strokes. Strokes marked in `alone`
/// (as many as there are strokes, or none) are chains of their own.
std::vector<CurveChain> curve_chains(const Sketch& sketch, const std::vector<bool>& alone = {});

/// 3 x (3 n + 1) control points of a chain of n cubics: each third one is a joint.
Eigen::Matrix3Xd chain_points(const Sketch& sketch, const CurveChain& chain);

/// Lengths of the parameter intervals of the spans, the first is 1, for which a chain of cubics is
/// one spline of degree 3 with continuous first derivative (double knots): a joint divides the line
/// between the handles beside it as the intervals do (Farin, Curves and Surfaces for CAGD, 5th ed.,
/// 5.6).
std::vector<double> span_intervals(const Eigen::Matrix3Xd& chain_points);

/// A chain of cubics as one B-spline of degree 3: knots with multiplicities 4, 2, .., 2, 4 and 2 n
/// + 2 control points.
struct Spline {
  Eigen::Matrix3Xd points;     ///< 3 x (2 n + 2)
  std::vector<double> breaks;  ///< n + 1 distinct knots, from 0 to 1
};
Spline chain_spline(const Sketch& sketch, const CurveChain& chain);

/// Of every stroke, the index of its chain.
std::vector<int> chain_of_strokes(const std::vector<CurveChain>& chains, int strokes);

/// Nodes that are joints within a chain and no vertex of the graph.
std::vector<bool> inner_joints(const Sketch& sketch, const std::vector<CurveChain>& chains);

/// Samples every `spacing` at most, 3 x N, from begin to end of the chain.
Eigen::Matrix3Xd sample_chain(const Sketch& sketch, const CurveChain& chain, double spacing);

/// Evidence of the chain: means weighted by length; the least confidence, the largest sigma, the
/// views that see any of it; no covariance if it has several strokes.
Evidence chain_evidence(const Sketch& sketch, const CurveChain& chain);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "datasets/neighbours/kd_tree.h"
#include "edges/contrast/window.h"
#include "edges/views/match.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Openings through which views see a curve in a pocket or a hole; null: nobody knows.
using Windows = std::shared_ptr<const std::vector<Window>>;

/// A curve that may be an edge, with control points of its own.
struct Candidate {
  StrokeKind kind = StrokeKind::kLine;
  ControlPoints curve = {};
  Windows windows = nullptr;
  int group = -1;      ///< of candidates that are all there or none, as of one pocket; -1: alone
  bool floor = false;  ///< of a group: at a depth at which the pictures show most
};

/// A stroke as a candidate.
Candidate candidate_of(const Sketch& sketch, int stroke);

/// The openings of a candidate, none if nobody knows.
const std::vector<Window>& windows_of(const Candidate& candidate);

/// Points along a candidate, at most `spacing` (world units) apart, at least two.
CurvePoints candidate_points(const Candidate& candidate, double spacing);

/// Adds a candidate as a stroke of its own, with nodes of its own.
void append(const Candidate& candidate, Sketch* sketch);

/// The curve moved: along a vector, turned, mirrored.
Candidate moved(const Candidate& candidate, const Eigen::Affine3d& by);
Candidate moved(const Candidate& candidate, const Eigen::Vector3d& by);

/// In the plane across a unit normal, at a height along it.
Eigen::Affine3d mirror(const Eigen::Vector3d& normal, double height);

/// Unit normal of the plane of a circle, an ellipse or an arc of one; zero of other curves.
Eigen::Vector3d plane_normal(StrokeKind kind, const ControlPoints& controls);

/// Cosine of the angle of axes that are parallel.
inline constexpr double kParallel = 0.999;

struct Circle {
  Eigen::Vector3d centre, axis;  ///< axis: unit
  double radius = 0;             ///< world units
};

/// The full circles of a sketch.
std::vector<Circle> circles_of(const Sketch& sketch);

/// The circles without those whose axis is the line, within `tolerance`, of one before.
std::vector<Circle> distinct_axes(const std::vector<Circle>& circles, double tolerance);

Candidate candidate_of(const Circle& circle);

/// [footprints] from a stroke of what is known already; share of a candidate that makes it so, and
/// that makes one of a group known as a whole.
inline constexpr double kKnownPx = 2.5, kKnownShare = 0.4, kWholeShare = 0.9;

/// The places where strokes run.
class KnownCurves {
 public:
  /// `spacing`, `reach`: world units; the spacing is less than the reach.
  KnownCurves(const Sketch& sketch, double spacing, double reach);
  /// Share of the points that lie within reach of a stroke.
  double share(const CurvePoints& curve) const;

 private:
  double reach_;
  KdTree tree_;
};

}  // namespace sketchsplat

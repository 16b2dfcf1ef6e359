// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "datasets/neighbours/kd_tree.h"
#include "edges/contrast/window.h"
#include "edges/views/match.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// A curve that may be an edge, with control points of its own.
struct Candidate {
  StrokeKind kind = StrokeKind::kLine;
  ControlPoints curve = {};
  /// Openings through which views see it, if it is in a pocket or a hole; null: nobody knows.
  std::shared_ptr<const std::vector<Window>> windows = nullptr;
  int group = -1;      ///< of candidates that are all there or none, as of one pocket; -1: alone
  bool floor = false;  ///< of a group: at a depth at which the pictures show most
};

/// The openings of a candidate, none if nobody knows.
const std::vector<Window>& windows_of(const Candidate& candidate);

/// Points along a candidate, at most `spacing` (world units) apart, at least two.
CurvePoints candidate_points(const Candidate& candidate, double spacing);

/// Adds a candidate as a stroke of its own, with nodes of its own.
void append(const Candidate& candidate, Sketch* sketch);

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

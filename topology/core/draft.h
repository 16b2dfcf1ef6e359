// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sketches/graph/sketch.h"
#include "topology/core/plain_curve.h"
#include "topology/core/remap.h"

namespace sketchsplat {

/// A stroke while a pass works on it: its curve, its nodes and what became of it.
struct Piece {
  PlainCurve curve;
  int begin = -1, end = -1;  ///< nodes of the draft; -1 if closed
  Evidence evidence;
  CurveSamples samples;     ///< of `curve`, kept up to date by Draft
  Eigen::Matrix3Xd points;  ///< where the images put it, in no order
  bool alive = true;
  int into = -1;  ///< if dead: the piece that it was merged into, or -1 if removed

  double trust() const;  ///< opacity, but never zero
  /// How well supported it is: length times opacity, world units; positive for every sound curve.
  double support() const;
};

/// A sketch that a pass may edit: curves by value, so that strokes come and go freely.
/// Unsound strokes (NaN, zero length) are removed at once and count as changes.
struct Draft {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<Piece> pieces;
  int changes = 0;

  /// `points`: one entry per stroke, or none.
  explicit Draft(const Sketch& sketch, const StrokePoints& points);
  PassResult finish() const;

  int size() const { return int(pieces.size()); }
  void remove(int piece);
  /// Gives a piece another curve and other end nodes; removes it if the curve is unsound.
  /// The nodes move to the ends of an open curve.
  void replace(int piece, const PlainCurve& curve, int begin, int end);
  /// Number of ends of living pieces at each node.
  std::vector<int> degrees() const;
};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

namespace sketchsplat {

/// A solid held against the true one. Lengths and volumes in the units of the files' shapes: a
/// millimetre is 1.
struct SolidComparison {
  bool valid = false;  ///< OpenCASCADE finds the solid closed and without faults
  double volume = 0, true_volume = 0;
  double iou = 0;  ///< of the volumes
  /// By a boolean operation, to about 1e-6; else, where that fails, by lines through both, to 1e-3.
  bool iou_is_exact = false;
  int faces = 0, true_faces = 0;
  /// Shares of faces, in [0, 1], of which nine tenths of the area lie within five thousandths of
  /// the true part's longest side of the other's faces on the same kind of surface.
  double face_precision = 0, face_recall = 0, face_f = 0;
  /// Largest distance of a place on the faces of the one from those of the other. To about 1e-4 of
  /// the longest side.
  double to_truth = 0, from_truth = 0;
  double largest_distance = 0;  ///< the larger of both
};

}  // namespace sketchsplat

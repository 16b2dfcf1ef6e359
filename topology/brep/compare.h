// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sketchsplat {

/// A solid held against the true one. Lengths in the files' units, as millimetres.
struct SolidComparison {
  double volume = 0, true_volume = 0;
  double iou = 0;  ///< of the volumes, by 30,000 places spread evenly over both: to about 1e-3
  /// Faces of which nine tenths lie within five thousandths of the true part's longest side of true
  /// faces of their kind of surface; and the other way round.
  double face_precision = 0, face_recall = 0, face_f = 0;
  double largest_distance = 0;  ///< of places on the faces of either from those of the other
};

/// Compares two STEP files that hold a solid each. Throws InputError.
SolidComparison compare_solids(const std::string& path, const std::string& true_path);

}  // namespace sketchsplat

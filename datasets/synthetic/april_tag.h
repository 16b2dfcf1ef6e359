// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/image.h"

namespace sketchsplat {

/// An AprilTag as it is printed: one value per cell, 1 is white, a white border around.
struct TagBitmap {
  Image<float> cells;
  int border = 1;  ///< cells between the edge of the bitmap and the black square
};

/// Of the family 36h11 of libapriltag. Precondition: 0 <= id < tag36h11_count().
TagBitmap tag36h11(int id);
int tag36h11_count();

}  // namespace sketchsplat

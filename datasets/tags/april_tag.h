// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/types/image.h"

namespace sketchsplat {

/// An AprilTag as it is printed: one value per cell, 1 is white, a white border around.
struct TagBitmap {
  Image<float> cells;
  int border = 1;  ///< cells between the edge of the bitmap and the black square
};

/// Of the family 36h11 of libapriltag. Precondition: 0 <= id < tag36h11_count().
TagBitmap tag36h11(int id);
int tag36h11_count();

/// A tag in a picture.
struct TagSighting {
  int id = 0;
  /// [px] corners of its black square, to about half a pixel: top left, top right, bottom right and
  /// bottom left of the bitmap.
  Eigen::Matrix<double, 2, 4> corners;
};

/// The tags of the family 36h11 in a grey image with values in [0, 1], ascending by id. One that is
/// there more than once is left out: nobody knows which is which.
std::vector<TagSighting> find_tags(const Image<float>& grey);

}  // namespace sketchsplat

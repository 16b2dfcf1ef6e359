// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/types/image.h"
#include "datasets/types/view.h"
#include "edges/image/detect.h"

namespace sketchsplat {

/// Edgels that were found in the pixels of the image, where the view's ideal pinhole sees them:
/// positions through the lens, normals n by its transposed Jacobian J (d image / d ideal, at the
/// edgel), strength times |J^T n| and width divided by it, for an image without the lens would have
/// steeper edges where it is drawn smaller. Edgels that the lens draws at no more than a quarter of
/// the ideal size, or that no ideal pixel is drawn at, are dropped as append_runs does; the look-up
/// is built anew. Noise and mask stay those of the image. Without distortion nothing changes.
EdgelMap undistort_edgels(EdgelMap found, const View& view, int min_chain);

/// The other way round, to draw edgels over the image; without a look-up.
EdgelMap distort_edgels(EdgelMap ideal, const View& view);

/// The picture as the ideal pinhole would have taken it, for those who need whole images; bilinear,
/// colours weighed by alpha. What the image does not show is black, and outside of the mask if
/// there is one. Without distortion nothing changes.
Picture undistort_picture(Picture picture, const View& view);

}  // namespace sketchsplat

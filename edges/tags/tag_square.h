// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "datasets/tags/april_tag.h"
#include "datasets/types/view.h"
#include "edges/image/detect.h"

namespace sketchsplat {

/// What is needed of a picture to measure a tag in it.
struct TagPatch {
  int view = 0;
  TagSighting tag;     ///< corners in pixels of the image
  int x0 = 0, y0 = 0;  ///< [px] of the image, where the patch begins
  Image<float> light;  ///< linear, as the sensor saw it: on gamma's curve black shrinks
};

/// The tags of a picture; `view` is copied. Alpha is not looked at.
std::vector<TagPatch> tag_patches(const Picture& picture, int view);

/// The black square of a tag in the world.
struct TagSquare {
  int id = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  /// Columns: to the right and downwards on the printed tag, and into it.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double side = 0;   ///< world units, > 0
  double sigma = 0;  ///< standard deviation of it, world units
  int views = 0;     ///< it was measured in
  double rms_px = 0; ///< [px] scatter of its edges, after what each view has in common

  /// A place in sides from the centre, to the right and down: corners at (+-0.5, +-0.5).
  Eigen::Vector3d at(double right, double down) const {
    return centre + side * (axes.col(0) * right + axes.col(1) * down);
  }
};

/// The square of one tag from its sightings: where black borders white all over it is measured
/// across the edges to a few hundredths of a pixel, and pose and side are least squares of that
/// over all views, with a robust weight. A view may see all black broader or narrower (blur, ink,
/// exposure): one number for each, which inner edges, that go both ways, part from the side. The
/// sigma is that of the scatter between views (sandwich estimator, a view is a cluster: MacKinnon &
/// White, J. Econometrics 1985), and at least what is left of pixels. None if fewer than three
/// views agree, or if the tag is too small in them to be measured.
std::optional<TagSquare> fit_tag(const std::vector<View>& views,
                                 const std::vector<const TagPatch*>& patches);

/// Of every id, ascending; those that cannot be measured are left out.
std::vector<TagSquare> fit_tags(const std::vector<View>& views,
                                const std::vector<TagPatch>& patches);

/// The side that all these tags have, if they are copies of one size, and its sigma: their mean
/// with weights, and no surer than they agree. Precondition: there is one.
struct TagSide {
  double side = 0, sigma = 0;  ///< world units
};
TagSide common_side(const std::vector<TagSquare>& tags);

/// The edgels that do not lie on one of the tags, their white borders included, as the view sees
/// them; in front of the camera or not, as if nothing hid them.
EdgelMap without_tags(const EdgelMap& map, const View& view, const std::vector<TagSquare>& tags);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/readers/scene.h"
#include "datasets/types/view.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {

/// The view, in the frame where `to` puts what it saw.
View moved(View view, const Similarity& to);

/// Cameras and what they show can be moved, turned and grown together without any edgel noticing
/// (the gauge of bundle adjustment). This is the similarity after which poses as stated, in the
/// same order, are likeliest, of cameras that see `middle` of the object at a depth > 0.
/// `radius_px`: of its image in each view.
///
/// Stated poses err by turns, and by shifts of the object in the image that follow them: wholly if
/// cameras turned about themselves, not at all where poses were fitted to images of the object. How
/// far, and how much turns and shifts across and along the line of sight scatter, is told by the
/// views themselves; with Student's distribution, as some views say little of their turn (Lange et
/// al.: Robust statistical modeling using the t distribution, JASA 1989). Fewer than six views tell
/// too little: nothing moves.
Similarity likeliest_gauge(const std::vector<View>& found, const std::vector<View>& stated,
                           const Eigen::Vector3d& middle, const std::vector<double>& radius_px);

/// The similarity that brings the points of structure from motion, placed anew by the found
/// cameras, to where they are stated: cameras and what they share err together, and what a wrong
/// focal length moves is the cameras, not the points. As much as their sights (which index `found`)
/// tell of each and with Student's distribution; fewer than twenty tell too little: nothing moves.
Similarity gauge_of_points(const std::vector<View>& found, const std::vector<ScenePoint>& points);

}  // namespace sketchsplat

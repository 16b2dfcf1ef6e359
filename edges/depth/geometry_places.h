// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "datasets/types/geometry_maps.h"
#include "edges/depth/geometry_sides.h"

namespace sketchsplat {

// Where edges may be in the maps of a view: ridges of the gradients of alpha, depth and normals.

/// A gradient whose sign may mean nothing: magnitude and unit direction by pixel.
struct Slopes {
  cv::Mat1f magnitude, x, y;
};
Slopes slopes_of(const cv::Mat1f& gx, const cv::Mat1f& gy);

double focal(const Camera& camera);  ///< [px] geometric mean of both

/// The pixels that matter: the object and as much around it as filters and sides reach; empty if
/// there is none.
cv::Rect object_box(const GeometryMaps& maps);
GeometryMaps cut_maps(const GeometryMaps& maps, const cv::Rect& box);

/// The maps ready for filters, but for `activity`.
GeometryFields make_fields(const GeometryMaps& maps, const Camera& camera);

/// Gradient of depth [pixel footprints per px] beyond what the normals explain; `sigma`: smoothing
/// [px].
Slopes depth_slopes(const GeometryFields& fields, double sigma);

/// Gradient of the normal [rad per px]: larger eigenvalue of the structure tensor and its direction
/// (Di Zenzo, CVGIP 1986).
Slopes normal_slopes(const GeometryFields& fields, double sigma);

/// Gradient [per px] of a unit step that is smeared by 1.3 px.
constexpr double kPeak = 0.3;

/// Fills the activity: gradients over those of the weakest edge, a step of `jump_px` [pixel
/// footprints] or a turn of `crease` [rad].
void measure_activity(const Slopes& depth, const Slopes& normal, double jump_px, double crease,
                      GeometryFields* fields);

/// Local maxima across the gradient, of magnitude `low` or more, to a fraction of a pixel.
std::vector<Place> find_places(const Slopes& slopes, double low);

}  // namespace sketchsplat

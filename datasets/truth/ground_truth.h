// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sketchsplat {

/// The true edges of a scene, in its world frame.
struct GroundTruth {
  struct Curve {
    std::string type;           ///< lower case: "line", "circle", "ellipse", "bspline", ...
    Eigen::Matrix3Xd polyline;  ///< 3 x N points on the curve in order; closed: first = last
    bool sharp = true;          ///< only these count as edges
    bool closed = false;
    /// How many views see each point (as many as the polyline has); empty if the file does not say.
    std::vector<int> visible_views = {};
  };
  std::string path;           ///< file that the curves (or, without curves, the samples) are from
  std::string format;         ///< "abc", "curves", "samples" or "sketch"
  std::vector<Curve> curves;  ///< empty if only samples are published
  /// 3 x N points by the published protocol: from the published file if there is one, otherwise
  /// taken every 0.005 in the CAD file's own units. Empty if the truth has no such units.
  Eigen::Matrix3Xd samples;
  bool samples_published = false;  ///< `samples` is the content of a *_0.005.ply
  double raw_scale = 0;            ///< world units per unit of the CAD file; 0 if there is none
  /// World length of the object's longest side: what the thousandths of the metrics are of.
  /// Without the object's box: the longest side of the box of the curves; but 1 where that is
  /// between 0.9 and 1.1, or where the curves lie in the unit cube and fill half of it: then the
  /// object fills the cube, as published scenes do, and its edges not quite.
  double extent = 1;
  Eigen::Vector3d center = Eigen::Vector3d::Constant(0.5);  ///< of that box, world
};

/// Finds and reads what `path` holds or is:
///   - `*_features_*.yml` of ABC, with `*.obj`, `chunk_*_stats.json` and `ID_0.005.ply` looked for
///     beside it, in ../obj, ../sampled_pts and the folders above; without an OBJ the vertices of
///     lines and circles come from their parameters;
///   - a folder with such a file, flat or as feat/ + obj/ + sampled_pts/;
///   - JSON with curves as points: a list of {type, points, closed}, or {scale, offset, curves:
///     [{type, points_mm}]} where world = points_mm * scale + offset; or a sketch graph. A curve
///     may have visible_views, a number a point;
///   - `*.ply`: samples;
///   - a scene folder with one of these in gt/ or groundtruth/ or as `*gt*.json`, or below
///     groundtruth/ of a folder above, called like the scene; `worldtogt` of its meta_data.json
///     is undone.
/// Throws InputError (nothing there, broken, no sharp curve).
GroundTruth find_ground_truth(const std::string& path);

/// Would find_ground_truth() find a file there (broken or not)?
bool has_ground_truth(const std::string& path);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/io/image_io.h"
#include "datasets/types/triangulate.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// A point that structure from motion found.
struct ScenePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::vector<PointSight> sights;  ///< by view, ascending; one a view
};

/// A folder of calibrated images, whatever its format.
struct Scene {
  std::string folder;
  std::string format;              ///< "abc-nef", "nerf", ...
  std::vector<View> views;         ///< frames that can be used, in the order of the scene file
  std::vector<ScenePoint> points;  ///< empty if the format has none, or the file is missing
  Eigen::Matrix4d gt_from_world = Eigen::Matrix4d::Identity();  ///< `worldtogt` of EMAP's layout
  std::vector<std::string> warnings;  ///< one line per frame that was left out, and why
};

/// Opens a scene folder. `format` is one of scene_formats() or empty: then the first whose marker
/// file is there. Frames without a file, with a pose that is not a rotation (|R^T R - I| > 1e-3 or
/// det < 0) or intrinsics that are not a camera are left out with a warning; small departures from
/// a rotation are projected to the nearest one. Image contents are not looked at here.
/// Throws InputError (no such folder, no marker, broken JSON, missing keys, no usable frame).
Scene open_scene(const std::string& folder, const std::string& format = "");

/// Whether open_scene would find the marker of that format, or of any if it is empty.
bool is_scene_folder(const std::string& folder, const std::string& format = "");

/// Names that open_scene accepts as `format`, in the order in which it looks for them.
std::vector<std::string> scene_formats();

/// Masks from another folder for the views of a scene, before alpha and the scene's own: the mask
/// of DIR/images/sub/a.jpg is the first of sub/a.jpg, sub/a.jpg.png, sub/a.png in `folder`, longer
/// paths first. Views without one keep what they have; a warning counts them. Throws InputError if
/// no view has one.
void use_masks(const std::string& folder, Scene* scene);

/// The picture of a view, with its mask as alpha, as stored: soft values stay soft. Throws
/// InputError if it cannot be read, if its size, or its mask's, is not the camera's, or if the mask
/// holds nothing white. `denominator`: see read_picture(path).
Picture read_picture(const View& view, int denominator = 1);

/// Somebody's edge map of a view: edge_<detector>/<image name> in the scene's folder, upper and
/// lower case of the detector alike; in NEF's layout, train/<image name> is PiDiNet's. Empty if
/// there is none.
std::string edge_map_path(const Scene& scene, const View& view, const std::string& detector);

}  // namespace sketchsplat

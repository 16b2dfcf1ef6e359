// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/readers/format.h"
#include "sketches/io/json.h"

namespace sketchsplat {

/// What a scene file says about one image, before it is checked.
struct Frame {
  std::string name;         ///< as the scene file calls the image, with folders
  std::string image_path;   ///< empty if no such file was found
  bool is_outside = false;  ///< the image lies where the scene may not reach: not looked for
  ImageSize size;           ///< [px]; 0 x 0: ask the image
  Eigen::Matrix3d intrinsics = Eigen::Matrix3d::Identity();      ///< pixel centres are integers
  Eigen::Matrix4d world_from_cam = Eigen::Matrix4d::Identity();  ///< axes of Camera
  Lens lens;
  std::string mask_path;  ///< empty if there is none
};

/// Asks the header of the image for a size that is not known. Returns false if it has none.
bool complete_size(Frame* frame);

/// Appends the view of a frame to the scene, or a warning that names the frame and says what is
/// wrong with it. Returns whether there is a view.
bool add_frame(const Frame& frame, Scene* scene);

/// Frames of a scene beyond which nobody means it.
constexpr size_t kMostFrames = 20000;
/// Throws InputError if a file claims more than kMostFrames.
void check_frame_count(const std::string& path, std::uint64_t count);
/// Elements of the array `frames`. Throws InputError.
std::vector<JsonValue> frames_of(const JsonValue& root);

/// Whether a scene may reach for the file: it lies in the scene's folder by its name alone (links
/// in the folder may lead anywhere), or the user allows what lies outside.
bool may_reach(const SceneSource& source, const std::string& path);

/// The image of the frame: folder/name, see find_image, unless that lies outside of the scene.
void find_image_of(const SceneSource& source, const std::string& folder, const std::string& name,
                   Frame* frame);

/// First of folder/name, then folder/name with the usual extensions, that is a file; empty if none.
std::string find_image(const std::string& folder, const std::string& name);

/// First of folder/name, folder/name.png, folder/name with .png for its extension that is a file;
/// empty if none.
std::string find_mask(const std::string& folder, const std::string& name);

/// Names of the files below a folder that look like images, relative to it, sorted; the folder
/// itself alone unless `deep`.
std::vector<std::string> list_images(const std::string& folder, bool deep);

/// "images without a pose: 5 (a.jpg, b.jpg, c.jpg, ...)" into the warnings of the scene; nothing if
/// there are no names.
void warn_of(const std::string& what, const std::vector<std::string>& names, Scene* scene);

}  // namespace sketchsplat

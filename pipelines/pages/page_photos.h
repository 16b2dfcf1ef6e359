// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "datasets/readers/scene.h"

namespace sketchsplat {

/// A view as a page shows it.
struct PagePhoto {
  View view;
  std::string jpeg;  ///< bytes of the file: the picture on white, reduced
};

/// Bytes that the photographs of a page may take in all: base64 makes a third more of them.
constexpr size_t kMostPhotoBytes = 1'500'000;

/// The pictures of at most 100 views of a scene, spread over the directions to a point, so small
/// that all of them fit into a page: copies of what others read while they work, so that no picture
/// has to be read again for it.
class PhotoAlbum {
 public:
  /// `target`: about where the cameras look, world units.
  PhotoAlbum(const Scene& scene, const Eigen::Vector3d& target);

  /// The scene, of whose pictures the album gets its copies when somebody reads them.
  Scene watched() const;

  /// In the order of the scene. `views`: those of the scene, or some of them in its order, as their
  /// cameras are known by now; others are left out. What nobody has read is read now; what cannot
  /// be read is left out: whoever looked for edges in it has said so.
  std::vector<PagePhoto> photos(const std::vector<View>& views) const;

 private:
  struct Copies;
  Scene scene_;
  std::vector<int> chosen_;  // of the scene's views
  std::shared_ptr<Copies> copies_;
};

}  // namespace sketchsplat

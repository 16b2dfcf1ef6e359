// SPDX-License-Identifier: MIT
#pragma once

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

/// The pictures of at most 100 views, spread over the directions to `target` (world) and in the
/// order of the scene, so small that all of them fit into a page. What cannot be read is left out:
/// whoever looked for edges in it has said so.
std::vector<PagePhoto> page_photos(const Scene& scene, const Eigen::Vector3d& target);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// A small scene of COLMAP: three images, two cameras, two points.
#pragma once

#include <cmath>

#include "datasets/readers/scene.h"
#include "tests/datasets/temp_folder.h"
#include "tests/support/colmap_files.h"

namespace sketchsplat::test {

inline void write_image(const TempFolder& folder, const std::string& name, int width = 16) {
  write_png(folder.file(name), Image<float>(width, 12, 0.2f));
}

// Turned by 90 degrees about x: world y is the camera's z. The camera's centre is (1, -5, 2).
inline ColmapFiles small_model() {
  ColmapFiles m;
  m.cameras = {{7, "OPENCV", 4, 16, 12, {20, 21, 8.25, 6.5, -0.1, 0.02, 0.001, -0.002}},
               {3, "SIMPLE_PINHOLE", 0, 16, 12, {25, 8, 6}}};
  const double half = std::sqrt(0.5);
  m.images = {{12, {half, half, 0, 0}, {-1, 2, 5}, 7, "sub/two words.png", {{3, 4}, {5, 6}}},
              {4, {2, 0, 0, 0}, {0, 0, 3}, 3, "b.png", {}},
              {5, {1, 0, 0, 0}, {0, 0, 4}, 3, "c.png", {{1, 1}}}};
  m.points = {{1, {1, 2, 3}, {12, 4, 12}}, {9, {0.5, 0, 0}, {5}}};
  return m;
}

inline void write_images(const TempFolder& folder) {
  for (const char* name : {"sub/two words.png", "b.png", "c.png"})
    write_image(folder, std::string("images/") + name);
}

}  // namespace sketchsplat::test

// SPDX-License-Identifier: MIT
#include "datasets/synthetic/april_tag.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <memory>

namespace sketchsplat {
namespace {

using Family = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;
Family family() { return {tag36h11_create(), tag36h11_destroy}; }

}  // namespace

TagBitmap tag36h11(int id) {
  const Family tags = family();
  const std::unique_ptr<image_u8_t, void (*)(image_u8_t*)> drawn(apriltag_to_image(tags.get(), id),
                                                                 image_u8_destroy);
  TagBitmap out{Image<float>(drawn->width, drawn->height),
                (tags->total_width - tags->width_at_border) / 2};
  for (int y = 0; y < drawn->height; ++y)
    for (int x = 0; x < drawn->width; ++x)
      out.cells.at(x, y) = drawn->buf[y * drawn->stride + x] > 127 ? 1.0f : 0.0f;
  return out;
}

int tag36h11_count() { return int(family()->ncodes); }

}  // namespace sketchsplat

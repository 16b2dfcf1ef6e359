// SPDX-License-Identifier: MIT
#include "datasets/tags/april_tag.h"

#include <apriltag/apriltag.h>
#include <apriltag/common/homography.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <memory>

namespace sketchsplat {
namespace {

constexpr double kLargeImage = 3e6;  // [px] beyond, squares are looked for at half the size
constexpr int kWrongBits = 1;        // of a tag that is believed

using Family = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;
Family family() { return {tag36h11_create(), tag36h11_destroy}; }

using GreyBytes = std::unique_ptr<image_u8_t, void (*)(image_u8_t*)>;
GreyBytes bytes_of(const Image<float>& grey) {
  GreyBytes out(image_u8_create(unsigned(grey.width), unsigned(grey.height)), image_u8_destroy);
  for (int y = 0; y < grey.height; ++y)
    for (int x = 0; x < grey.width; ++x)
      out->buf[y * out->stride + x] =
          uint8_t(std::clamp(255 * grey.at(x, y), 0.0f, 255.0f) + 0.5f);
  return out;
}

TagSighting sighting(const apriltag_detection_t& found) {
  TagSighting out;
  out.id = found.id;
  constexpr double kCorner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int k = 0; k < 4; ++k) {
    double x, y;
    homography_project(found.H, kCorner[k][0], kCorner[k][1], &x, &y);
    out.corners.col(k) << x - 0.5, y - 0.5;  // the library's pixels begin at 0
  }
  return out;
}

}  // namespace

TagBitmap tag36h11(int id) {
  const Family tags = family();
  const GreyBytes drawn(apriltag_to_image(tags.get(), id), image_u8_destroy);
  TagBitmap out{Image<float>(drawn->width, drawn->height),
                (tags->total_width - tags->width_at_border) / 2};
  for (int y = 0; y < drawn->height; ++y)
    for (int x = 0; x < drawn->width; ++x)
      out.cells.at(x, y) = drawn->buf[y * drawn->stride + x] > 127 ? 1.0f : 0.0f;
  return out;
}

int tag36h11_count() { return int(family()->ncodes); }

std::vector<TagSighting> find_tags(const Image<float>& grey) {
  if (grey.empty()) return {};
  const Family tags = family();
  const std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector(
      apriltag_detector_create(), apriltag_detector_destroy);
  apriltag_detector_add_family_bits(detector.get(), tags.get(), kWrongBits);
  detector->nthreads = 1;  // callers look at many images at a time
  detector->quad_decimate = double(grey.width) * grey.height > kLargeImage ? 2.0f : 1.0f;
  const GreyBytes bytes = bytes_of(grey);
  zarray_t* found = apriltag_detector_detect(detector.get(), bytes.get());
  std::vector<TagSighting> all, once;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* one;
    zarray_get(found, i, &one);
    all.push_back(sighting(*one));
  }
  apriltag_detections_destroy(found);
  for (const TagSighting& s : all)
    if (std::count_if(all.begin(), all.end(),
                      [&](const TagSighting& other) { return other.id == s.id; }) == 1)
      once.push_back(s);
  std::sort(once.begin(), once.end(),
            [](const TagSighting& a, const TagSighting& b) { return a.id < b.id; });
  return once;
}

}  // namespace sketchsplat

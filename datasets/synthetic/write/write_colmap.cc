// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write/write_colmap.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "datasets/readers/colmap_write.h"
#include "datasets/synthetic/write/write_truth.h"

namespace sketchsplat {
namespace {

constexpr double kCorner = 0.5;  // COLMAP counts pixels from the corner of the first one

template <typename... Values>
std::string printed(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// POINTS2D of each image.
std::vector<std::string> sights_of(const std::vector<View>& views,
                                   const std::vector<TiePoint>& points) {
  std::vector<std::string> sights(views.size());
  for (size_t i = 0; i < points.size(); ++i)
    for (const PointSight& sight : points[i].sights) {
      std::string& line = sights[sight.view];
      line += printed("%s%.3f %.3f %zu", line.empty() ? "" : " ", sight.pixel.x() + kCorner,
                      sight.pixel.y() + kCorner, i + 1);
    }
  return sights;
}

std::string points_text(const std::vector<View>& views, const std::vector<TiePoint>& points) {
  std::vector<int> used(views.size(), 0);  // POINTS2D of each image so far
  std::string text;
  for (size_t i = 0; i < points.size(); ++i) {
    const TiePoint& point = points[i];
    int rgb[3];
    for (int c = 0; c < 3; ++c)
      rgb[c] = int(255 * std::pow(std::clamp(point.color[c], 0.0f, 1.0f), 1 / 2.2f) + 0.5f);
    text += printed("%zu %.12g %.12g %.12g %d %d %d %.4f", i + 1, point.point.x(), point.point.y(),
                    point.point.z(), rgb[0], rgb[1], rgb[2], reprojection_error(point, views));
    for (const PointSight& sight : point.sights)
      text += printed(" %d %d", sight.view + 1, used[sight.view]++);
    text += "\n";
  }
  return text;
}

}  // namespace

void write_colmap(const std::vector<View>& views, const std::vector<TiePoint>& points,
                  const std::string& folder) {
  const ColmapText model = colmap_text(views, sights_of(views, points));
  write_whole(folder + "/cameras.txt", model.cameras);
  write_whole(folder + "/points3D.txt", model.points + points_text(views, points));
  write_whole(folder + "/images.txt", model.images);
}

}  // namespace sketchsplat

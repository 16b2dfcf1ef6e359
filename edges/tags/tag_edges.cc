// SPDX-License-Identifier: MIT
#include "edges/tags/tag_edges.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

constexpr double kAlongCell[] = {0.32, 0.5, 0.68};  // away from corners, which blur rounds
constexpr double kMargin = 0.2;                     // of the tag's box around it, and pixels:
constexpr int kMarginPx = 8;
constexpr double kStep = 0.25;    // [px] of a profile
constexpr int kCentrings = 4;     // of the window on the edge
constexpr double kNarrow = 0.45;  // of a window: the second one
constexpr double kFar = 2;        // [px] from where the edge is expected: it is another one

// IEC 61966-2-1.
float linear(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

bool sample(const TagPatch& patch, const Eigen::Vector2d& pixel, double* value) {
  const double x = pixel.x() - patch.x0, y = pixel.y() - patch.y0;
  const Image<float>& p = patch.light;
  if (!(x >= 0 && y >= 0 && x < p.width - 1 && y < p.height - 1)) return false;
  const int i = int(x), j = int(y);
  const double u = x - i, v = y - j;
  *value = (1 - v) * ((1 - u) * p.at(i, j) + u * p.at(i + 1, j)) +
           v * ((1 - u) * p.at(i, j + 1) + u * p.at(i + 1, j + 1));
  return true;
}

// The middle of the rise in a window of `half` steps to either side, which follows it so that it
// cuts off as much on either side.
bool middle_of_rise(const TagPatch& patch, const Eigen::Vector2d& pixel,
                    const Eigen::Vector2d& normal, int half, double least_rise, double* middle) {
  const double half_width = half * kStep;
  for (int round = 0; round < kCentrings; ++round) {
    double rise = 0, moment = 0, before = 0, first = 0;
    for (int k = -half; k <= half; ++k) {
      double value;
      if (!sample(patch, pixel + (*middle + k * kStep) * normal, &value)) return false;
      if (k == -half)
        first = value;
      else
        moment += (value - before) * (k - 0.5) * kStep;
      before = value;
    }
    rise = before - first;
    if (!(rise > least_rise)) return false;
    const double step = moment / rise;
    *middle += std::clamp(step, -0.5 * half_width, 0.5 * half_width);
    if (!(std::abs(*middle) < kFar)) return false;
  }
  return true;
}

}  // namespace

std::vector<TagPatch> tag_patches(const Picture& picture, int view) {
  const int w = picture.width(), h = picture.height();
  Image<float> grey(w, h);
  for (size_t i = 0; i < grey.data.size(); ++i)
    grey.data[i] = (picture.red.data[i] + picture.green.data[i] + picture.blue.data[i]) / 3;
  std::vector<TagPatch> out;
  for (const TagSighting& tag : find_tags(grey)) {
    const Eigen::Vector2d low = tag.corners.rowwise().minCoeff(),
                          high = tag.corners.rowwise().maxCoeff();
    const double margin = kMargin * (high - low).maxCoeff() + kMarginPx;
    const int x0 = std::max(0, int(low.x() - margin)), y0 = std::max(0, int(low.y() - margin));
    const int x1 = std::min(w, int(high.x() + margin) + 1),
              y1 = std::min(h, int(high.y() + margin) + 1);
    if (x1 - x0 < 2 || y1 - y0 < 2) continue;
    TagPatch patch = {view, tag, x0, y0, Image<float>(x1 - x0, y1 - y0)};
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        patch.light.at(x - x0, y - y0) =
            (linear(picture.red.at(x, y)) + linear(picture.green.at(x, y)) +
             linear(picture.blue.at(x, y))) /
            3;
    out.push_back(std::move(patch));
  }
  return out;
}

std::vector<TagEdge> tag_edges(int id) {
  const TagBitmap bitmap = tag36h11(id);
  const Image<float>& cells = bitmap.cells;
  const double cell = 1.0 / (cells.width - 2 * bitmap.border);
  const Eigen::Vector2d first = Eigen::Vector2d::Constant(-0.5 - bitmap.border * cell);
  std::vector<TagEdge> edges;
  for (int y = 0; y < cells.height; ++y)
    for (int x = 0; x < cells.width; ++x)
      for (int down = 0; down < 2; ++down) {
        const int nx = x + 1 - down, ny = y + down;  // the neighbour to the right, or below
        if (nx >= cells.width || ny >= cells.height || cells.at(x, y) == cells.at(nx, ny)) continue;
        const Eigen::Vector2d across = down ? Eigen::Vector2d(0, 1) : Eigen::Vector2d(1, 0);
        const Eigen::Vector2d along(across.y(), across.x());
        const Eigen::Vector2d corner = first + cell * (Eigen::Vector2d(x, y) + across);
        for (const double share : kAlongCell)
          edges.push_back({corner + share * cell * along, along,
                           cells.at(nx, ny) > cells.at(x, y) ? across : Eigen::Vector2d(-across)});
      }
  return edges;
}

// Where light falls off across the border, as in half-shadows, the middle is off by half the
// relative slope times the half-width squared; two windows tell the border itself.
bool edge_offset(const TagPatch& patch, const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal,
                 double half_width, double least_rise, double* offset) {
  const int wide = std::max(2, int(half_width / kStep));
  const int narrow = std::max(1, int(std::lround(kNarrow * wide)));
  double far = 0;
  if (!middle_of_rise(patch, pixel, normal, wide, least_rise, &far)) return false;
  double near = far;
  if (!middle_of_rise(patch, pixel, normal, narrow, 0.5 * least_rise, &near)) return false;
  *offset = near + (near - far) * (narrow * narrow) / double(wide * wide - narrow * narrow);
  return true;
}

}  // namespace sketchsplat

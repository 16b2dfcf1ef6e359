// SPDX-License-Identifier: MIT
#include "edges/views/outlines.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

constexpr double kOwnPx = 2;            // about an edgel, where odds show the same edge
constexpr double kSmoothPx = 1.5;       // over how much of the odds what lies around is told
constexpr double kAround = 0.3;         // in odds, below which it is: -1.2 nat
constexpr double kMarginPx = 2;         // [px] of a silhouette beyond what may be the object
constexpr double kSameDirection = 0.9;  // cosine

// The pieces of `all` that have pixels of `some`.
cv::Mat1b connected_to(const cv::Mat1b& some, const cv::Mat1b& all) {
  cv::Mat1i label;
  const int n = cv::connectedComponents(all, label, 4, CV_32S);
  std::vector<uchar> has(size_t(n), 0);
  for (int y = 0; y < all.rows; ++y)
    for (int x = 0; x < all.cols; ++x)
      if (some(y, x)) has[size_t(label(y, x))] = 255;
  cv::Mat1b out(all.size());
  std::transform(label.begin(), label.end(), out.begin(), [&](int l) { return has[size_t(l)]; });
  return out;
}

}  // namespace

Image<Side> sides_of(const Image<uint8_t>& mask, double slack_px) {
  const cv::Mat1b inside = mat_of(mask);
  const cv::Mat1f depth = distance_to_zero(inside), away = distance_to_zero(inside == 0);
  const cv::Rect box = cv::boundingRect(inside);
  const double around = kAroundObject * std::max(box.width, box.height);
  Image<Side> out(mask.width, mask.height, Side::kUnknown);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      if (depth(y, x) > slack_px) out.at(x, y) = Side::kObject;
      if (away(y, x) > 0 && away(y, x) <= around) out.at(x, y) = Side::kAround;
    }
  return out;
}

void trim_silhouette(const Picture& odds, Image<uint8_t>* mask, double* slack_px) {
  cv::Mat1b inside = mat_of(*mask);
  cv::Mat1f smooth;
  cv::GaussianBlur(mat_of(odds.red), smooth, cv::Size(), kSmoothPx, kSmoothPx);
  const cv::Mat1f depth = distance_to_zero(inside);
  const cv::Mat1b outside = inside == 0, end = ~outside & (depth <= *slack_px + 1);
  const cv::Mat1b trimmed = connected_to(outside, outside | (end & (smooth < kAround)));
  inside &= distance_to_zero(trimmed) <= kMarginPx;
  *slack_px = std::min(*slack_px, 2 * kMarginPx);
}

void add_outlines(const EdgelMap& odds, const View& view, const Image<uint8_t>& mask,
                  double slack_px, int min_chain, EdgelMap* map) {
  const cv::Mat1f depth = distance_to_zero(mat_of(mask));
  build_lookup(map);
  std::vector<char> keep(odds.edgels.size());
  for (size_t i = 0; i < keep.size(); ++i) {
    const Edgel& e = odds.edgels[i];
    Eigen::Vector2d pixel;
    if (!view.image_pixel({e.x, e.y}, &pixel)) continue;
    const int x = int(std::lround(pixel.x())), y = int(std::lround(pixel.y()));
    if (x < 0 || y < 0 || x >= mask.width || y >= mask.height) continue;
    if (depth(y, x) <= 0 || depth(y, x) > slack_px) continue;
    const int k = map->nearest_at(e.x, e.y);
    keep[i] = true;
    if (k < 0) continue;
    const Edgel& near = map->edgels[k];
    const double cosine = std::abs(near.nx * e.nx + near.ny * e.ny);
    if (std::hypot(near.x - e.x, near.y - e.y) <= kOwnPx && cosine >= kSameDirection)
      keep[i] = false;
  }
  append_runs(odds, keep, min_chain, map);
}

}  // namespace sketchsplat

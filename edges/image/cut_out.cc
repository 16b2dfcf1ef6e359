// SPDX-License-Identifier: MIT
#include "edges/image/cut_out.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace sketchsplat {
namespace {

constexpr double kSurroundings = 0.2;  // of the longest side of where the object may be
constexpr int kLeastSurroundings = 8;  // [px]
constexpr int kFewestPixels = 64;      // of either kind: colours of fewer tell nothing
constexpr uint8_t kLikely = 2;

cv::Mat3b colours(const Picture& picture, const cv::Rect& part) {
  cv::Mat3b out(part.size());
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) {
      const auto level = [&](const Image<float>& c) {
        return uchar(std::lround(255 * std::clamp(c.at(part.x + x, part.y + y), 0.f, 1.f)));
      };
      out(y, x) = {level(picture.blue), level(picture.green), level(picture.red)};
    }
  return out;
}

}  // namespace

Image<uint8_t> cut_out(const Picture& picture, const Image<uint8_t>& maybe, int rounds) {
  const cv::Mat1b inside(maybe.height, maybe.width, const_cast<uint8_t*>(maybe.data.data()));
  const cv::Rect box = cv::boundingRect(inside);
  const int around =
      std::max(kLeastSurroundings, int(kSurroundings * std::max(box.width, box.height)));
  const cv::Rect part =
      cv::Rect(box.x - around, box.y - around, box.width + 2 * around, box.height + 2 * around) &
      cv::Rect(0, 0, maybe.width, maybe.height);
  const int may = cv::countNonZero(inside);
  if (may < kFewestPixels || part.area() - may < kFewestPixels) return {};
  const int first = cv::countNonZero(inside == kLikely) < kFewestPixels ? 1 : kLikely;
  cv::Mat1b label(part.size());
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) {
      const int here = inside(part.y + y, part.x + x);
      label(y, x) = here >= first ? cv::GC_PR_FGD : here > 0 ? cv::GC_PR_BGD : cv::GC_BGD;
    }
  cv::Mat background, foreground;
  cv::theRNG().state = 1;  // of this thread: where the means of colours start
  cv::grabCut(colours(picture, part), label, {}, background, foreground, rounds,
              cv::GC_INIT_WITH_MASK);
  Image<uint8_t> out(maybe.width, maybe.height);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      out.at(part.x + x, part.y + y) = label(y, x) == cv::GC_PR_FGD;
  return out;
}

}  // namespace sketchsplat

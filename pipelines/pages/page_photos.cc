// SPDX-License-Identifier: MIT
#include "pipelines/pages/page_photos.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "datasets/io/jpeg_codec.h"
#include "datasets/types/errors.h"
#include "pipelines/pages/overlay.h"

namespace sketchsplat {
namespace {

constexpr int kMostPhotos = 100;
constexpr int kLongest = 640;           // [px] of a photograph
constexpr double kBytesPerPixel = 0.2;  // of most photographs at this quality
constexpr int kQuality = 75;

int longest_side(const View& view) { return std::max({view.camera.width, view.camera.height, 1}); }

// 8 bit RGB on white, at most `longest` px wide and high.
cv::Mat small_picture(const View& view, int longest) {
  int denominator = 1;
  while (denominator < 8 && longest_side(view) >= 2 * denominator * longest) denominator *= 2;
  Picture picture = read_picture(view, denominator);
  const double scale = std::min(1.0, double(longest) / longest_side(view));
  const cv::Size size(std::max(1, int(std::lround(view.camera.width * scale))),
                      std::max(1, int(std::lround(view.camera.height * scale))));
  std::vector<cv::Mat> channels;
  for (Image<float>* channel : {&picture.red, &picture.green, &picture.blue}) {
    for (size_t i = 0; i < channel->data.size() && !picture.alpha.empty(); ++i)
      channel->data[i] = channel->data[i] * picture.alpha.data[i] + 1 - picture.alpha.data[i];
    cv::Mat reduced, bytes;
    cv::resize(cv::Mat(channel->height, channel->width, CV_32F, channel->data.data()), reduced,
               size, 0, 0, cv::INTER_AREA);
    reduced.convertTo(bytes, CV_8U, 255);
    channels.push_back(bytes);
  }
  cv::Mat out;
  cv::merge(channels, out);
  return out;
}

// Empty if there is none.
std::string jpeg_of(const View& view, int longest) {
  std::string bytes, found;
  try {
    const cv::Mat rows = small_picture(view, longest);
    encode_jpeg(rows.data, rows.cols, rows.rows, kQuality, &bytes, &found);
  } catch (const InputError&) {
  }
  return bytes;
}

// So long that `count` pictures of this shape fit.
int side_that_fits(const View& view, int count) {
  const double pixels = double(kMostPhotoBytes) / count / kBytesPerPixel;
  const double shape = double(std::min(view.camera.width, view.camera.height)) / longest_side(view);
  return std::clamp(int(std::sqrt(pixels / std::max(shape, 0.1))), 64, kLongest);
}

// Every other one goes until the rest fits.
void thin_out(std::vector<PagePhoto>* photos) {
  const auto bytes = [&] {
    size_t sum = 0;
    for (const PagePhoto& photo : *photos) sum += photo.jpeg.size();
    return sum;
  };
  while (bytes() > kMostPhotoBytes) {
    std::vector<PagePhoto> rest;
    for (size_t i = 0; i < photos->size(); i += 2) rest.push_back(std::move((*photos)[i]));
    if (photos->size() == 1) rest.clear();
    *photos = std::move(rest);
  }
}

}  // namespace

std::vector<PagePhoto> page_photos(const Scene& scene, const Eigen::Vector3d& target) {
  const std::vector<int> chosen = spread_views(scene.views, target, kMostPhotos);
  const int n = int(chosen.size());
  std::vector<PagePhoto> all(n), photos;
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < n; ++i) {
    const View& view = scene.views[chosen[i]];
    all[i] = {view, jpeg_of(view, side_that_fits(view, n))};
  }
  for (PagePhoto& photo : all)
    if (!photo.jpeg.empty()) photos.push_back(std::move(photo));
  thin_out(&photos);
  return photos;
}

}  // namespace sketchsplat

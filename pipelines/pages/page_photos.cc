// SPDX-License-Identifier: MIT
#include "pipelines/pages/page_photos.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "datasets/io/jpeg_codec.h"
#include "datasets/readers/smaller_pictures.h"
#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"
#include "pipelines/pages/overlay.h"

namespace sketchsplat {
namespace {

constexpr int kMostPhotos = 100;
constexpr int kLongest = 640;           // [px] of a photograph
constexpr double kBytesPerPixel = 0.2;  // of most photographs at this quality
constexpr int kQuality = 75;

// By which a picture may be reduced when it is read.
int denominator_of(const View& view, const cv::Size& size) {
  int denominator = 1;
  while (denominator < 8 && view.camera.width >= 2 * denominator * size.width &&
         view.camera.height >= 2 * denominator * size.height)
    denominator *= 2;
  return denominator;
}

int longest_side(const View& view) { return std::max({view.camera.width, view.camera.height, 1}); }

// 8 bit RGB on white.
cv::Mat small_picture(const Picture& picture, const cv::Size& size) {
  const float* alpha = picture.alpha.empty() ? nullptr : picture.alpha.data.data();
  cv::Mat planes[3], full, *plane = planes;
  for (const Image<float>* channel : {&picture.red, &picture.green, &picture.blue}) {
    plane->create(picture.height(), picture.width(), CV_8U);
    const float* from = channel->data.data();
    uchar* to = (plane++)->ptr();
    for (size_t i = 0, n = channel->data.size(); i < n; ++i) {
      const float v = alpha ? from[i] * alpha[i] + 1 - alpha[i] : from[i];
      to[i] = uchar(std::max(0.f, std::min(255.f, v * 255 + 0.5f)));
    }
  }
  cv::merge(planes, 3, full);
  // Over blocks of less than two pixels a mean is hardly smoother, and takes five times as long.
  const bool alike = picture.width() < 2 * size.width;
  cv::Mat out;
  cv::resize(full, out, size, 0, 0, alike ? cv::INTER_LINEAR : cv::INTER_AREA);
  return out;
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

// One slot per view that is shown.
struct PhotoAlbum::Copies {
  struct Slot {
    cv::Size size;
    std::atomic<bool> taken{false};
    std::string jpeg;
  };
  explicit Copies(size_t count) : slots(count) {}

  // Once; of a picture that is large enough.
  void keep(const Picture& picture, int k) {
    Slot& slot = slots[k];
    if (picture.width() < slot.size.width || picture.height() < slot.size.height) return;
    if (slot.taken.exchange(true)) return;
    const cv::Mat rows = small_picture(picture, slot.size);
    std::string found;
    encode_jpeg(rows.data, rows.cols, rows.rows, kQuality, &slot.jpeg, &found);
  }

  std::vector<Slot> slots;
};

PhotoAlbum::PhotoAlbum(const Scene& scene, const Eigen::Vector3d& target)
    : scene_(scene),
      chosen_(spread_views(scene.views, target, kMostPhotos)),
      copies_(std::make_shared<Copies>(chosen_.size())) {
  for (size_t k = 0; k < chosen_.size(); ++k) {
    const View& view = scene.views[chosen_[k]];
    const int longest = side_that_fits(view, int(chosen_.size()));
    const double scale = std::min(1.0, double(longest) / longest_side(view));
    const auto reduced = [&](int side) { return std::max(1, int(std::lround(side * scale))); };
    copies_->slots[k].size = {reduced(view.camera.width), reduced(view.camera.height)};
  }
}

Scene PhotoAlbum::watched() const {
  Scene out = scene_;
  for (size_t k = 0; k < chosen_.size(); ++k)
    out.views[chosen_[k]].when_read = [copies = copies_, k](const Picture& picture) {
      copies->keep(picture, int(k));
    };
  return out;
}

std::vector<PagePhoto> PhotoAlbum::photos(const std::vector<View>& views) const {
  std::vector<const View*> known(scene_.views.size(), nullptr);
  const std::vector<int> places = places_in(scene_, views);
  for (size_t v = 0; v < views.size(); ++v) known[places[v]] = &views[v];
  std::vector<PagePhoto> photos;
  parallel_for(int(chosen_.size()), 1, [&](int k) {
    const View& view = scene_.views[chosen_[k]];
    if (!known[chosen_[k]] || copies_->slots[k].taken) return;
    try {
      copies_->keep(read_picture(view, denominator_of(view, copies_->slots[k].size)), k);
    } catch (const InputError&) {
    }
  });
  for (size_t k = 0; k < chosen_.size(); ++k)
    if (known[chosen_[k]] && !copies_->slots[k].jpeg.empty())
      photos.push_back({*known[chosen_[k]], copies_->slots[k].jpeg});
  thin_out(&photos);
  return photos;
}

}  // namespace sketchsplat

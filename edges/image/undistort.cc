// SPDX-License-Identifier: MIT
#include "edges/image/undistort.h"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/image/edgel_map.h"
#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

/// Ideal pixels per pixel of the image, at most: beyond, nothing is sharp, and the ideal picture of
/// a fisheye has no end.
constexpr double kMostStretch = 4;

/// Smallest singular value of a 2 x 2 matrix.
double least_stretch(const Eigen::Matrix2d& m) {
  const double sum = m.squaredNorm(), product = std::abs(m.determinant());
  const double largest =
      std::sqrt(0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4 * product * product))));
  return largest > 0 ? product / largest : 0;
}

void move(const Eigen::Vector2d& to, const Eigen::Matrix2d& pull_back, Edgel* e) {
  const Eigen::Vector2d n = pull_back.transpose() * Eigen::Vector2d(e->nx, e->ny);
  const double steeper = n.norm();
  e->x = float(to.x()), e->y = float(to.y());
  e->nx = float(n.x() / steeper), e->ny = float(n.y() / steeper);
  e->strength = float(e->strength * steeper);
  e->width = float(e->width / steeper);
}

void resample(const cv::Mat2f& from, Image<float>* channel) {
  if (channel->empty()) return;
  Image<float> out(channel->width, channel->height);
  cv::remap(mat_of(*channel), mat_of(out), from, cv::noArray(), cv::INTER_LINEAR,
            cv::BORDER_CONSTANT, 0);
  *channel = std::move(out);
}

}  // namespace

EdgelMap undistort_edgels(EdgelMap found, const View& view, int min_chain) {
  if (view.lens.is_identity()) return found;
  std::vector<char> keep(found.edgels.size());
  for (size_t i = 0; i < keep.size(); ++i) {
    Edgel& e = found.edgels[i];
    Eigen::Vector2d ideal;
    Eigen::Matrix2d J;
    keep[i] = view.ideal_pixel({e.x, e.y}, &ideal, &J) && least_stretch(J) * kMostStretch > 1;
    if (keep[i]) move(ideal, J, &e);
  }
  EdgelMap out = runs_of(found, keep, min_chain);
  out.mask = std::move(found.mask);
  return out;
}

EdgelMap distort_edgels(EdgelMap ideal, const View& view) {
  if (view.lens.is_identity()) return ideal;
  for (Edgel& e : ideal.edgels) {
    Eigen::Vector2d image;
    Eigen::Matrix2d J;
    if (view.image_pixel({e.x, e.y}, &image, &J)) move(image, J.inverse(), &e);
  }
  ideal.nearest.clear();
  ideal.window_width = ideal.window_height = 0;
  return ideal;
}

Picture undistort_picture(Picture picture, const View& view) {
  if (view.lens.is_identity()) return picture;
  const int w = picture.width(), h = picture.height();
  cv::Mat2f from(h, w);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      Eigen::Vector2d image;
      const bool drawn = view.image_pixel({double(x), double(y)}, &image);
      from(y, x) = drawn ? cv::Vec2f(float(image.x()), float(image.y())) : cv::Vec2f(-9, -9);
    }
  const std::vector<float>& alpha = picture.alpha.data;
  Image<float>* const colours[] = {&picture.red, &picture.green, &picture.blue};
  for (Image<float>* colour : colours) {
    for (size_t i = 0; i < alpha.size(); ++i) colour->data[i] *= alpha[i];
    resample(from, colour);
  }
  resample(from, &picture.alpha);
  for (Image<float>* colour : colours)
    for (size_t i = 0; i < alpha.size(); ++i)
      if (alpha[i] > 0) colour->data[i] /= alpha[i];
  return picture;
}

}  // namespace sketchsplat

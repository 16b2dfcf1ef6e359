// SPDX-License-Identifier: MIT
#include "edges/surfels/model/training_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/image/mats.h"

namespace sketchsplat {
namespace {

Image<float> resized(const Image<float>& image, int width, int height) {
  if (width == image.width && height == image.height) return image;
  Image<float> out(width, height);
  cv::resize(mat_of(image), mat_of(out), cv::Size(width, height), 0, 0, cv::INTER_AREA);
  return out;
}

Image<float> times(const Image<float>& a, const Image<float>& b) {
  Image<float> out = a;
  for (size_t i = 0; i < out.data.size(); ++i) out.data[i] *= b.data[i];
  return out;
}

}  // namespace

TrainingView shrink(const TrainingView& view, int max_side) {
  const Camera& c = view.view.camera;
  const double ratio = std::max(1.0, double(std::max(c.width, c.height)) / max_side);
  TrainingView out;
  out.view = view.view;
  Camera& small = out.view.camera;
  small.width = std::max(1, int(std::lround(c.width / ratio)));
  small.height = std::max(1, int(std::lround(c.height / ratio)));
  // Centres of pixels are integers, so the image begins at -1/2.
  const double rx = double(small.width) / c.width, ry = double(small.height) / c.height;
  small.fx = c.fx * rx, small.cx = (c.cx + 0.5) * rx - 0.5;
  small.fy = c.fy * ry, small.cy = (c.cy + 0.5) * ry - 0.5;
  for (int k = 0; k < 3; ++k) out.color[k] = resized(view.color[k], small.width, small.height);
  out.alpha = resized(view.alpha, small.width, small.height);
  return out;
}

TrainingView make_training_view(const View& view, const Picture& picture, int max_side) {
  TrainingView full;
  full.view = view;
  full.alpha = picture.alpha;
  full.color[0] = times(picture.red, picture.alpha);
  full.color[1] = times(picture.green, picture.alpha);
  full.color[2] = times(picture.blue, picture.alpha);
  return shrink(full, max_side);
}

}  // namespace sketchsplat

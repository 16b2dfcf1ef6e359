// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/render.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/io/image_io.h"
#include "datasets/synthetic/render/noise.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

float to_srgb(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

float from_srgb(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

void blur(double sigma, Image<float>* image) {
  const int radius = int(std::ceil(4 * sigma));
  std::vector<float> kernel(2 * radius + 1);
  float sum = 0;
  for (int i = -radius; i <= radius; ++i)
    sum += kernel[i + radius] = float(std::exp(-0.5 * i * i / (sigma * sigma)));
  for (float& k : kernel) k /= sum;
  for (const bool along_x : {true, false}) {
    const Image<float> in = *image;
    parallel_for(in.height, [&](int y) {
      for (int x = 0; x < in.width; ++x) {
        float value = 0;
        for (int i = -radius; i <= radius; ++i)
          value += kernel[i + radius] * (along_x ? in.at(std::clamp(x + i, 0, in.width - 1), y)
                                                 : in.at(x, std::clamp(y + i, 0, in.height - 1)));
        image->at(x, y) = value;
      }
    });
  }
}

Picture compressed(Picture picture, const RenderOptions& options) {
  // Outside of the object there is no colour; what stands there tells on the pixels beside it.
  Image<float>& grey = picture.red;
  for (size_t i = 0; i < picture.alpha.data.size(); ++i)
    if (picture.alpha.data[i] == 0) grey.data[i] = float(options.background);
  picture.green = picture.blue = grey;
  Picture out = through_jpeg(picture, options.jpeg);
  out.alpha = std::move(picture.alpha);
  for (size_t i = 0; i < out.alpha.data.size(); ++i)
    if (out.alpha.data[i] == 0) out.red.data[i] = out.green.data[i] = out.blue.data[i] = 0;
  return out;
}

}  // namespace

Picture expose(const Painting& painting, const RenderOptions& options, std::uint64_t seed,
               int index) {
  Image<float> light_of = painting.light, alpha_of = painting.alpha;
  if (options.blur > 0) {
    blur(options.blur, &light_of);
    blur(options.blur, &alpha_of);
  }
  const bool transparent = options.transparent && !options.clutter;
  const float gain = float(exposure_of(options, seed, index));
  const float background = options.clutter ? 0.0f : from_srgb(float(options.background));
  const int w = light_of.width, h = light_of.height;
  Picture picture;
  Image<float>& grey = picture.red = Image<float>(w, h, 0.0f);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const float alpha = alpha_of.at(x, y);
      float light = light_of.at(x, y);
      if (!transparent) {
        light += (1 - alpha) * background;
      } else if (alpha > 0) {
        light /= alpha;
      } else {
        continue;
      }
      double value = to_srgb(gain * light);
      if (options.noise > 0)
        value += options.noise / 255 * normal(hash(seed, index, std::uint64_t(y) << 20 | x, 2));
      grey.at(x, y) = float(std::clamp(value, 0.0, 1.0));
    }
  picture.green = picture.blue = grey;
  if (transparent) picture.alpha = std::move(alpha_of);
  return options.jpeg > 0 ? compressed(std::move(picture), options) : picture;
}

double exposure_of(const RenderOptions& options, std::uint64_t seed, int index) {
  return std::exp2(options.exposure * normal(hash(seed, index, 0, 1)));
}

void expose_photo(const RenderOptions& options, std::uint64_t seed, int index, Picture* picture) {
  const float gain = float(exposure_of(options, seed, index));
  Image<float>* const planes[] = {&picture->red, &picture->green, &picture->blue};
  for (int c = 0; c < 3; ++c) {
    Image<float>& plane = *planes[c];
    if (options.blur > 0) blur(options.blur, &plane);
    parallel_for(plane.height, [&](int y) {
      for (int x = 0; x < plane.width; ++x) {
        double value = to_srgb(gain * plane.at(x, y));
        if (options.noise > 0)
          value += options.noise / 255 *
                   normal(hash(seed, index, std::uint64_t(y) << 20 | std::uint64_t(x), 4 + c));
        plane.at(x, y) = float(std::clamp(value, 0.0, 1.0));
      }
    });
  }
}

}  // namespace sketchsplat

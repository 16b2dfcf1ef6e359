// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/synthetic/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kGrid = 6;  // rays per pixel along x and along y, where something changes

struct Lamp {
  Vector3f position;
  float power;  // radiance of a white surface that faces it at the object's centre
};
// Unit frame. Near enough for a gradient across flat faces. The six sides of a box get about
// 225, 202, 190, 180, 166 and 158 grey levels: some pairs differ by ten only.
const Lamp kLamps[] = {{{2.6f, -2.2f, 3.6f}, 0.67f},
                       {{-3.6f, -0.4f, 1.5f}, 0.41f},
                       {{0.8f, 3.8f, 0.9f}, 0.39f},
                       {{-0.7f, 0.9f, -3.6f}, 0.26f},
                       {{3.3f, 1.4f, -1.9f}, 0.18f}};
constexpr float kSky = 0.14f, kGround = 0.06f, kAlbedo = 0.88f;

float shade(const Vector3f& point, const Vector3f& normal) {
  float light = kGround + (kSky - kGround) * 0.5f * (1 + normal.z());
  for (const Lamp& lamp : kLamps) {
    const Vector3f to = lamp.position - point;
    const float d2 = to.squaredNorm();
    const float cosine = normal.dot(to) / std::sqrt(d2);
    if (cosine > 0) light += lamp.power * cosine * lamp.position.squaredNorm() / d2;
  }
  return kAlbedo * light;
}

float to_srgb(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

float from_srgb(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

// Blackman-Harris window over three pixels, by the distance from the pixel's centre [px]; 1 in the
// middle (Harris, "On the use of windows for harmonic analysis", 1978). From a table: it is asked
// for a hundred million times.
class PixelFilter {
 public:
  PixelFilter() {
    for (int i = 0; i <= kSteps; ++i) {
      const double t = 2 * M_PI * (0.5 + 0.5 * i / kSteps);
      table_[i] = float(0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) -
                        0.01168 * std::cos(3 * t));
    }
    table_[kSteps + 1] = table_[kSteps];
  }
  float operator()(float x) const {
    const float at = std::min(std::abs(x) / 1.5f, 1.0f) * kSteps;
    const int i = int(at);
    return table_[i] + (at - i) * (table_[i + 1] - table_[i]);
  }

 private:
  static constexpr int kSteps = 512;
  std::array<float, kSteps + 2> table_;
};
const PixelFilter pixel_filter;

// Values of one picture: linear light times coverage, and coverage.
struct Layer {
  Image<float> light, alpha;
  Layer(int w, int h) : light(w, h, 0.0f), alpha(w, h, 0.0f) {}
};

struct Rect {
  int x0, y0, x1, y1;  // [x0, x1) x [y0, y1)
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

// Pixels that may see the unit cube, and a margin for the filter.
Rect pixels_of_object(const View& view) {
  const int w = view.camera.width, h = view.camera.height;
  Eigen::Vector2d low(w, h), high(0, 0);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    double depth;
    const Eigen::Vector2d x = view.project(p, &depth);
    if (!(depth > 1e-3)) return {0, 0, w, h};  // the camera stands among them
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return {
      int(std::clamp(low.x() - 4, 0.0, double(w))), int(std::clamp(low.y() - 4, 0.0, double(h))),
      int(std::clamp(high.x() + 5, 0.0, double(w))), int(std::clamp(high.y() + 5, 0.0, double(h)))};
}

// What the ray through a pixel's centre meets.
struct Glimpse {
  int face = -1;
  Vector3f point = Vector3f::Zero(), normal = Vector3f::Zero(), facet_normal = Vector3f::Zero();
  float light = 0;
};

class Painter {
 public:
  Painter(const Tracer& tracer, const View& view, std::uint64_t seed, int index)
      : tracer_(tracer), view_(view), seed_(seed), index_(index), rect_(pixels_of_object(view)) {
    origin_ = view.center_in_world().cast<float>();
    unit_from_cam_ = view.cam_from_world.rotation.transpose();
  }

  Layer paint(const Eigen::Matrix3Xd& hints) {
    const int w = view_.camera.width, h = view_.camera.height;
    glimpses_ = Image<Glimpse>(w, h);
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x) glimpses_.at(x, y) = look(x, y);
    busy_ = Image<char>(w, h, 0);
    mark_changes();
    mark_hints(hints);
    cast_fine_rays();
    Layer layer(w, h);
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x) gather(x, y, &layer);
    return layer;
  }

 private:
  struct Fine {
    float x, y, light, alpha;  // where in the pixel, from its centre
  };

  Glimpse look(double x, double y) const {
    const Vector3f direction = (unit_from_cam_ * view_.camera.ray({x, y})).cast<float>();
    const Hit hit = tracer_.cast(origin_, direction);
    Glimpse g;
    g.face = hit.face;
    if (hit.face < 0) return g;
    g.point = origin_ + direction * hit.depth;
    g.normal = hit.normal;
    g.facet_normal = hit.facet_normal;
    g.light = shade(g.point, g.normal);
    return g;
  }

  // Neighbours that do not lie on one smooth piece of surface.
  bool differ(const Glimpse& a, const Glimpse& b) const {
    if (a.face != b.face) return true;
    if (a.face < 0) return false;
    if (a.normal.dot(b.normal) < 0.98f) return true;
    const float footprint = (a.point - origin_).norm() / float(view_.camera.fx);
    return std::abs((b.point - a.point).dot(a.facet_normal)) > 0.5f * footprint;
  }

  void mark_changes() {
    const int steps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x)
        for (const auto& step : steps) {
          const int u = x + step[0], v = y + step[1];
          if (rect_.contains(u, v) && differ(glimpses_.at(x, y), glimpses_.at(u, v)))
            busy_.at(x, y) = busy_.at(u, v) = 1;
        }
  }

  void mark_hints(const Eigen::Matrix3Xd& hints) {
    for (int i = 0; i < hints.cols(); ++i) {
      double depth;
      const Eigen::Vector2d p = view_.project(hints.col(i), &depth);
      if (!(depth > 0) || !view_.camera.contains(p)) continue;
      const int cx = int(std::lround(p.x())), cy = int(std::lround(p.y()));
      for (int y = cy - 1; y <= cy + 1; ++y)
        for (int x = cx - 1; x <= cx + 1; ++x)
          if (rect_.contains(x, y)) busy_.at(x, y) = 1;
    }
  }

  // Jittered, so that an edge along the rows of pixels is noisy rather than off by a twelfth of
  // one.
  void cast_fine_rays() {
    fine_of_ = Image<int>(busy_.width, busy_.height, -1);
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x) {
        if (!busy_.at(x, y)) continue;
        fine_of_.at(x, y) = int(fine_.size());
        for (int k = 0; k < kGrid * kGrid; ++k) {
          const std::uint64_t r = hash(seed_, index_, std::uint64_t(y) << 20 | x, 1000 + k);
          const float dx = float((k % kGrid + uniform(r)) / kGrid - 0.5);
          const float dy = float((k / kGrid + uniform(mix(r))) / kGrid - 0.5);
          const Glimpse g = look(x + dx, y + dy);
          fine_.push_back({dx, dy, g.light, g.face < 0 ? 0.0f : 1.0f});
        }
      }
  }

  void gather(int x, int y, Layer* layer) const {
    bool quiet = true;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u) quiet &= !rect_.contains(u, v) || !busy_.at(u, v);
    const Glimpse& centre = glimpses_.at(x, y);
    if (quiet) {
      layer->light.at(x, y) = centre.light;
      layer->alpha.at(x, y) = centre.face < 0 ? 0.0f : 1.0f;
      return;
    }
    double light = 0, alpha = 0, weights = 0;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u) {
        // A pixel where nothing changes counts as a grid of equal rays.
        const int first = rect_.contains(u, v) ? fine_of_.at(u, v) : -1;
        const Glimpse g = rect_.contains(u, v) ? glimpses_.at(u, v) : Glimpse();
        for (int k = 0; k < kGrid * kGrid; ++k) {
          Fine f{(k % kGrid + 0.5f) / kGrid - 0.5f, (k / kGrid + 0.5f) / kGrid - 0.5f, g.light,
                 g.face < 0 ? 0.0f : 1.0f};
          if (first >= 0) f = fine_[first + k];
          const double weight = pixel_filter(u - x + f.x) * pixel_filter(v - y + f.y);
          light += weight * f.light;
          alpha += weight * f.alpha;
          weights += weight;
        }
      }
    layer->light.at(x, y) = float(light / weights);
    layer->alpha.at(x, y) = float(alpha / weights);
  }

  const Tracer& tracer_;
  const View& view_;
  std::uint64_t seed_;
  int index_;
  Rect rect_;
  Vector3f origin_;
  Eigen::Matrix3d unit_from_cam_;
  Image<Glimpse> glimpses_;
  Image<char> busy_;    // pixels that one ray does not describe
  Image<int> fine_of_;  // first of their rays in fine_
  std::vector<Fine> fine_;
};

void blur(double sigma, Image<float>* image) {
  const int radius = int(std::ceil(4 * sigma));
  std::vector<float> kernel(2 * radius + 1);
  float sum = 0;
  for (int i = -radius; i <= radius; ++i)
    sum += kernel[i + radius] = float(std::exp(-0.5 * i * i / (sigma * sigma)));
  for (float& k : kernel) k /= sum;
  for (const bool along_x : {true, false}) {
    const Image<float> in = *image;
    for (int y = 0; y < in.height; ++y)
      for (int x = 0; x < in.width; ++x) {
        float value = 0;
        for (int i = -radius; i <= radius; ++i)
          value += kernel[i + radius] * (along_x ? in.at(std::clamp(x + i, 0, in.width - 1), y)
                                                 : in.at(x, std::clamp(y + i, 0, in.height - 1)));
        image->at(x, y) = value;
      }
  }
}

}  // namespace

Picture render(const Tracer& tracer, const View& view, const Eigen::Matrix3Xd& hints,
               const RenderOptions& options, std::uint64_t seed, int index) {
  Layer layer = Painter(tracer, view, seed, index).paint(hints);
  if (options.blur > 0) {
    blur(options.blur, &layer.light);
    blur(options.blur, &layer.alpha);
  }
  const float gain = float(std::exp2(options.exposure * normal(hash(seed, index, 0, 1))));
  const float background = from_srgb(float(options.background));
  const int w = view.camera.width, h = view.camera.height;
  Picture picture;
  Image<float>& grey = picture.red = Image<float>(w, h, 0.0f);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const float alpha = layer.alpha.at(x, y);
      float light = layer.light.at(x, y);
      if (!options.transparent) {
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
  if (options.transparent) picture.alpha = std::move(layer.alpha);
  return picture;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "datasets/synthetic/render/noise.h"
#include "datasets/synthetic/render/pixel_filter.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kGrid = 6;  // rays per pixel along x and along y, where something changes
constexpr int kRays = kGrid * kGrid;

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
  int face = -1;  // of the object; -1 if nothing, -2 and below: of the clutter
  float depth = 0, light = 0;
  bool mixed = false;
  Vector3f point = Vector3f::Zero(), normal = Vector3f::Zero(), facet_normal = Vector3f::Zero();
};

// Sums over the rays near a pixel.
struct Sums {
  float light = 0, alpha = 0, weight = 0;
};

class Painter {
 public:
  Painter(const Subject& subject, const View& view, std::uint64_t seed, int index)
      : subject_(subject), view_(view), seed_(seed), index_(index) {
    const Camera& camera = view.camera;
    rect_ = subject.clutter ? Rect{0, 0, camera.width, camera.height} : pixels_of_object(view);
    origin_ = view.center_in_world().cast<float>();
    unit_from_cam_ = view.cam_from_world.rotation.transpose();
  }

  Painting paint() {
    const int w = view_.camera.width, h = view_.camera.height;
    glimpses_ = Image<Glimpse>(w, h);
    for (int y = rect_.y0; y < rect_.y1; ++y) look_along_row(y);
    busy_ = Image<char>(w, h, 0);
    mark_changes();
    mark_hints();
    soft_ = Image<char>(w, h, 0);
    sums_ = Image<Sums>(w, h);
    spread_rays();
    return gather();
  }

 private:
  Vector3f direction(double x, double y) const {
    return (unit_from_cam_ * view_.camera.ray({x, y})).cast<float>();
  }

  SurfacePoint surface_point(const Hit& hit, const Vector3f& direction) const {
    return {origin_ + direction * hit.depth, hit.normal, hit.facet_normal, -direction.normalized(),
            hit.face};
  }

  // What rays meet; those that pass the object, behind it.
  struct Seen {
    std::vector<Hit> hits;
    std::vector<char> behind;  // the hit, if any, is one of the clutter
  };
  void look(const std::vector<Vector3f>& directions, Seen* seen) const {
    const int n = int(directions.size());
    seen->hits.resize(n);
    seen->behind.assign(n, 0);
    subject_.object.cast(origin_, directions.data(), n, seen->hits.data());
    if (!subject_.clutter) return;
    std::vector<Vector3f> passing;
    for (int i = 0; i < n; ++i)
      if (seen->hits[i].face < 0) passing.push_back(directions[i]);
    std::vector<Hit> hits(passing.size());
    subject_.clutter->tracer.cast(origin_, passing.data(), int(passing.size()), hits.data());
    for (int i = 0, k = 0; i < n; ++i)
      if (seen->hits[i].face < 0) {
        seen->hits[i] = hits[k++];
        seen->behind[i] = 1;
      }
  }

  void look_along_row(int y) {
    const int n = rect_.x1 - rect_.x0;
    std::vector<Vector3f> directions(n);
    for (int i = 0; i < n; ++i) directions[i] = direction(rect_.x0 + i, y);
    Seen seen;
    look(directions, &seen);
    for (int i = 0; i < n; ++i)
      glimpses_.at(rect_.x0 + i, y) = glimpse(seen.hits[i], seen.behind[i], directions[i]);
  }

  Glimpse glimpse(const Hit& hit, bool behind, const Vector3f& direction) const {
    Glimpse g;
    if (hit.face < 0) return g;
    const SurfacePoint s = surface_point(hit, direction);
    g.face = behind ? -2 - hit.face : hit.face;
    g.light = behind ? subject_.shader.clutter(s, subject_.clutter->size)
                     : subject_.shader.object(s, &g.mixed);
    g.depth = hit.depth;
    g.point = s.point;
    g.normal = hit.normal;
    g.facet_normal = hit.facet_normal;
    return g;
  }

  // Neighbours that do not lie on one smooth piece of surface, or are lit or printed differently.
  bool differ(const Glimpse& a, const Glimpse& b) const {
    if (a.face != b.face) return true;
    if (a.face == -1) return false;
    if (a.normal.dot(b.normal) < 0.98f) return true;
    const bool patterned = a.face < -1 || subject_.shader.patterned();
    if (patterned && std::abs(a.light - b.light) > 0.002f + 0.02f * std::max(a.light, b.light))
      return true;
    const float footprint = (a.point - origin_).norm() / float(view_.camera.fx);
    return std::abs((b.point - a.point).dot(a.facet_normal)) > 0.5f * footprint;
  }

  void mark_changes() {
    const int steps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x) {
        if (glimpses_.at(x, y).mixed) busy_.at(x, y) = 1;
        for (const auto& step : steps) {
          const int u = x + step[0], v = y + step[1];
          if (rect_.contains(u, v) && differ(glimpses_.at(x, y), glimpses_.at(u, v)))
            busy_.at(x, y) = busy_.at(u, v) = 1;
        }
      }
  }

  // Where all pixels about an edge see something well in front of it, it is hidden: whatever gap
  // it might be seen through has edges, and hints, of its own.
  void mark_hints() {
    for (int i = 0; i < subject_.hints.cols(); ++i) {
      double depth;
      const Eigen::Vector2d p = view_.project(subject_.hints.col(i), &depth);
      if (!(depth > 0) || !view_.camera.contains(p)) continue;
      const float hidden = float(depth * (1 - 8 / view_.camera.fx) - 0.01);
      const int cx = int(std::lround(p.x())), cy = int(std::lround(p.y()));
      for (int y = cy - 1; y <= cy + 1; ++y)
        for (int x = cx - 1; x <= cx + 1; ++x) {
          if (!rect_.contains(x, y)) continue;
          const Glimpse& g = glimpses_.at(x, y);
          if (g.face < 0 || g.depth > hidden) busy_.at(x, y) = 1;
        }
    }
  }

  // Every ray adds to the nine pixels whose filters reach it.
  void spread_rays() {
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x)
        if (busy_.at(x, y))
          for (int v = std::max(y - 1, rect_.y0); v < std::min(y + 2, rect_.y1); ++v)
            for (int u = std::max(x - 1, rect_.x0); u < std::min(x + 2, rect_.x1); ++u)
              soft_.at(u, v) = 1;
    const std::array<float, 9> flat = weights_of_a_grid(kGrid);
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x) {
        if (busy_.at(x, y)) {
          spread_fine_rays(x, y);
        } else if (beside_soft(x, y)) {
          const Glimpse& g = glimpses_.at(x, y);
          std::array<Sums, 9> sums;
          for (int k = 0; k < 9; ++k)
            sums[k] = {flat[k] * g.light, g.face < 0 ? 0.0f : flat[k], flat[k]};
          add(x, y, sums);
        }
      }
  }

  bool beside_soft(int x, int y) const {
    for (int v = std::max(y - 1, rect_.y0); v < std::min(y + 2, rect_.y1); ++v)
      for (int u = std::max(x - 1, rect_.x0); u < std::min(x + 2, rect_.x1); ++u)
        if (soft_.at(u, v)) return true;
    return false;
  }

  // Jittered, so that an edge along the rows of pixels is noisy rather than off by a twelfth of
  // one.
  void spread_fine_rays(int x, int y) {
    std::array<float, kRays> dx, dy;
    std::vector<Vector3f> directions(kRays);
    for (int i = 0; i < kRays; ++i) {
      const std::uint64_t r = hash(seed_, index_, std::uint64_t(y) << 20 | x, 1000 + i);
      dx[i] = float((i % kGrid + uniform(r)) / kGrid - 0.5);
      dy[i] = float((i / kGrid + uniform(mix(r))) / kGrid - 0.5);
      directions[i] = direction(x + dx[i], y + dy[i]);
    }
    Seen seen;
    look(directions, &seen);
    std::array<Sums, 9> sums;
    for (int i = 0; i < kRays; ++i) {
      const bool covered = seen.hits[i].face >= 0 && !seen.behind[i];
      const float light = light_of_ray(seen, i, directions[i], x, y);
      const std::array<float, 9> weights = weights_of_a_ray(dx[i], dy[i]);
      for (int k = 0; k < 9; ++k) {
        const float weight = weights[k];
        sums[k].light += weight * light;
        sums[k].alpha += covered ? weight : 0.0f;
        sums[k].weight += weight;
      }
    }
    add(x, y, sums);
  }

  float light_of_ray(const Seen& seen, int i, const Vector3f& direction, int x, int y) const {
    if (seen.hits[i].face < 0) return 0;
    const SurfacePoint s = surface_point(seen.hits[i], direction);
    if (seen.behind[i]) return subject_.shader.clutter(s, subject_.clutter->size);
    // Every part of the pixel sees every part of the lamp: 7 is prime to 36.
    const std::uint64_t r = hash(seed_, index_, std::uint64_t(y) << 20 | x, 3000 + i);
    const float u = (float((i * 7) % kRays) + float(uniform(r))) / kRays;
    return subject_.shader.object(s, u, float(uniform(mix(r))));
  }

  void add(int x, int y, const std::array<Sums, 9>& sums) {
    for (int k = 0; k < 9; ++k) {
      const int u = x + k % 3 - 1, v = y + k / 3 - 1;
      if (!rect_.contains(u, v)) continue;
      Sums& at = sums_.at(u, v);
      at.light += sums[k].light;
      at.alpha += sums[k].alpha;
      at.weight += sums[k].weight;
    }
  }

  Painting gather() const {
    const int w = view_.camera.width, h = view_.camera.height;
    const Image<float> zero(w, h, 0.0f);
    Painting out{zero, zero, zero, zero, zero, zero};
    const Eigen::Matrix3f cam_from_unit = view_.cam_from_world.rotation.cast<float>();
    for (int y = rect_.y0; y < rect_.y1; ++y)
      for (int x = rect_.x0; x < rect_.x1; ++x) {
        const Glimpse& centre = glimpses_.at(x, y);
        const Sums& sums = sums_.at(x, y);
        const bool soft = soft_.at(x, y);
        out.light.at(x, y) = soft ? sums.light / sums.weight : centre.light;
        out.alpha.at(x, y) = soft ? sums.alpha / sums.weight : centre.face < 0 ? 0.0f : 1.0f;
        if (centre.face < 0) continue;
        const Vector3f normal = cam_from_unit * centre.normal;
        out.depth.at(x, y) = centre.depth;
        out.normal_x.at(x, y) = normal.x();
        out.normal_y.at(x, y) = normal.y();
        out.normal_z.at(x, y) = normal.z();
      }
    return out;
  }

  const Subject& subject_;
  const View& view_;
  std::uint64_t seed_;
  int index_;
  Rect rect_;
  Vector3f origin_;
  Eigen::Matrix3d unit_from_cam_;
  Image<Glimpse> glimpses_;
  Image<char> busy_;  // pixels that one ray does not describe
  Image<char> soft_;  // pixels whose filters reach a busy one
  Image<Sums> sums_;  // where soft
};

}  // namespace

Painting paint(const Subject& subject, const View& view, std::uint64_t seed, int index) {
  return Painter(subject, view, seed, index).paint();
}

}  // namespace sketchsplat

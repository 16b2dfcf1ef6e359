// SPDX-License-Identifier: MIT
#include "datasets/synthetic/photo/photo_painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "datasets/synthetic/render/noise.h"
#include "datasets/synthetic/render/pixel_filter.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;

constexpr int kTile = 240;                                    // [px], a multiple of all steps
constexpr int kGrainGrid = 2, kPrintGrid = 4, kEdgeGrid = 6;  // rays along a side of a pixel
constexpr float kSameLight = 0.04f;  // shares of light that differ by less are interpolated

// What is the same for all tiles.
struct Frame {
  const PhotoWorld& world;
  const PhotoShader& shader;
  const View& view;
  std::uint64_t seed;
  int index;
  const Image<char>& edges;  // pixels on true edges
  Vector3f origin;
  Eigen::Matrix3d unit_from_cam;
  int step;  // [px] between the places where light is computed first

  // Rays of a pixel. Within it the lens is as good as affine: to 1e-4 px.
  class Rays {
   public:
    Rays(const Frame& frame, int x, int y) : frame_(frame) {
      Eigen::Matrix2d image_from_ideal;
      if (!frame.view.ideal_pixel({x, y}, &ideal_, &image_from_ideal))
        throw std::logic_error("a lens that draws nothing in a corner");
      ideal_from_image_ = image_from_ideal.inverse();
    }
    // At `place` from the pixel's centre [px].
    Vector3f direction(const Vector2d& place) const {
      const Vector2d ideal = ideal_ + ideal_from_image_ * place;
      return (frame_.unit_from_cam * frame_.view.camera.ray(ideal)).cast<float>();
    }

   private:
    const Frame& frame_;
    Vector2d ideal_;
    Eigen::Matrix2d ideal_from_image_;
  };
};

// What the ray through a pixel's centre meets.
struct Glimpse {
  SurfacePoint s{Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero(), -1};
  Color color = Color::Zero();
  Occlusion occlusion = Occlusion::Zero();
  bool lit = false;  // occlusion is known
  unsigned char grid = 1;
};

struct Sums {
  Color light = Color::Zero();
  float alpha = 0, weight = 0;
};

// Pixels [x0, x1) x [y0, y1) of the picture.
struct Box {
  int x0, y0, x1, y1;
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  Box grown(int margin, const Camera& camera) const {
    return {std::max(x0 - margin, 0), std::max(y0 - margin, 0), std::min(x1 + margin, camera.width),
            std::min(y1 + margin, camera.height)};
  }
};

class Tile {
 public:
  Tile(const Frame& frame, const Box& core)
      : f_(frame), core_(core), inner_(core.grown(1, f_.view.camera)) {
    // Light is computed at multiples of the step, whatever the tile.
    const Camera& camera = f_.view.camera;
    const int s = f_.step;
    box_ = core.grown(2, camera);
    box_ = {box_.x0 / s * s, box_.y0 / s * s, std::min((box_.x1 + s - 1) / s * s + 1, camera.width),
            std::min((box_.y1 + s - 1) / s * s + 1, camera.height)};
    glimpses_ = Image<Glimpse>(box_.x1 - box_.x0, box_.y1 - box_.y0);
  }

  void paint(Picture* out) {
    for (int y = box_.y0; y < box_.y1; ++y) look_along_row(y);
    for (int y = box_.y0; y < box_.y1; y += f_.step)
      for (int x = box_.x0; x < box_.x1; x += f_.step)
        light(x, y, std::min(x + f_.step, box_.x1 - 1), std::min(y + f_.step, box_.y1 - 1));
    const Box shaded = core_.grown(2, f_.view.camera);
    for (int y = shaded.y0; y < shaded.y1; ++y)
      for (int x = shaded.x0; x < shaded.x1; ++x) shade(x, y);
    mark(shaded);
    sums_ = Image<Sums>(core_.x1 - core_.x0, core_.y1 - core_.y0);
    for (int y = inner_.y0; y < inner_.y1; ++y)
      for (int x = inner_.x0; x < inner_.x1; ++x) spread(x, y);
    gather(out);
  }

 private:
  Glimpse& at(int x, int y) { return glimpses_.at(x - box_.x0, y - box_.y0); }

  SurfacePoint surface_point(const Hit& hit, const Vector3f& direction) const {
    return {f_.origin + direction * hit.depth, hit.normal, hit.facet_normal,
            -direction.normalized(), hit.face};
  }

  void look_along_row(int y) {
    const int n = box_.x1 - box_.x0;
    std::vector<Vector3f> directions(n);
    std::vector<Hit> hits(n);
    for (int i = 0; i < n; ++i) directions[i] = Frame::Rays(f_, box_.x0 + i, y).direction({0, 0});
    f_.world.tracer.cast(f_.origin, directions.data(), n, hits.data());
    for (int i = 0; i < n; ++i) at(box_.x0 + i, y).s = surface_point(hits[i], directions[i]);
  }

  // ------------------------------------------------------------------------------------- light

  bool is_dark(const Glimpse& g) const { return g.s.face < 0 || f_.shader.shines(g.s.face); }

  static bool same_surface(const SurfacePoint& a, const SurfacePoint& b) {
    return a.face == b.face && a.normal.dot(b.normal) > 0.9f;
  }

  void compute_light(Glimpse* g) const {
    if (g->lit) return;
    if (!is_dark(*g)) g->occlusion = f_.shader.occlusion(g->s.point, g->s.facet_normal);
    g->lit = true;
  }

  // Of the pixels between four corners: computed there; interpolated between them where they are
  // alike, otherwise the same with a quarter of the pixels.
  void light(int x0, int y0, int x1, int y1) {
    Glimpse* corners[4] = {&at(x0, y0), &at(x1, y0), &at(x0, y1), &at(x1, y1)};
    Occlusion low = Occlusion::Ones(), high = Occlusion::Zero();
    bool alike = true;
    for (Glimpse* corner : corners) {
      compute_light(corner);
      low = low.min(corner->occlusion);
      high = high.max(corner->occlusion);
      alike &= same_surface(corner->s, corners[0]->s);
    }
    if (alike && (high - low).maxCoeff() < kSameLight) {
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) interpolate(x0, y0, x1, y1, corners, x, y);
    } else if (x1 - x0 <= 2 && y1 - y0 <= 2) {
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) copy_light(corners, &at(x, y));
    } else {
      const int x = (x0 + x1) / 2, y = (y0 + y1) / 2;
      light(x0, y0, x, y);
      if (x1 > x) light(x, y0, x1, y);
      if (y1 > y) light(x0, y, x, y1);
      if (x1 > x && y1 > y) light(x, y, x1, y1);
    }
  }

  // From the first corner on the same surface.
  void copy_light(Glimpse* const corners[4], Glimpse* g) const {
    for (int i = 0; i < 4 && !g->lit; ++i)
      if (same_surface(corners[i]->s, g->s)) {
        g->occlusion = corners[i]->occlusion;
        g->lit = true;
      }
    compute_light(g);
  }

  void interpolate(int x0, int y0, int x1, int y1, Glimpse* const corners[4], int x, int y) {
    Glimpse& g = at(x, y);
    if (g.lit) return;
    if (!same_surface(g.s, corners[0]->s)) {
      compute_light(&g);
      return;
    }
    const float u = x1 > x0 ? float(x - x0) / float(x1 - x0) : 0.0f;
    const float v = y1 > y0 ? float(y - y0) / float(y1 - y0) : 0.0f;
    g.occlusion = (1 - v) * ((1 - u) * corners[0]->occlusion + u * corners[1]->occlusion) +
                  v * ((1 - u) * corners[2]->occlusion + u * corners[3]->occlusion);
    g.lit = true;
  }

  // ------------------------------------------------------------------------------------- colour

  // Of a pixel on the surface: between the short and the long side of what it covers.
  float footprint(const SurfacePoint& s) const {
    const float cosine = std::max(0.1f, s.facet_normal.dot(s.to_eye));
    return (s.point - f_.origin).norm() / (float(f_.view.camera.fx) * std::sqrt(cosine));
  }

  std::uint64_t bits_of(int x, int y, int ray) const {
    return hash(f_.seed, f_.index, std::uint64_t(y) << 20 | std::uint64_t(x), 4000 + ray);
  }

  void shade(int x, int y) {
    Glimpse& g = at(x, y);
    if (g.s.face < 0) return;
    g.color = f_.shader.color(g.s, g.occlusion, footprint(g.s), bits_of(x, y, 0));
  }

  // How many rays along a side two neighbours ask for.
  int grid_between(const Glimpse& a, const Glimpse& b) const {
    if (a.s.face != b.s.face) return kEdgeGrid;
    if (a.s.face < 0) return 1;
    if (a.s.normal.dot(b.s.normal) < 0.98f ||
        std::abs((b.s.point - a.s.point).dot(a.s.facet_normal)) > 0.5f * footprint(a.s))
      return kEdgeGrid;
    const float contrast = ((a.color - b.color).abs() / (0.03f + a.color.max(b.color))).maxCoeff();
    return contrast > 0.2f ? kPrintGrid : contrast > 0.06f ? kGrainGrid : 1;
  }

  void mark(const Box& box) {
    const int steps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x) {
        Glimpse& g = at(x, y);
        if (f_.edges.at(x, y)) g.grid = kEdgeGrid;
        for (const auto& step : steps) {
          if (!box.contains(x + step[0], y + step[1])) continue;
          Glimpse& other = at(x + step[0], y + step[1]);
          const unsigned char grid = static_cast<unsigned char>(grid_between(g, other));
          g.grid = std::max(g.grid, grid);
          other.grid = std::max(other.grid, grid);
        }
      }
  }

  // Light of a ray between pixels' centres: that of the nearest of them on the same surface.
  Occlusion occlusion_near(const SurfacePoint& s, int x, int y) {
    const Glimpse* nearest = nullptr;
    float least = 0;
    for (int v = std::max(y - 1, box_.y0); v < std::min(y + 2, box_.y1); ++v)
      for (int u = std::max(x - 1, box_.x0); u < std::min(x + 2, box_.x1); ++u) {
        const Glimpse& g = at(u, v);
        if (!g.lit || !same_surface(g.s, s)) continue;
        const float d = (g.s.point - s.point).squaredNorm();
        if (nearest && d >= least) continue;
        nearest = &g;
        least = d;
      }
    return nearest ? nearest->occlusion : f_.shader.occlusion(s.point, s.facet_normal);
  }

  // Jittered, so that an edge along the rows of pixels is noisy rather than off.
  void spread(int x, int y) {
    const Glimpse& g = at(x, y);
    static const std::array<float, 9> flat = weights_of_a_grid(kEdgeGrid);
    if (g.grid == 1) {
      add(x, y, flat, 1.0f / (kEdgeGrid * kEdgeGrid), g.color, covers(g.s.face));
      return;
    }
    const int n = g.grid, rays = n * n;
    const Frame::Rays pixel(f_, x, y);
    std::array<Vector3f, kEdgeGrid * kEdgeGrid> directions;
    std::array<Vector2d, kEdgeGrid * kEdgeGrid> places;
    std::array<Hit, kEdgeGrid * kEdgeGrid> hits;
    for (int i = 0; i < rays; ++i) {
      const std::uint64_t r = bits_of(x, y, 100 + i);
      places[i] = {(i % n + uniform(r)) / n - 0.5, (i / n + uniform(mix(r))) / n - 0.5};
      directions[i] = pixel.direction(places[i]);
    }
    f_.world.tracer.cast(f_.origin, directions.data(), rays, hits.data());
    for (int i = 0; i < rays; ++i) {
      const auto weights = weights_of_a_ray(float(places[i].x()), float(places[i].y()));
      add(x, y, weights, 1.0f / float(rays), color_of_ray(hits[i], directions[i], x, y, i),
          covers(hits[i].face));
    }
  }

  bool covers(int face) const { return face >= 0 && f_.shader.is_part(face); }

  Color color_of_ray(const Hit& hit, const Vector3f& direction, int x, int y, int ray) {
    if (hit.face < 0) return Color::Zero();
    const SurfacePoint s = surface_point(hit, direction);
    const Occlusion occlusion =
        f_.shader.shines(s.face) ? Occlusion(Occlusion::Zero()) : occlusion_near(s, x, y);
    return f_.shader.color(s, occlusion, footprint(s), bits_of(x, y, 1000 + ray));
  }

  void add(int x, int y, const std::array<float, 9>& weights, float share, const Color& color,
           bool covered) {
    for (int k = 0; k < 9; ++k) {
      const int u = x + k % 3 - 1, v = y + k / 3 - 1;
      if (!core_.contains(u, v)) continue;
      Sums& sums = sums_.at(u - core_.x0, v - core_.y0);
      const float weight = share * weights[k];
      sums.light += weight * color;
      sums.alpha += covered ? weight : 0.0f;
      sums.weight += weight;
    }
  }

  void gather(Picture* out) const {
    for (int y = core_.y0; y < core_.y1; ++y)
      for (int x = core_.x0; x < core_.x1; ++x) {
        const Sums& sums = sums_.at(x - core_.x0, y - core_.y0);
        out->red.at(x, y) = sums.light[0] / sums.weight;
        out->green.at(x, y) = sums.light[1] / sums.weight;
        out->blue.at(x, y) = sums.light[2] / sums.weight;
        out->alpha.at(x, y) = sums.alpha / sums.weight;
      }
  }

  const Frame& f_;
  Box core_;                 // what is painted
  Box inner_;                // and its neighbours, whose filters reach it
  Box box_;                  // and what is needed to light them
  Image<Glimpse> glimpses_;  // of box_
  Image<Sums> sums_;         // of core_
};

// Marks the pixels about true edges, hidden ones among them.
Image<char> pixels_on_edges(const std::vector<TruthCurve>& edges, const View& view) {
  const Camera& camera = view.camera;
  Image<char> marked(camera.width, camera.height, 0);
  const auto mark = [&](const Eigen::Vector3d& point) {
    double depth;
    Vector2d pixel;
    if (!view.image_pixel(view.project(point, &depth), &pixel) || !(depth > 0)) return;
    const int x = int(std::lround(pixel.x())), y = int(std::lround(pixel.y()));
    if (x >= 0 && y >= 0 && x < camera.width && y < camera.height) marked.at(x, y) = 1;
  };
  for (const TruthCurve& edge : edges)
    for (int i = 1; i < edge.points.cols(); ++i) {
      double depth;
      const Eigen::Vector3d a = edge.points.col(i - 1), b = edge.points.col(i);
      view.project(a, &depth);
      if (!(depth > 1e-3)) continue;
      const int pieces = std::clamp(int(1.5 * camera.fx * (b - a).norm() / depth), 1, 1000);
      for (int k = 0; k <= pieces; ++k) mark(a + (b - a) * (double(k) / pieces));
    }
  return marked;
}

}  // namespace

Picture paint_photo(const PhotoWorld& world, const PhotoShader& shader,
                    const std::vector<TruthCurve>& edges, const View& view, std::uint64_t seed,
                    int index) {
  const int w = view.camera.width, h = view.camera.height;
  const Image<char> on_edges = pixels_on_edges(edges, view);
  const Frame frame{world,
                    shader,
                    view,
                    seed,
                    index,
                    on_edges,
                    view.center_in_world().cast<float>(),
                    view.cam_from_world.rotation.transpose(),
                    w < 2000 ? 8 : 16};
  const Image<float> zero(w, h, 0.0f);
  Picture out{zero, zero, zero, zero};
  const int columns = (w + kTile - 1) / kTile, rows = (h + kTile - 1) / kTile;
  parallel_for(columns * rows, 1, [&](int i) {
    const int x = i % columns * kTile, y = i / columns * kTile;
    Tile(frame, {x, y, std::min(x + kTile, w), std::min(y + kTile, h)}).paint(&out);
  });
  return out;
}

}  // namespace sketchsplat

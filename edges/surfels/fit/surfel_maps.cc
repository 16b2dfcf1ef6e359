// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/types/parallel.h"
#include "edges/surfels/fit/surfel_field.h"

namespace sketchsplat {
namespace {

constexpr float kLeastWeight = 0.02f;  // of a surfel at a pixel that counts
constexpr double kGrazing = 0.05;  // cosine below which a plane says little of the depth at a pixel

// What one surfel shows at one pixel, in the camera's frame.
struct Hit {
  float weight;
  Eigen::Vector3f normal;
  Eigen::Vector3f point;
};

// Which surfels make a pixel: those of pixel p are first[p] .. first[p + 1] - 1.
struct Makers {
  std::vector<int> first, surfel;
  std::vector<float> weight;
};

Makers makers_of(const SurfelInfluence& influence, int pixels) {
  Makers m;
  m.first.assign(pixels + 1, 0);
  for (const int p : influence.pixel) ++m.first[p + 1];
  for (int p = 0; p < pixels; ++p) m.first[p + 1] += m.first[p];
  m.surfel.resize(influence.pixel.size());
  m.weight.resize(influence.pixel.size());
  std::vector<int> next(m.first.begin(), m.first.end() - 1);
  for (size_t s = 0; s + 1 < influence.first.size(); ++s)
    for (int k = influence.first[s]; k < influence.first[s + 1]; ++k) {
      const int to = next[influence.pixel[k]]++;
      m.surfel[to] = int(s);
      m.weight[to] = influence.weight[k];
    }
  return m;
}

// Mean over the hits that lie with the heaviest one on one surface: a blend of all would round
// creases off and put points between near and far.
Hit mode(const std::vector<Hit>& hits, double least_cosine, double reach) {
  Hit best{0, {0, 0, 0}, {0, 0, 0}};
  for (const Hit& h : hits) {
    Hit sum{0, {0, 0, 0}, {0, 0, 0}};
    for (const Hit& o : hits) {
      if (h.normal.dot(o.normal) < least_cosine ||
          std::abs(h.normal.dot(o.point - h.point)) > reach)
        continue;
      sum.weight += o.weight;
      sum.normal += o.weight * o.normal;
      sum.point += o.weight * o.point;
    }
    if (sum.weight > best.weight) best = sum;
  }
  return best;
}

}  // namespace

GeometryMaps render_geometry(const SurfelField& field, const View& view, double mode_deg) {
  SurfelRenderer renderer(field.drawing);
  std::vector<int> facing;
  const SurfelCloud cloud = facing_surfels(field.cloud(), view, &facing);
  const SurfelImages& images = renderer.forward(cloud, view);
  GeometryMaps maps;
  const int w = view.camera.width, h = view.camera.height;
  maps.alpha = images.alpha;
  maps.depth = Image<float>(w, h);
  maps.normal.fill(Image<float>(w, h));
  const int n = cloud.size();
  Eigen::Matrix3Xf normal(3, n), center(3, n);
  for (int i = 0; i < n; ++i) {
    normal.col(i) =
        (view.cam_from_world.rotation * surfel_normal(cloud.rotation.col(i))).cast<float>();
    center.col(i) = (view.cam_from_world * Eigen::Vector3d(cloud.center.col(i))).cast<float>();
  }
  const Makers makers = makers_of(renderer.influence(), w * h);
  const double least = std::cos(mode_deg * M_PI / 180);
  parallel_for(h, 16, [&](int y) {
    std::vector<Hit> hits;
    for (int x = 0; x < w; ++x) {
      const int p = y * w + x;
      if (images.alpha.data[p] < 0.5f) continue;
      const Eigen::Vector3f ray = view.camera.ray({double(x), double(y)}).cast<float>();
      hits.clear();
      for (int k = makers.first[p]; k < makers.first[p + 1]; ++k) {
        const int s = makers.surfel[k];
        if (makers.weight[k] < kLeastWeight) continue;
        const float along = normal.col(s).dot(ray);
        const float z = std::abs(along) > kGrazing * ray.norm()
                            ? normal.col(s).dot(center.col(s)) / along
                            : center(2, s);
        hits.push_back({makers.weight[k], normal.col(s), ray * z});
      }
      const Hit top = mode(hits, mode_deg > 0 ? least : -2, mode_deg > 0 ? field.spacing : 1e30);
      if (!(top.weight > 0) || !(top.normal.norm() > 1e-6f)) continue;
      maps.depth.data[p] = top.point.z() / top.weight;
      const Eigen::Vector3f unit = top.normal.normalized();
      for (int c = 0; c < 3; ++c) maps.normal[c].data[p] = unit[c];
    }
  });
  return maps;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "raster/surfels/surfel.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "datasets/types/parallel.h"
#include "raster/surfels/surfel_footprint.h"
#include "raster/surfels/surfel_tiles.h"

namespace sketchsplat {
namespace {

constexpr int kParallelTiles = 64;  // fewer are done before a second thread has woken up

// Copies the rows of a tile that are in the image, from it or into it.
void load(const Image<float>& image, const SurfelTile& tile, Lanes* rows) {
  if (image.empty()) return;
  const int x = tile.tx * kLanes, y = tile.ty * kLanes;
  const int columns = std::min(kLanes, image.width - x);
  for (int k = 0; k < std::min(kLanes, image.height - y); ++k) {
    std::memcpy(&rows[k], image.row(y + k) + x, columns * sizeof(float));
  }
}

void store(const Lanes* rows, const SurfelTile& tile, Image<float>* image) {
  const int x = tile.tx * kLanes, y = tile.ty * kLanes;
  const int columns = std::min(kLanes, image->width - x);
  for (int k = 0; k < std::min(kLanes, image->height - y); ++k) {
    std::memcpy(image->row(y + k) + x, &rows[k], columns * sizeof(float));
  }
}

void clear(const Camera& camera, Image<float>* image) {
  image->width = camera.width;
  image->height = camera.height;
  image->data.assign(size_t(camera.width) * camera.height, 0.0f);
}

void store_images(const SurfelSums& s, const SurfelTile& tile, SurfelImages* images) {
  Lanes depth[kLanes];
  for (int y = 0; y < kLanes; ++y) depth[y] = s.m[y] + s.origin * s.alpha[y];
  for (int c = 0; c < 3; ++c) {
    store(s.color[c], tile, &images->color[c]);
    store(s.normal[c], tile, &images->normal[c]);
  }
  store(s.alpha, tile, &images->alpha);
  store(depth, tile, &images->depth);
  store(s.median, tile, &images->median_depth);
}

SurfelTileGradient load_gradient(const SurfelImages& by_images, const SurfelTile& tile) {
  SurfelTileGradient g = {};
  for (int c = 0; c < 3; ++c) {
    load(by_images.color[c], tile, g.color[c]);
    load(by_images.normal[c], tile, g.normal[c]);
  }
  load(by_images.alpha, tile, g.alpha);
  load(by_images.depth, tile, g.depth);
  load(by_images.median_depth, tile, g.median);
  return g;
}

// The entries of a footprint, in the order of the tiles.
SurfelFootprintGradient gather(const SurfelBins& bins, int footprint,
                               const std::vector<SurfelEntryGradient>& entries) {
  using G = SurfelEntryGradient;
  double sum[G::kTerms] = {};
  for (int k = bins.first_slot[footprint]; k < bins.first_slot[footprint + 1]; ++k) {
    for (int t = 0; t < G::kTerms; ++t) sum[t] += entries[bins.slots[k]].sum[t];
  }
  SurfelFootprintGradient g;
  g.plane << sum[G::kUx], sum[G::kUy], sum[G::kU], sum[G::kVx], sum[G::kVy], sum[G::kV],
      sum[G::kWx], sum[G::kWy], sum[G::kW];
  g.mean = {sum[G::kMeanX], sum[G::kMeanY]};
  g.depth = sum[G::kDepth];
  g.opacity = sum[G::kOpacity];
  g.skew = {sum[G::kSkewU], sum[G::kSkewV]};
  g.color = {sum[G::kColor0], sum[G::kColor1], sum[G::kColor2]};
  g.normal = {sum[G::kNormal0], sum[G::kNormal1], sum[G::kNormal2]};
  g.in_image_abs = {sum[G::kAbsX], sum[G::kAbsY]};
  g.splitting = {sum[G::kSplitUU], sum[G::kSplitUV], sum[G::kSplitVV]};
  g.weight = sum[G::kWeight];
  return g;
}

void append_weights(const SurfelTile& tile, int width, const float* weights,
                    std::vector<std::pair<int, float>>* list) {
  for (int k = 0; k < Tile::kPixels; ++k) {
    const int x = tile.tx * kLanes + k % kLanes, y = tile.ty * kLanes + k / kLanes;
    if (weights[k] > 0) list->emplace_back(y * width + x, weights[k]);
  }
}

}  // namespace

SurfelCloud SurfelCloud::zero(int n) {
  return {Eigen::Matrix3Xd::Zero(3, n), Eigen::Matrix4Xd::Zero(4, n), Eigen::Matrix2Xd::Zero(2, n),
          Eigen::VectorXd::Zero(n),     Eigen::Matrix3Xd::Zero(3, n), Eigen::Matrix2Xd::Zero(2, n)};
}

SurfelGradient SurfelGradient::zero(int n) {
  return {SurfelCloud::zero(n), Eigen::Matrix2Xd::Zero(2, n), Eigen::Matrix2Xd::Zero(2, n),
          Eigen::Matrix3Xd::Zero(3, n), Eigen::VectorXd::Zero(n)};
}

struct SurfelRenderer::State {
  SurfelOptions options;
  int count = 0;  // surfels of the cloud
  std::vector<SurfelFootprint> footprints;
  SurfelBins bins;
  std::vector<SurfelSums> sums;  // of bins.tiles
  SurfelImages images;
  std::vector<SurfelEntryGradient> entries;  // room for backward
};

SurfelRenderer::SurfelRenderer(const SurfelOptions& options) : state_(new State) {
  assert(options.cutoff >= 2 && options.cutoff <= 6 && options.lowpass_px > 0);
  assert(options.max_alpha > 0 && options.max_alpha < 1 && options.min_cosine > 0);
  assert(options.min_transmittance > 0 && options.min_transmittance < 1);
  assert(options.near >= 0 && options.max_skew >= 0 && options.max_skew <= 4);
  state_->options = options;
}

SurfelRenderer::~SurfelRenderer() = default;
SurfelRenderer::SurfelRenderer(SurfelRenderer&&) noexcept = default;
SurfelRenderer& SurfelRenderer::operator=(SurfelRenderer&&) noexcept = default;

const SurfelImages& SurfelRenderer::forward(const SurfelCloud& cloud, const View& view,
                                            const Image<std::uint8_t>& mask) {
  State& s = *state_;
  assert(mask.empty() || (mask.width == view.camera.width && mask.height == view.camera.height));
  s.count = cloud.size();
  s.footprints = project_surfels(cloud, view, s.options);
  s.bins = bin_surfels(s.footprints, view.camera, mask, s.options);
  for (int c = 0; c < 3; ++c) {
    clear(view.camera, &s.images.color[c]);
    clear(view.camera, &s.images.normal[c]);
  }
  for (Image<float>* image : {&s.images.alpha, &s.images.depth, &s.images.median_depth})
    clear(view.camera, image);
  const SurfelLoop loop(s.options);
  const int tiles = int(s.bins.tiles.size());
  s.sums.resize(tiles);
  parallel_for(tiles, tiles >= kParallelTiles ? 8 : tiles, [&](int t) {
    composite_tile(loop, s.bins.tiles[t], s.bins.entries.data(), s.footprints.data(), &s.sums[t]);
    store_images(s.sums[t], s.bins.tiles[t], &s.images);
  });
  return s.images;
}

void SurfelRenderer::backward(const SurfelCloud& cloud, const View& view,
                              const SurfelImages& by_images, SurfelGradient* gradient) const {
  State& s = *state_;
  assert(cloud.size() == s.count && view.camera.width == s.images.alpha.width);
  const SurfelLoop loop(s.options);
  const int tiles = int(s.bins.tiles.size()), footprints = int(s.footprints.size());
  s.entries.resize(s.bins.entries.size());
  parallel_for(tiles, tiles >= kParallelTiles ? 8 : tiles, [&](int t) {
    const SurfelTile& tile = s.bins.tiles[t];
    composite_tile_backward(loop, tile, s.bins.entries.data(), s.footprints.data(), s.sums[t],
                            load_gradient(by_images, tile), &s.entries[tile.begin]);
  });
  *gradient = SurfelGradient::zero(s.count);
  parallel_for(footprints, tiles >= kParallelTiles ? 256 : footprints, [&](int f) {
    project_surfel_backward(cloud, view, s.options, s.footprints[f], gather(s.bins, f, s.entries),
                            gradient);
  });
}

SurfelInfluence SurfelRenderer::influence() const {
  const State& s = *state_;
  const SurfelLoop loop(s.options);
  std::vector<float> weights(s.bins.entries.size() * Tile::kPixels);
  std::vector<int> tile_of(s.bins.entries.size());
  for (size_t t = 0; t < s.bins.tiles.size(); ++t) {
    const SurfelTile& tile = s.bins.tiles[t];
    tile_weights(loop, tile, s.bins.entries.data(), s.footprints.data(),
                 &weights[size_t(tile.begin) * Tile::kPixels]);
    std::fill(&tile_of[tile.begin], &tile_of[tile.begin] + (tile.end - tile.begin), int(t));
  }
  std::vector<std::vector<std::pair<int, float>>> lists(s.count);
  for (size_t f = 0; f < s.footprints.size(); ++f) {
    auto& list = lists[s.footprints[f].surfel];
    for (int k = s.bins.first_slot[f]; k < s.bins.first_slot[f + 1]; ++k) {
      const int slot = s.bins.slots[k];
      append_weights(s.bins.tiles[tile_of[slot]], s.images.alpha.width,
                     &weights[size_t(slot) * Tile::kPixels], &list);
    }
    std::sort(list.begin(), list.end());
  }
  SurfelInfluence influence;
  influence.first.push_back(0);
  for (const auto& list : lists) {
    for (const auto& [pixel, weight] : list) {
      influence.pixel.push_back(pixel);
      influence.weight.push_back(weight);
    }
    influence.first.push_back(int(influence.pixel.size()));
  }
  return influence;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "raster/splats/render.h"

#include <algorithm>
#include <cassert>

#include "datasets/types/parallel.h"
#include "raster/splats/tiles.h"

namespace sketchsplat {
namespace {

void add_to(const SplatGradient& g, SplatGradient* sum) {
  sum->mean += g.mean;
  sum->tangent += g.tangent;
  sum->along += g.along;
  sum->across += g.across;
  sum->opacity += g.opacity;
}

}  // namespace

Image<float> render(const Splats& splats, const Eigen::Ref<const Eigen::VectorXf>& visibility,
                    const View& view, const RasterOptions& options) {
  assert(visibility.size() == 0 || visibility.size() == splats.size());
  const auto footprints = project_splats(splats, visibility, view, options);
  TouchedTiles tiles = accumulate_depth(view.camera, footprints, options);
  expose(&tiles);
  Image<float> image(view.camera.width, view.camera.height);
  for (size_t s = 0; s < tiles.tiles.size(); ++s) {
    const int x = tiles.touched[s] % tiles.tiles_x * Tile::kSide;
    const int y = tiles.touched[s] / tiles.tiles_x * Tile::kSide;
    const int columns = std::min(Tile::kSide, image.width - x);
    for (int row = 0; row < std::min(Tile::kSide, image.height - y); ++row) {
      std::copy_n(tiles.tiles[s].value + row * Tile::kSide, columns, image.row(y + row) + x);
    }
  }
  return image;
}

double render_loss(const Splats& splats, const Eigen::Ref<const Eigen::VectorXf>& visibility,
                   const View& view, const EdgeTarget& target, const RasterOptions& options,
                   SplatGradient* gradient) {
  assert(visibility.size() == 0 || visibility.size() == splats.size());
  assert(target.width == view.camera.width && target.height == view.camera.height);
  const auto footprints = project_splats(splats, visibility, view, options);
  TouchedTiles tiles = accumulate_depth(view.camera, footprints, options);
  const double loss = compare(target, &tiles);
  if (gradient) {
    *gradient = SplatGradient::zero(splats.size());
    project_splats_backward(splats, visibility, view, footprints,
                            gather_gradients(tiles, footprints, options), gradient);
  }
  return loss;
}

Eigen::VectorXd render_loss_views(const Splats& splats, const Eigen::MatrixXf& visibility,
                                  const std::vector<View>& views,
                                  const std::vector<EdgeTarget>& targets,
                                  const RasterOptions& options, SplatGradient* gradient) {
  // Gradients wait in one slot per view to be summed in order; groups bound the memory for them.
  constexpr int kGroup = 64;
  assert(views.size() == targets.size());
  assert(visibility.size() == 0 || visibility.cols() == Eigen::Index(views.size()));
  const Eigen::VectorXf all_visible;
  const int count = int(views.size());
  Eigen::VectorXd losses(count);
  if (gradient) *gradient = SplatGradient::zero(splats.size());
  std::vector<SplatGradient> slots(gradient ? std::min(count, kGroup) : 0);
  for (int begin = 0; begin < count; begin += kGroup) {
    const int end = std::min(begin + kGroup, count);
    parallel_for(end - begin, 1, [&](int k) {
      const int i = begin + k;
      SplatGradient* slot = gradient ? &slots[k] : nullptr;
      losses[i] = visibility.size()
                      ? render_loss(splats, visibility.col(i), views[i], targets[i], options, slot)
                      : render_loss(splats, all_visible, views[i], targets[i], options, slot);
    });
    for (int i = begin; gradient && i < end; ++i) add_to(slots[i - begin], gradient);
  }
  return losses;
}

}  // namespace sketchsplat

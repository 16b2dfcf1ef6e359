// SPDX-License-Identifier: MIT
#include "datasets/readers/smaller_pictures.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {

Eigen::Vector2d shrunk(const Eigen::Vector2d& pixel, int denominator) {
  return (pixel.array() + 0.5) / denominator - 0.5;
}

Scene with_smaller_pictures(const Scene& scene, int least_side) {
  Scene out = scene;
  std::vector<int> factors;
  for (View& view : out.views) {
    const int longer = std::max(view.camera.width, view.camera.height);
    const int factor = least_side > 0 ? std::max(1, longer / least_side) : 1;
    factors.push_back(factor);
    if (factor < 2) continue;
    const View full = view;
    view.make_picture = [full, factor] { return read_picture(full, factor); };
    view.mask_path.clear();  // the picture has it
    view.camera = full.camera.shrunk(factor);
  }
  for (ScenePoint& point : out.points)
    for (PointSight& sight : point.sights) sight.pixel = shrunk(sight.pixel, factors[sight.view]);
  return out;
}

std::vector<int> places_in(const Scene& scene, const std::vector<View>& views) {
  std::vector<int> places;
  size_t i = 0;
  for (const View& view : views) {
    while (scene.views.at(i).name != view.name || scene.views[i].image_path != view.image_path) ++i;
    places.push_back(int(i++));
  }
  return places;
}

std::vector<View> at_full_size(const std::vector<View>& views, const Scene& smaller,
                               const Scene& scene) {
  std::vector<View> out;
  const std::vector<int> places = places_in(smaller, views);
  for (size_t v = 0; v < views.size(); ++v) {
    const View& from = views[v];
    View view = scene.views.at(places[v]);
    const int factor = int(std::lround(view.camera.fx / smaller.views[places[v]].camera.fx));
    view.camera = from.camera.enlarged(factor, view.camera.width, view.camera.height);
    view.cam_from_world = from.cam_from_world;
    view.lens = from.lens;
    out.push_back(std::move(view));
  }
  return out;
}

}  // namespace sketchsplat

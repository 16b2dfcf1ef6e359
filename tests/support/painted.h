// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "edges/views/lift.h"

namespace sketchsplat::test {

/// Grey level (0 to 255) that a ray from an eye meets, in world coordinates, in a view.
using Paint =
    std::function<double(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray, int view)>;

/// Pictures of 400 x 400 px with noise (its standard deviation in grey levels), without edgels.
inline EdgeWorld painted(const std::vector<View>& views, double footprint, const Paint& paint,
                         double noise, int seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> grain(0, noise);
  EdgeWorld world;
  world.footprint = footprint;
  for (const View& view : views) {
    const Eigen::Vector3d eye = view.center_in_world();
    auto part = std::make_shared<GreyPart>();
    part->value = Image<uint16_t>(400, 400);
    for (int y = 0; y < 400; ++y)
      for (int x = 0; x < 400; ++x) {
        const Eigen::Vector3d ray =
            view.cam_from_world.rotation.transpose() * view.camera.ray(Eigen::Vector2d(x, y));
        const double level = std::round(paint(eye, ray, int(world.views.size())) + grain(rng));
        part->value.at(x, y) = uint16_t(std::clamp(level, 0.0, 255.0) / 255 * GreyPart::kOne);
      }
    EdgelMap map;
    map.width = map.height = 400;
    map.noise = float(noise / 255);
    map.chain = {0};
    map.grey = part;
    world.views.push_back(view);
    world.maps.push_back(map);
    world.plane_normal.emplace_back(3, 0);
  }
  return world;
}

}  // namespace sketchsplat::test

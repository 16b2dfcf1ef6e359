// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <random>

#include "raster/splats/render.h"

namespace sketchsplat {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline const Eigen::VectorXf kAllVisible;

/// A turned camera over the origin, 4 units away; 1 px is 0.05 units there. Sizes are no multiple
/// of 8.
inline View test_view(int width = 45, int height = 35) {
  View view;
  view.camera = {width, height, 80.0, 78.0, (width - 1) / 2.0 + 0.3, (height - 1) / 2.0};
  view.cam_from_world.rotation =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  view.cam_from_world.translation = {0.05, -0.02, 4};
  return view;
}

/// Thin and round splats of 0.8 to 3 px, some of them across the border of the image.
inline Splats test_splats(int count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Splats s = Splats::zero(count);
  for (int i = 0; i < count; ++i) {
    s.mean.col(i) << uniform(random), uniform(random), uniform(random);
    s.tangent.col(i) =
        Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    s.along[i] = 0.1 + 0.05 * uniform(random);
    s.across[i] = 0.05 + 0.01 * uniform(random);
    s.opacity[i] = 0.8 + 0.5 * uniform(random);
  }
  return s;
}

inline Splats one_splat(const Eigen::Vector3d& mean) {
  Splats s = Splats::zero(1);
  s.mean.col(0) = mean;
  s.tangent.col(0) = Eigen::Vector3d::UnitX();
  s.along[0] = 0.1;
  s.across[0] = 0.05;
  s.opacity[0] = 1;
  return s;
}

/// Every field of a gradient in one column, for comparisons.
inline Eigen::VectorXd flatten(const SplatGradient& g) {
  Eigen::VectorXd all(9 * g.size());
  all << g.mean.reshaped(), g.tangent.reshaped(), g.along, g.across, g.opacity;
  return all;
}

/// An edge image that no rendering fits: waves between 0 and 1.
inline Image<float> test_edges(const View& view) {
  Image<float> edges(view.camera.width, view.camera.height);
  for (int y = 0; y < edges.height; ++y) {
    for (int x = 0; x < edges.width; ++x) {
      edges.at(x, y) = float(std::max(0.0, std::sin(0.4 * x) * std::cos(0.3 * y + 1)));
    }
  }
  return edges;
}

}  // namespace sketchsplat

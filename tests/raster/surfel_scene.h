// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <random>
#include <string>

#include "scene.h"
#include "tests/raster/surfel_reference.h"

namespace sketchsplat {

/// Surfels of 0.6 to 5 px in test_view, turned at random, some of them across the border.
inline SurfelCloud test_cloud(int count, unsigned seed = 1, double spread = 0.6) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SurfelCloud c = SurfelCloud::zero(count);
  const auto fill = [&](auto&& column, double scale, double shift) {
    for (int k = 0; k < column.size(); ++k) column[k] = shift + scale * uniform(random);
  };
  for (int i = 0; i < count; ++i) {
    fill(c.center.col(i), spread, 0);
    fill(c.rotation.col(i), 1, 0);
    fill(c.log_scale.col(i), 0.9, std::log(0.08));
    c.opacity[i] = 2 * uniform(random);
    fill(c.color.col(i), 0.7, 0.4);
    fill(c.skew.col(i), 0.8, 0);
  }
  return c;
}

/// One surfel in the middle of the world that faces the camera of test_view.
inline SurfelCloud facing_cloud(double sigma) {
  SurfelCloud c = test_cloud(1);
  const Eigen::Quaterniond q(Eigen::Matrix3d(test_view().cam_from_world.rotation.transpose()));
  c.center.setZero();
  c.rotation.col(0) << q.w(), q.x(), q.y(), q.z();
  c.log_scale.setConstant(std::log(sigma));
  return c;
}

inline SurfelOptions test_options(SurfelKernel kernel = SurfelKernel::kGaussian) {
  SurfelOptions options;
  options.kernel = kernel;
  return options;
}

inline SurfelCloud select(const SurfelCloud& c, const std::vector<int>& order) {
  return {c.center(Eigen::all, order),    c.rotation(Eigen::all, order),
          c.log_scale(Eigen::all, order), c.opacity(order),
          c.color(Eigen::all, order),     c.skew(Eigen::all, order)};
}

/// The images, in one fixed order.
template <typename Images>
auto channels(Images& i) -> std::vector<decltype(&i.alpha)> {
  return {&i.color[0],  &i.color[1], &i.color[2], &i.normal[0],   &i.normal[1],
          &i.normal[2], &i.alpha,    &i.depth,    &i.median_depth};
}

template <typename T>
Eigen::Matrix<T, 9, 1> channels(const ReferenceSurfelPixel<T>& p) {
  Eigen::Matrix<T, 9, 1> all;
  all << p.color, p.normal, p.alpha, p.depth, p.median_depth;
  return all;
}

/// Gradients by the images that no rendering explains: waves, another one in each image.
inline SurfelImages test_image_gradients(const View& view) {
  SurfelImages g;
  double phase = 0;
  for (Image<float>* image : channels(g)) {
    *image = Image<float>(view.camera.width, view.camera.height);
    phase += 1.3;
    for (int y = 0; y < image->height; ++y) {
      for (int x = 0; x < image->width; ++x) {
        image->at(x, y) = float(std::sin(0.5 * x + phase) * std::cos(0.4 * y - 2 * phase));
      }
    }
  }
  return g;
}

/// All fields of surfel i that are parameters: center, rotation, log_scale, opacity, color, skew.
template <typename Cloud>
Eigen::Matrix<double, 15, 1> parameters(const Cloud& c, int i) {
  Eigen::Matrix<double, 15, 1> all;
  all << c.center.col(i), c.rotation.col(i), c.log_scale.col(i), c.opacity[i], c.color.col(i),
      c.skew.col(i);
  return all;
}

/// sum of gradient times image over all pixels of all images, by the reference.
inline double reference_value(const SurfelCloud& cloud, const View& view,
                              const SurfelImages& by_images, const SurfelOptions& options) {
  std::vector<ReferenceSurfel<double>> surfels;
  std::vector<ReferenceDisk<double>> disks;
  for (int i = 0; i < cloud.size(); ++i) {
    surfels.push_back(reference_surfel<double>(cloud, i));
    disks.push_back(reference_disk(surfels.back(), view, options));
  }
  double value = 0;
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      const auto pixel = channels(reference_surfel_pixel(surfels, disks, view, x, y, options));
      const auto by = channels(by_images);
      for (int k = 0; k < 9; ++k) value += by[k]->at(x, y) * pixel[k];
    }
  }
  return value;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// surfel_bench: time of one view, forward and backward, on the load of a detector that fits an
// object: 3,000 surfels on a sphere that covers a quarter of 400 x 400 pixels, the far side hidden
// by the near one. Prints one number per line.
#include <omp.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "raster/splats/bench_time.h"
#include "raster/surfels/surfel.h"

namespace sketchsplat {
namespace {

constexpr int kSize = 400;
constexpr double kFocal = 555, kDepth = 4;

View bench_view() {
  View view;
  view.camera = {kSize, kSize, kFocal, kFocal, (kSize - 1) / 2.0, (kSize - 1) / 2.0};
  view.cam_from_world.translation = {0, 0, kDepth};
  return view;
}

// Radius in pixels of a disk of a quarter of the image.
double radius_px() { return std::sqrt(0.25 * kSize * kSize / 3.14159265); }

SurfelCloud bench_cloud(int count) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  SurfelCloud cloud = SurfelCloud::zero(count);
  const double radius = radius_px() * kDepth / kFocal;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    cloud.center.col(i) = radius * n;
    // Turns z to n.
    cloud.rotation.col(i) << 1 + n.z(), -n.y(), n.x(), 0;
    for (int k = 0; k < 2; ++k)
      cloud.log_scale(k, i) = std::log(2.2 * kDepth / kFocal) + 0.3 * normal(random);
    cloud.opacity[i] = normal(random);
    cloud.color.col(i) << 0.5 + 0.5 * n.x(), 0.5 + 0.5 * n.y(), 0.5;
    cloud.skew.col(i) << 0.5 * normal(random), 0.5 * normal(random);
  }
  return cloud;
}

Image<std::uint8_t> bench_mask() {
  Image<std::uint8_t> mask(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      mask.at(x, y) = std::hypot(x - (kSize - 1) / 2.0, y - (kSize - 1) / 2.0) < radius_px() + 2;
    }
  }
  return mask;
}

void run(const char* name, SurfelKernel kernel, int threads) {
  omp_set_num_threads(threads);
  SurfelOptions options;
  options.kernel = kernel;
  const View view = bench_view();
  const SurfelCloud cloud = bench_cloud(3000);
  const Image<std::uint8_t> mask = bench_mask();
  SurfelRenderer renderer(options);
  const SurfelImages by_images = renderer.forward(cloud, view, mask);
  const double pairs = double(renderer.influence().pixel.size());
  SurfelGradient gradient;
  const double forward = milliseconds(100, [&] { renderer.forward(cloud, view, mask); });
  const double backward =
      milliseconds(100, [&] { renderer.backward(cloud, view, by_images, &gradient); });
  std::printf("%s, %d thread%s\n", name, threads, threads == 1 ? "" : "s");
  std::printf("  drawn pairs of pixel and surfel %.0f\n", pairs);
  std::printf("  forward                         %.2f ms\n", forward);
  std::printf("  backward                        %.2f ms\n", backward);
  std::printf("  pairs per second, both          %.1f M\n", pairs / (forward + backward) / 1e3);
}

}  // namespace
}  // namespace sketchsplat

int main() {
  using sketchsplat::SurfelKernel;
  const int threads = omp_get_max_threads();
  sketchsplat::run("Gaussian", SurfelKernel::kGaussian, 1);
  sketchsplat::run("skew normal", SurfelKernel::kSkewNormal, 1);
  if (threads > 1) sketchsplat::run("Gaussian", SurfelKernel::kGaussian, threads);
}

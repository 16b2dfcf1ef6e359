// SPDX-License-Identifier: MIT
// raster_bench: time of one view, forward and backward, on the load of a typical scene: 3,000
// splats every 2 px along random segments in 800 x 800 pixels. Prints one number per line.
#include <cmath>
#include <cstdio>
#include <random>

#include "raster/splats/bench_time.h"
#include "raster/splats/reference.h"
#include "raster/splats/render.h"

namespace sketchsplat {
namespace {

View bench_view() {
  View view;
  view.camera = {800, 800, 1111.0, 1111.0, 399.5, 399.5};
  view.cam_from_world.translation = {0, 0, 4};
  return view;
}

// One pixel is 4 / 1111 at the depth of the object.
Splats bench_splats(int count) {
  const double px = 4.0 / 1111;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  Splats s = Splats::zero(count);
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), step = Eigen::Vector3d::UnitX();
  for (int i = 0; i < count; ++i) {
    if (i % 60 == 0) {
      from = {uniform(random), uniform(random), uniform(random)};
      step =
          Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized() * 2 * px;
    }
    s.mean.col(i) = from + (i % 60) * step;
    s.tangent.col(i) = step.normalized();
    s.along[i] = 1.5 * px;
    s.across[i] = 1.0 * px;
    s.opacity[i] = 1;
  }
  return s;
}

double covered_pixels(const std::vector<Footprint>& footprints) {
  double pixels = 0;
  for (const Footprint& f : footprints) pixels += double(f.x1 - f.x0 + 1) * (f.y1 - f.y0 + 1);
  return pixels;
}

void run() {
  const RasterOptions options;
  const View view = bench_view();
  const Splats splats = bench_splats(3000);
  const Eigen::VectorXf all;
  Splats truth = splats;
  truth.mean.colwise() += Eigen::Vector3d(2e-3, 1e-3, 0);
  const Image<float> edges = render(truth, all, view, options);
  const EdgeTarget target = make_edge_target(edges, LossOptions());
  SplatGradient gradient;

  const auto footprints = project_splats(splats, all, view, options);
  const double pixels = covered_pixels(footprints);
  const double project = milliseconds(200, [&] { project_splats(splats, all, view, options); });
  const double forward =
      milliseconds(200, [&] { render_loss(splats, all, view, target, options, nullptr); });
  const double both =
      milliseconds(200, [&] { render_loss(splats, all, view, target, options, &gradient); });
  std::printf("splats drawn               %zu\n", footprints.size());
  std::printf("splat pixels               %.0f\n", pixels);
  std::printf("projection                 %.3f ms\n", project);
  std::printf("forward and loss           %.3f ms\n", forward);
  std::printf("forward, loss, backward    %.3f ms\n", both);
  std::printf("per splat                  %.0f ns\n", both * 1e6 / footprints.size());
  std::printf("splat pixels per second    %.0f M\n", pixels / both / 1e3);

  const std::vector<View> views(50, view);
  const std::vector<EdgeTarget> targets(50, target);
  const double batch =
      milliseconds(10, [&] { render_loss_views(splats, {}, views, targets, options, &gradient); });
  std::printf("50 views, all threads      %.1f ms\n", batch);

  const Splats few = bench_splats(60);
  SplatGradient slow_gradient;
  const double slow = milliseconds(
      1, [&] { reference_loss(few, all, view, edges, target.options, options, &slow_gradient); });
  const double fast =
      milliseconds(50, [&] { render_loss(few, all, view, target, options, &gradient); });
  std::printf("reference / fast, 60 splats %.0f\n", slow / fast);
}

}  // namespace
}  // namespace sketchsplat

int main() { sketchsplat::run(); }

// SPDX-License-Identifier: MIT
#include "raster/splats/render.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "scene.h"

namespace sketchsplat {
namespace {

Splats permuted(const Splats& s, const std::vector<int>& order) {
  Splats p;
  p.mean = s.mean(Eigen::all, order);
  p.tangent = s.tangent(Eigen::all, order);
  p.along = s.along(order);
  p.across = s.across(order);
  p.opacity = s.opacity(order);
  return p;
}

double largest_difference(const Image<float>& a, const Image<float>& b) {
  double largest = 0;
  for (size_t k = 0; k < a.data.size(); ++k) {
    largest = std::max(largest, double(std::abs(a.data[k] - b.data[k])));
  }
  return largest;
}

// A straight edge of `count` splats along world x; `shift` moves it along world y.
Splats line(int count, double spacing, double shift) {
  Splats s = Splats::zero(count);
  for (int i = 0; i < count; ++i) s.mean.col(i) << (i - (count - 1) / 2.0) * spacing, shift, 0;
  s.tangent.row(0).setOnes();
  s.along.setConstant(0.75 * spacing);
  s.across.setConstant(0.5 * spacing);
  s.opacity.setOnes();
  return s;
}

View straight_view() {
  View view;
  view.camera = {64, 48, 100, 100, 31.5, 23.5};
  view.cam_from_world.translation = {0, 0, 5};  // 1 px is 0.05
  return view;
}

TEST(Render, EmptySplatsAreBlack) {
  const Image<float> image = render(Splats::zero(0), kAllVisible, test_view(), {});
  EXPECT_EQ(image.data, std::vector<float>(45 * 35, 0.0f));
}

TEST(Render, EmptySplatsLoseWhatTheEdgesWeigh) {
  const View view = test_view();
  const EdgeTarget target = make_edge_target(test_edges(view));
  SplatGradient gradient;
  EXPECT_EQ(render_loss(Splats::zero(0), kAllVisible, view, target, {}, &gradient),
            target.empty_loss);
  EXPECT_EQ(gradient.size(), 0);
  EXPECT_GT(target.empty_loss, 0);
}

TEST(Render, ImageOfNoPixelsIsEmpty) {
  const View view = test_view(0, 0);
  SplatGradient gradient;
  EXPECT_TRUE(render(test_splats(5), kAllVisible, view, {}).empty());
  EXPECT_EQ(render_loss(test_splats(5), kAllVisible, view, make_edge_target({}), {}, &gradient), 0);
  EXPECT_EQ(flatten(gradient).norm(), 0);
}

TEST(Render, PeakIsOneMinusExpOfTheOpacity) {
  View view = straight_view();
  view.camera.cx = 31;
  view.camera.cy = 23;
  const Image<float> image = render(one_splat({0, 0, 0}), kAllVisible, view, {});
  EXPECT_NEAR(image.at(31, 23), 1 - std::exp(-1.0), 1e-6);
  EXPECT_EQ(image.at(0, 0), 0);
}

TEST(Render, VeryOpaqueSplatsSaturateWithoutOverflow) {
  Splats splats = test_splats(20);
  splats.opacity.setConstant(1e6);
  const View view = test_view();
  SplatGradient gradient;
  const Image<float> image = render(splats, kAllVisible, view, {});
  EXPECT_EQ(*std::max_element(image.data.begin(), image.data.end()), 1.0f);
  EXPECT_EQ(std::count_if(image.data.begin(), image.data.end(),
                          [](float v) { return !(v >= 0 && v <= 1); }),
            0);
  render_loss(splats, kAllVisible, view, make_edge_target(test_edges(view)), {}, &gradient);
  EXPECT_TRUE(flatten(gradient).allFinite());
}

TEST(Render, OrderOfTheSplatsChangesNothingBeyondRounding) {
  const View view = test_view();
  const Splats splats = test_splats(50);
  std::vector<int> order(50);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  const Splats other = permuted(splats, order);
  EXPECT_LT(largest_difference(render(splats, kAllVisible, view, {}),
                               render(other, kAllVisible, view, {})),
            1e-6);
  const EdgeTarget target = make_edge_target(test_edges(view));
  SplatGradient a, b;
  const double loss = render_loss(splats, kAllVisible, view, target, {}, &a);
  EXPECT_NEAR(render_loss(other, kAllVisible, view, target, {}, &b), loss, 1e-7 * loss);
  EXPECT_LT((flatten(permuted(a, order)) - flatten(b)).norm(), 1e-5 * flatten(b).norm());
}

TEST(Render, MovingCameraAndWorldTogetherChangesNothing) {
  View view = test_view();
  Splats splats = test_splats(30);
  const EdgeTarget target = make_edge_target(test_edges(view));
  SplatGradient a, b;
  const double loss = render_loss(splats, kAllVisible, view, target, {}, &a);
  const Eigen::Vector3d shift(0.75, -2.5, 1.25);
  splats.mean.colwise() += shift;
  view.cam_from_world.translation -= view.cam_from_world.rotation * shift;
  EXPECT_NEAR(render_loss(splats, kAllVisible, view, target, {}, &b), loss, 1e-7 * loss);
  EXPECT_LT((flatten(a) - flatten(b)).norm(), 1e-5 * flatten(a).norm());
}

TEST(Render, ScalingCameraAndWorldTogetherChangesNothing) {
  View view = test_view();
  Splats splats = test_splats(30);
  const Image<float> before = render(splats, kAllVisible, view, {});
  for (const double scale : {1e-3, 1e3}) {
    Splats scaled = splats;
    scaled.mean *= scale;
    scaled.along *= scale;
    scaled.across *= scale;
    View moved = view;
    moved.cam_from_world.translation *= scale;
    EXPECT_LT(largest_difference(before, render(scaled, kAllVisible, moved, {})), 1e-5);
  }
}

TEST(Render, HiddenSplatHasNoEffectAndNoGradient) {
  const View view = test_view();
  const Splats all = test_splats(10);
  Eigen::VectorXf visibility = Eigen::VectorXf::Ones(10);
  visibility[4] = 0;
  std::vector<int> rest = {0, 1, 2, 3, 5, 6, 7, 8, 9};
  const Splats without = permuted(all, rest);
  EXPECT_EQ(render(all, visibility, view, {}).data, render(without, kAllVisible, view, {}).data);
  const EdgeTarget target = make_edge_target(test_edges(view));
  SplatGradient a, b;
  EXPECT_EQ(render_loss(all, visibility, view, target, {}, &a),
            render_loss(without, kAllVisible, view, target, {}, &b));
  EXPECT_EQ(flatten(permuted(a, {4})).norm(), 0);
  EXPECT_EQ(flatten(permuted(a, rest)), flatten(b));
}

TEST(Render, LossOfThePictureAgainstItselfIsZero) {
  const View view = test_view();
  const Splats splats = test_splats(20);
  const EdgeTarget target = make_edge_target(render(splats, kAllVisible, view, {}));
  SplatGradient gradient;
  EXPECT_NEAR(render_loss(splats, kAllVisible, view, target, {}, &gradient) / target.empty_loss, 0,
              1e-6);
  EXPECT_LT(flatten(gradient).norm(), 1e-6 * target.empty_loss);
}

TEST(Render, ViewsTogetherAreTheSumOfTheViewsAndTheSameBytesForAnyThreads) {
  const Splats splats = test_splats(40);
  std::vector<View> views;
  std::vector<EdgeTarget> targets;
  for (int i = 0; i < 70; ++i) {
    View view = test_view();
    view.cam_from_world.rotation *=
        Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    targets.push_back(make_edge_target(test_edges(view)));
    views.push_back(view);
  }
  Eigen::MatrixXf visibility = Eigen::MatrixXf::Constant(40, 70, 0.5f);
  visibility.row(3).setZero();
  const int threads = omp_get_max_threads();
  SplatGradient one, two;
  omp_set_num_threads(1);
  const Eigen::VectorXd loss = render_loss_views(splats, visibility, views, targets, {}, &one);
  omp_set_num_threads(2);
  const Eigen::VectorXd other = render_loss_views(splats, visibility, views, targets, {}, &two);
  omp_set_num_threads(threads);
  EXPECT_EQ(0, std::memcmp(loss.data(), other.data(), sizeof(double) * 70));
  const Eigen::VectorXd a = flatten(one), b = flatten(two);
  EXPECT_EQ(0, std::memcmp(a.data(), b.data(), sizeof(double) * a.size()));

  Eigen::VectorXd sum = Eigen::VectorXd::Zero(a.size());
  for (int i = 0; i < 70; ++i) {
    SplatGradient g;
    EXPECT_EQ(loss[i], render_loss(splats, visibility.col(i), views[i], targets[i], {}, &g));
    sum += flatten(g);
  }
  EXPECT_LT((sum - a).norm(), 1e-13 * a.norm());
}

TEST(Render, NoViewsHaveNoLoss) {
  SplatGradient gradient;
  EXPECT_EQ(render_loss_views(test_splats(3), {}, {}, {}, {}, &gradient).size(), 0);
  EXPECT_EQ(flatten(gradient), Eigen::VectorXd::Zero(27));
}

// One unknown, the shift of a line across itself; steps against the gradient, halved when it turns.
TEST(Render, DescentRecoversTheShiftOfALine) {
  const View view = straight_view();
  const double px = 0.05, truth = 0.37 * px;
  const EdgeTarget target =
      make_edge_target(render(line(20, 2 * px, truth), kAllVisible, view, {}));
  double shift = truth - 1.33 * px, step = 0.2 * px, first = 0, last = 0, slope_before = 0;
  for (int i = 0; i < 30; ++i) {
    SplatGradient gradient;
    last = render_loss(line(20, 2 * px, shift), kAllVisible, view, target, {}, &gradient);
    if (i == 0) first = last;
    const double slope = gradient.mean.row(1).sum();
    if (slope * slope_before < 0) step /= 2;
    shift -= slope > 0 ? step : -step;
    slope_before = slope;
  }
  EXPECT_LT(last, 0.01 * first);
  EXPECT_LT(std::abs(shift - truth) / px, 0.05);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "raster/surfels/surfel.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "raster/surfels/surfel_tiles.h"
#include "surfel_scene.h"

namespace sketchsplat {
namespace {

class Surfels : public testing::TestWithParam<SurfelKernel> {};
INSTANTIATE_TEST_SUITE_P(Both, Surfels,
                         testing::Values(SurfelKernel::kGaussian, SurfelKernel::kSkewNormal));

SurfelImages render_surfels(const SurfelCloud& cloud, const View& view,
                            const SurfelOptions& options = {},
                            const Image<std::uint8_t>& mask = {}) {
  return SurfelRenderer(options).forward(cloud, view, mask);
}

double largest_difference(const SurfelImages& a, const SurfelImages& b) {
  double largest = 0;
  for (int k = 0; k < 9; ++k) {
    const auto &x = channels(a)[k]->data, &y = channels(b)[k]->data;
    EXPECT_EQ(x.size(), y.size());
    for (size_t i = 0; i < x.size(); ++i) {
      largest = std::max(largest, double(std::abs(x[i] - y[i])));
    }
  }
  return largest;
}

void expect_same_bytes(const SurfelImages& a, const SurfelImages& b) {
  for (int k = 0; k < 9; ++k) {
    const auto &x = channels(a)[k]->data, &y = channels(b)[k]->data;
    ASSERT_EQ(x.size(), y.size());
    EXPECT_EQ(0, std::memcmp(x.data(), y.data(), x.size() * sizeof(float))) << "image " << k;
  }
}

Eigen::VectorXd flatten(const SurfelGradient& g) {
  Eigen::VectorXd all(23 * g.size());
  all << g.center.reshaped(), g.rotation.reshaped(), g.log_scale.reshaped(), g.opacity,
      g.color.reshaped(), g.skew.reshaped(), g.in_image.reshaped(), g.in_image_abs.reshaped(),
      g.splitting.reshaped(), g.weight;
  return all;
}

bool same_bytes(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && 0 == std::memcmp(a.data(), b.data(), a.size() * sizeof(double));
}

void expect_reference(const SurfelCloud& cloud, const View& view, const SurfelOptions& options) {
  const SurfelImages images = render_surfels(cloud, view, options);
  std::vector<ReferenceSurfel<double>> surfels;
  std::vector<ReferenceDisk<double>> disks;
  for (int i = 0; i < cloud.size(); ++i) {
    surfels.push_back(reference_surfel<double>(cloud, i));
    disks.push_back(reference_disk(surfels.back(), view, options));
  }
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      const auto expected = channels(reference_surfel_pixel(surfels, disks, view, x, y, options));
      for (int k = 0; k < 9; ++k) {
        ASSERT_NEAR(channels(images)[k]->at(x, y), expected[k], 1e-4)
            << "image " << k << " at " << x << ", " << y;
      }
    }
  }
}

TEST_P(Surfels, ForwardIsTheReference) {
  expect_reference(test_cloud(60), test_view(), test_options(GetParam()));
}

TEST_P(Surfels, ForwardOfManyLayersIsTheReference) {
  SurfelCloud cloud = test_cloud(100, 2, 0.3);
  cloud.opacity.array() += 2;
  expect_reference(cloud, test_view(29, 23), test_options(GetParam()));
}

TEST_P(Surfels, ForwardOfLongThinSurfelsIsTheReference) {
  SurfelCloud cloud = test_cloud(30, 7);
  cloud.log_scale.row(0).setConstant(std::log(0.7));
  cloud.log_scale.row(1).setConstant(std::log(0.02));
  expect_reference(cloud, test_view(), test_options(GetParam()));
}

TEST_P(Surfels, ForwardOfEdgeOnAndTinyAndOpaqueSurfelsIsTheReference) {
  SurfelCloud cloud = test_cloud(12, 4);
  const View view = test_view();
  for (int i = 0; i < 4; ++i) {  // the normal across the ray to the centre, exactly or nearly
    const Eigen::Vector3d ray = cloud.center.col(i) - view.center_in_world();
    const Eigen::Vector3d normal =
        ray.cross(Eigen::Vector3d::UnitX()).normalized() + i * 1e-3 * ray.normalized();
    const auto q = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    cloud.rotation.col(i) << q.w(), q.x(), q.y(), q.z();
  }
  cloud.log_scale.middleCols(4, 2).setConstant(-12);
  cloud.log_scale.middleCols(6, 2).setConstant(-60);
  cloud.opacity.tail(4).setConstant(30);
  expect_reference(cloud, view, test_options(GetParam()));
}

TEST(Surfels, NothingIsDrawnBehindOrThroughTheCameraOrNotFinite) {
  View view = test_view();
  SurfelCloud cloud = facing_cloud(0.2);
  const SurfelImages black = render_surfels(SurfelCloud::zero(0), view);
  EXPECT_GT(render_surfels(cloud, view).alpha.at(22, 17), 0.1);
  const auto without = [&](const SurfelCloud& bad) {
    expect_same_bytes(render_surfels(bad, view), black);
    SurfelRenderer renderer({});
    SurfelGradient gradient;
    renderer.forward(bad, view);
    renderer.backward(bad, view, test_image_gradients(view), &gradient);
    EXPECT_TRUE(flatten(gradient).isZero(0));
  };
  SurfelCloud behind = cloud;
  behind.center.col(0) = 2 * view.center_in_world();
  without(behind);
  SurfelCloud around = cloud;
  around.center.col(0) = view.center_in_world();
  without(around);
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    SurfelCloud broken = cloud;
    broken.center(1, 0) = bad;
    without(broken);
    broken = cloud;
    broken.log_scale(0, 0) = bad;
    without(broken);
    broken = cloud;
    broken.opacity[0] = bad;
    without(broken);
  }
  SurfelCloud unturned = cloud;
  unturned.rotation.setZero();
  without(unturned);
  SurfelOptions far;
  far.near = 10;
  expect_same_bytes(render_surfels(cloud, view, far), black);
}

TEST(Surfels, ImageOfNoPixelsIsEmpty) {
  const View view = test_view(0, 0);
  SurfelRenderer renderer({});
  const SurfelCloud cloud = test_cloud(5);
  EXPECT_TRUE(renderer.forward(cloud, view).alpha.empty());
  SurfelGradient gradient;
  renderer.backward(cloud, view, {}, &gradient);
  EXPECT_TRUE(flatten(gradient).isZero(0));
}

TEST(Surfels, CentreOfAFacingSurfelHasItsOpacityDepthAndNormal) {
  View view = test_view();
  view.cam_from_world.translation = {0, 0, 4};
  view.camera.cx = 22;
  view.camera.cy = 17;
  SurfelCloud cloud = facing_cloud(0.2);
  cloud.opacity[0] = 1;
  const SurfelImages i = render_surfels(cloud, view);
  const double alpha = 1 / (1 + std::exp(-1.0));
  EXPECT_NEAR(i.alpha.at(22, 17), alpha, 1e-6);
  EXPECT_NEAR(i.depth.at(22, 17), 4 * alpha, 1e-5);
  EXPECT_NEAR(i.median_depth.at(22, 17), 4, 1e-5);
  EXPECT_NEAR(i.normal[2].at(22, 17), -alpha, 1e-6);
  EXPECT_NEAR(i.color[1].at(22, 17), alpha * cloud.color(1, 0), 1e-6);
  EXPECT_EQ(i.alpha.at(0, 0), 0);
}

TEST(Surfels, WithoutSkewTheSkewNormalHasTheBytesOfTheGaussian) {
  const View view = test_view();
  SurfelCloud cloud = test_cloud(60);
  cloud.skew.setZero();
  cloud.log_scale.leftCols(10).setConstant(-8);
  SurfelRenderer gaussian(test_options(SurfelKernel::kGaussian));
  SurfelRenderer skewed(test_options(SurfelKernel::kSkewNormal));
  expect_same_bytes(gaussian.forward(cloud, view), skewed.forward(cloud, view));
  SurfelGradient a, b;
  gaussian.backward(cloud, view, test_image_gradients(view), &a);
  skewed.backward(cloud, view, test_image_gradients(view), &b);
  EXPECT_EQ(a.skew.norm(), 0);
  EXPECT_GT(b.skew.norm(), 0.1);
  a.skew = b.skew;
  // Sums that the skew takes part in (splitting) have it times 0.
  EXPECT_TRUE(same_bytes(flatten(a), flatten(b)));
}

TEST(Surfels, SkewMovesTheWeightToItsSide) {
  const View view = test_view();
  SurfelCloud cloud = facing_cloud(0.3);
  cloud.opacity[0] = -1;
  cloud.skew.col(0) << 2, 0;  // facing_cloud has u along the image's x
  const SurfelImages i = render_surfels(cloud, view, test_options(SurfelKernel::kSkewNormal));
  double left = 0, right = 0;
  const double middle = view.project(cloud.center.col(0), &left).x();
  left = 0;
  for (int y = 0; y < 35; ++y) {
    for (int x = 0; x < 45; ++x) (x < middle ? left : right) += i.alpha.at(x, y);
  }
  EXPECT_GT(right, 5 * left);
}

TEST(Surfels, NormalDistributionFunctionIsThatOfTheLibrary) {
  std::vector<float> s;
  for (int i = -13000; i <= 13000; ++i) s.push_back(float(i) / 1000);
  std::vector<float> value(s.size()), density(s.size());
  twice_normal_cdf(s.data(), int(s.size()), value.data(), density.data());
  for (size_t i = 0; i < s.size(); ++i) {
    ASSERT_NEAR(value[i], std::erfc(-double(s[i]) / std::sqrt(2.0)), 6e-7) << s[i];
    ASSERT_NEAR(density[i], std::exp(-0.5 * s[i] * s[i]) / std::sqrt(2 * M_PI), 3e-7) << s[i];
  }
  EXPECT_EQ(value[13000], 1.0f);
}

TEST_P(Surfels, SameBytesForAnyThreads) {
  const View view = test_view(93, 71);
  const SurfelCloud cloud = test_cloud(600);  // enough for more than one thread
  const int threads = omp_get_max_threads();
  SurfelRenderer one(test_options(GetParam())), many(test_options(GetParam()));
  SurfelGradient a, b;
  omp_set_num_threads(1);
  one.forward(cloud, view);
  one.backward(cloud, view, test_image_gradients(view), &a);
  omp_set_num_threads(3);
  const SurfelImages& images = many.forward(cloud, view);
  many.backward(cloud, view, test_image_gradients(view), &b);
  omp_set_num_threads(threads);
  expect_same_bytes(one.forward(cloud, view), images);
  EXPECT_TRUE(same_bytes(flatten(a), flatten(b)));
}

TEST(Surfels, SecondUseOfARendererLeavesNoTraceOfTheFirst) {
  const View view = test_view();
  SurfelRenderer renderer({});
  renderer.forward(test_cloud(100, 3), test_view(77, 51));
  const SurfelCloud cloud = test_cloud(20);
  expect_same_bytes(renderer.forward(cloud, view), render_surfels(cloud, view));
}

TEST_P(Surfels, OrderOfTheSurfelsChangesNothing) {
  const View view = test_view();
  const SurfelCloud cloud = test_cloud(80);
  std::vector<int> order(80);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  expect_same_bytes(render_surfels(cloud, view, test_options(GetParam())),
                    render_surfels(select(cloud, order), view, test_options(GetParam())));
}

TEST_P(Surfels, ScalingCameraAndWorldTogetherScalesTheDepths) {
  const View view = test_view();
  const SurfelCloud cloud = test_cloud(60);
  const SurfelImages before = render_surfels(cloud, view, test_options(GetParam()));
  for (const double scale : {1e-3, 1e3}) {
    SurfelCloud scaled = cloud;
    scaled.center *= scale;
    scaled.log_scale.array() += std::log(scale);
    View moved = view;
    moved.cam_from_world.translation *= scale;
    SurfelImages after = render_surfels(scaled, moved, test_options(GetParam()));
    for (float& z : after.depth.data) z /= float(scale);
    for (float& z : after.median_depth.data) z /= float(scale);
    EXPECT_LT(largest_difference(before, after), 1e-4);
  }
}

TEST_P(Surfels, MaskedPixelsAreBlackAndTheOthersKeepTheirBytes) {
  const View view = test_view();
  const SurfelCloud cloud = test_cloud(60);
  Image<std::uint8_t> mask(45, 35);
  for (int y = 0; y < 35; ++y) {
    for (int x = 0; x < 45; ++x) mask.at(x, y) = (x - 20) * (x - 20) + (y - 15) * (y - 15) < 90;
  }
  const SurfelOptions options = test_options(GetParam());
  SurfelImages expected = render_surfels(cloud, view, options);
  SurfelImages by_images = test_image_gradients(view);
  SurfelRenderer masked(options), full(options);
  const SurfelImages images = masked.forward(cloud, view, mask);
  SurfelGradient a, b;
  masked.backward(cloud, view, by_images, &a);
  for (int k = 0; k < 9; ++k) {
    for (size_t i = 0; i < mask.data.size(); ++i) {
      if (!mask.data[i]) channels(expected)[k]->data[i] = channels(by_images)[k]->data[i] = 0;
    }
  }
  expect_same_bytes(images, expected);
  full.forward(cloud, view);
  full.backward(cloud, view, by_images, &b);
  b.weight = a.weight;  // that of all pixels, whatever their gradient
  EXPECT_LT((flatten(a) - flatten(b)).norm(), 1e-6 * flatten(b).norm());
}

TEST_P(Surfels, WeightsSumToTheAlphaAndMakeTheColour) {
  const View view = test_view();
  const SurfelCloud cloud = test_cloud(60);
  SurfelRenderer renderer(test_options(GetParam()));
  const SurfelImages& images = renderer.forward(cloud, view);
  const SurfelInfluence influence = renderer.influence();
  SurfelGradient gradient;
  renderer.backward(cloud, view, {}, &gradient);
  Image<double> alpha(45, 35), red(45, 35);
  for (int i = 0; i < 60; ++i) {
    double sum = 0;
    for (int k = influence.first[i]; k < influence.first[i + 1]; ++k) {
      ASSERT_TRUE(k == influence.first[i] || influence.pixel[k - 1] < influence.pixel[k]);
      sum += influence.weight[k];
      alpha.data[influence.pixel[k]] += influence.weight[k];
      red.data[influence.pixel[k]] += influence.weight[k] * cloud.color(0, i);
    }
    EXPECT_NEAR(gradient.weight[i], sum, 1e-5 * (1 + sum));
  }
  for (size_t i = 0; i < alpha.data.size(); ++i) {
    ASSERT_NEAR(alpha.data[i], images.alpha.data[i], 1e-5);
    ASSERT_NEAR(red.data[i], images.color[0].data[i], 1e-5);
  }
}

TEST(Surfels, CosineOfInfluencesIsHighForTwinsAndZeroForStrangers) {
  SurfelCloud cloud = select(facing_cloud(0.2), {0, 0, 0});
  cloud.opacity.setConstant(-2);
  cloud.center.col(1) += 0.02 * Eigen::Vector3d::UnitX();
  cloud.center.col(2) += 10 * Eigen::Vector3d::UnitX();  // out of sight
  std::vector<SurfelInfluence> views;
  for (const double shift : {0.0, 0.1}) {
    View view = test_view();
    view.cam_from_world.translation.x() += shift;
    SurfelRenderer renderer({});
    renderer.forward(cloud, view);
    views.push_back(renderer.influence());
  }
  const Eigen::VectorXd cosines = influence_cosines(views, {{0, 1}, {0, 2}, {1, 1}});
  EXPECT_GT(cosines[0], 0.97);
  EXPECT_LT(cosines[0], 1);
  EXPECT_EQ(cosines[1], 0);
  EXPECT_NEAR(cosines[2], 1, 1e-12);
  EXPECT_EQ(influence_cosines({}, {{0, 1}}), Eigen::VectorXd::Zero(1));
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "raster/surfels/surfel.h"
#include "surfel_scene.h"

namespace sketchsplat {
namespace {

using Jet = ceres::Jet<double, 15>;
using Vector15 = Eigen::Matrix<double, 15, 1>;

// The nine terms of reference_value, one per image, with their derivatives by the parameters of
// surfel i.
Eigen::Matrix<Jet, 9, 1> values_by_jets(const SurfelCloud& cloud, int i, const View& view,
                                        const SurfelImages& by_images,
                                        const SurfelOptions& options) {
  std::vector<ReferenceSurfel<Jet>> surfels;
  for (int k = 0; k < cloud.size(); ++k) surfels.push_back(reference_surfel<Jet>(cloud, k));
  int next = 0;
  const auto mark = [&](auto& column) {
    for (int k = 0; k < column.size(); ++k) column[k].v[next++] = 1;
  };
  mark(surfels[i].center);
  mark(surfels[i].rotation);
  mark(surfels[i].log_scale);
  surfels[i].opacity.v[next++] = 1;
  mark(surfels[i].color);
  mark(surfels[i].skew);
  std::vector<ReferenceDisk<Jet>> disks;
  for (const auto& s : surfels) disks.push_back(reference_disk(s, view, options));
  Eigen::Matrix<Jet, 9, 1> values;
  values.setConstant(Jet(0.0));
  const auto by = channels(by_images);
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      const auto pixel = channels(reference_surfel_pixel(surfels, disks, view, x, y, options));
      for (int k = 0; k < 9; ++k) values[k] += double(by[k]->at(x, y)) * pixel[k];
    }
  }
  return values;
}

Vector15 gradient_by_jets(const SurfelCloud& cloud, int i, const View& view,
                          const SurfelImages& by_images, const SurfelOptions& options) {
  return values_by_jets(cloud, i, view, by_images, options).sum().v;
}

SurfelGradient fast_gradient(const SurfelCloud& cloud, const View& view,
                             const SurfelImages& by_images, const SurfelOptions& options) {
  SurfelRenderer renderer(options);
  renderer.forward(cloud, view);
  SurfelGradient gradient;
  renderer.backward(cloud, view, by_images, &gradient);
  return gradient;
}

// Groups of parameters have units of their own: each is compared at its own size.
void expect_near_in_groups(const Vector15& actual, const Vector15& expected, double scale,
                           double tolerance) {
  const int sizes[] = {3, 4, 2, 1, 3, 2};
  int first = 0;
  for (const int size : sizes) {
    const auto a = actual.segment(first, size), e = expected.segment(first, size);
    EXPECT_LT((a - e).norm(), tolerance * (e.norm() + scale))
        << "parameters from " << first << ": " << a.transpose() << " against " << e.transpose();
    first += size;
  }
}

void expect_gradient_of_dual_numbers(const SurfelCloud& cloud, const View& view,
                                     const SurfelOptions& options, double tolerance = 1e-4) {
  const SurfelImages by_images = test_image_gradients(view);
  const SurfelGradient gradient = fast_gradient(cloud, view, by_images, options);
  for (int i = 0; i < cloud.size(); ++i) {
    SCOPED_TRACE("surfel " + std::to_string(i));
    expect_near_in_groups(parameters(gradient, i),
                          gradient_by_jets(cloud, i, view, by_images, options), 0.1, tolerance);
  }
}

class SurfelGradients : public testing::TestWithParam<SurfelKernel> {};
INSTANTIATE_TEST_SUITE_P(Both, SurfelGradients,
                         testing::Values(SurfelKernel::kGaussian, SurfelKernel::kSkewNormal));

TEST_P(SurfelGradients, AreThoseOfDualNumbers) {
  expect_gradient_of_dual_numbers(test_cloud(8, 1, 0.3), test_view(23, 19),
                                  test_options(GetParam()));
}

TEST_P(SurfelGradients, AreThoseOfCentralDifferences) {
  const View view = test_view(23, 19);
  SurfelCloud cloud = test_cloud(4, 5, 0.2);
  const SurfelOptions options = test_options(GetParam());
  const SurfelImages by_images = test_image_gradients(view);
  const SurfelGradient gradient = fast_gradient(cloud, view, by_images, options);
  const auto difference = [&](double* parameter) {
    const double h = 1e-6, kept = *parameter;
    *parameter = kept + h;
    const double above = reference_value(cloud, view, by_images, options);
    *parameter = kept - h;
    const double below = reference_value(cloud, view, by_images, options);
    *parameter = kept;
    return (above - below) / (2 * h);
  };
  for (int i = 0; i < cloud.size(); ++i) {
    SCOPED_TRACE("surfel " + std::to_string(i));
    Vector15 expected;
    int next = 0;
    for (int k = 0; k < 3; ++k) expected[next++] = difference(&cloud.center(k, i));
    for (int k = 0; k < 4; ++k) expected[next++] = difference(&cloud.rotation(k, i));
    for (int k = 0; k < 2; ++k) expected[next++] = difference(&cloud.log_scale(k, i));
    expected[next++] = difference(&cloud.opacity[i]);
    for (int k = 0; k < 3; ++k) expected[next++] = difference(&cloud.color(k, i));
    for (int k = 0; k < 2; ++k) expected[next++] = difference(&cloud.skew(k, i));
    expect_near_in_groups(parameters(gradient, i), expected, 0.1, 1e-4);
  }
}

TEST_P(SurfelGradients, OfOneImageAloneAreThoseOfDualNumbers) {
  const View view = test_view(21, 19);
  const SurfelCloud cloud = test_cloud(3, 9, 0.15);
  const SurfelOptions options = test_options(GetParam());
  const SurfelImages all = test_image_gradients(view);
  std::vector<Eigen::Matrix<Jet, 9, 1>> expected;
  for (int i = 0; i < 3; ++i) expected.push_back(values_by_jets(cloud, i, view, all, options));
  for (int k = 0; k < 9; ++k) {
    SCOPED_TRACE("image " + std::to_string(k));
    SurfelImages one;
    *channels(one)[k] = *channels(all)[k];
    const SurfelGradient gradient = fast_gradient(cloud, view, one, options);
    for (int i = 0; i < 3; ++i) {
      expect_near_in_groups(parameters(gradient, i), expected[i][k].v, 0.01, 2e-4);
    }
  }
}

TEST_P(SurfelGradients, OfSurfelsNearlyEdgeOnAreThoseOfDualNumbers) {
  const View view = test_view(23, 19);
  for (const double degrees : {85.0, 89.0}) {
    SurfelCloud cloud = facing_cloud(0.3);
    const Eigen::Quaterniond q(cloud.rotation(0), cloud.rotation(1), cloud.rotation(2),
                               cloud.rotation(3));
    const Eigen::Quaterniond turned =
        q * Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d(1, 0.3, 0).normalized());
    cloud.rotation.col(0) << turned.w(), turned.x(), turned.y(), turned.z();
    expect_gradient_of_dual_numbers(cloud, view, test_options(GetParam()), 3e-4);
  }
}

TEST_P(SurfelGradients, OfSurfelsSmallerThanAPixelAreThoseOfDualNumbers) {
  SurfelCloud cloud = test_cloud(5, 3, 0.3);
  cloud.log_scale.setConstant(std::log(1e-4));
  expect_gradient_of_dual_numbers(cloud, test_view(23, 19), test_options(GetParam()));
}

TEST_P(SurfelGradients, OfOpaqueSurfelsAreThoseOfDualNumbers) {
  SurfelCloud cloud = test_cloud(6, 4, 0.2);
  cloud.opacity.setConstant(12);
  expect_gradient_of_dual_numbers(cloud, test_view(23, 19), test_options(GetParam()), 3e-4);
}

TEST_P(SurfelGradients, OfASurfelAsLargeAsTheImageAreThoseOfDualNumbers) {
  SurfelCloud cloud = test_cloud(2, 8, 0.2);
  cloud.log_scale.col(0) << std::log(0.6), std::log(0.9);
  expect_gradient_of_dual_numbers(cloud, test_view(23, 19), test_options(GetParam()));
}

TEST(SurfelGradients, ByTheSkewAtZeroIsThatOfDualNumbers) {
  SurfelCloud cloud = test_cloud(3, 2, 0.2);
  cloud.skew.setConstant(1e-9);  // the reference has no derivative of |l| at 0 itself
  SurfelCloud zero = cloud;
  zero.skew.setZero();
  const View view = test_view(23, 19);
  const SurfelOptions options = test_options(SurfelKernel::kSkewNormal);
  const SurfelImages by_images = test_image_gradients(view);
  const SurfelGradient gradient = fast_gradient(zero, view, by_images, options);
  for (int i = 0; i < 3; ++i) {
    expect_near_in_groups(parameters(gradient, i),
                          gradient_by_jets(cloud, i, view, by_images, options), 0.1, 1e-4);
  }
  EXPECT_GT(gradient.skew.norm(), 0.1);
}

TEST_P(SurfelGradients, InTheImageAreThoseByThePrincipalPoint) {
  View view = test_view(23, 19);
  const SurfelCloud cloud = test_cloud(6, 3, 0.3);
  const SurfelOptions options = test_options(GetParam());
  const SurfelImages by_images = test_image_gradients(view);
  const SurfelGradient gradient = fast_gradient(cloud, view, by_images, options);
  for (const int axis : {0, 1}) {
    double& center = axis ? view.camera.cy : view.camera.cx;
    const double h = 1e-6, kept = center;
    center = kept + h;
    const double above = reference_value(cloud, view, by_images, options);
    center = kept - h;
    const double below = reference_value(cloud, view, by_images, options);
    center = kept;
    const double expected = (above - below) / (2 * h);
    EXPECT_NEAR(gradient.in_image.row(axis).sum(), expected, 1e-4 * (1 + std::abs(expected)));
  }
  EXPECT_TRUE(
      (gradient.in_image_abs.array() * (1 + 1e-5) >= gradient.in_image.array().abs()).all());
}

// dL/dg is constant if L is linear in the alpha of a single surfel; then the splitting matrix is
// the second derivative of L by positions in its plane, in standard deviations.
TEST_P(SurfelGradients, SplittingMatrixIsTheSecondDerivativeOfALinearLoss) {
  const View view = test_view(45, 35);
  SurfelCloud cloud = facing_cloud(0.3);
  cloud.log_scale(0) -= 0.4;
  cloud.opacity[0] = -1;  // far from the clamp
  SurfelOptions options = test_options(GetParam());
  options.lowpass_px = 1e-3;
  SurfelImages by_images;
  by_images.alpha = test_image_gradients(view).alpha;
  SurfelImages filled;
  for (Image<float>* image : channels(filled)) *image = Image<float>(45, 35);
  filled.alpha = by_images.alpha;
  const SurfelGradient gradient = fast_gradient(cloud, view, by_images, options);
  const Eigen::Matrix3d axes = view.cam_from_world.rotation.transpose();
  const Eigen::Vector3d u = std::exp(cloud.log_scale(0)) * axes.col(0);
  const Eigen::Vector3d v = std::exp(cloud.log_scale(1)) * axes.col(1);
  const auto value = [&](double along_u, double along_v) {
    SurfelCloud moved = cloud;
    moved.center.col(0) += along_u * u + along_v * v;
    return reference_value(moved, view, filled, options);
  };
  const double h = 1e-4, middle = value(0, 0);
  const Eigen::Vector3d expected(
      (value(h, 0) - 2 * middle + value(-h, 0)) / (h * h),
      (value(h, h) - value(h, -h) - value(-h, h) + value(-h, -h)) / (4 * h * h),
      (value(0, h) - 2 * middle + value(0, -h)) / (h * h));
  EXPECT_LT((gradient.splitting.col(0) - expected).norm(), 1e-3 * expected.norm())
      << gradient.splitting.col(0).transpose() << " against " << expected.transpose();
}

}  // namespace
}  // namespace sketchsplat

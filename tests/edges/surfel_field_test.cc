// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "edges/surfels/model/surfel_smooth.h"

namespace sketchsplat {
namespace {

SurfelCloud random_cloud(int n) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  SurfelCloud c = SurfelCloud::zero(n);
  for (auto* m : {&c.center, &c.color})
    for (double& v : m->reshaped()) v = 0.3 * normal(random);
  for (double& v : c.rotation.reshaped()) v = normal(random);
  c.color.array() = c.color.array().abs() + 0.2;
  return c;
}

Illumination random_light() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Illumination light;
  for (double& v : light.light.reshaped()) v = normal(random);
  light.extent = 2;
  return light;
}

// `by_values` against central differences of `value` by every one of `values`.
template <typename Values, typename Slopes, typename Value>
void compare_slopes(Values* values, const Slopes& by_values, const Value& value) {
  constexpr double kStep = 1e-5;
  for (int i = 0; i < values->size(); ++i) {
    double& v = values->data()[i];
    const double kept = v;
    v = kept + kStep;
    const double up = value();
    v = kept - kStep;
    const double down = value();
    v = kept;
    EXPECT_NEAR((up - down) / (2 * kStep), by_values.data()[i], 1e-6);
  }
}

TEST(SurfelShading, GradientIsThatOfFiniteDifferences) {
  SurfelCloud cloud = random_cloud(4);
  Illumination light = random_light();
  Eigen::Matrix3Xd albedo = cloud.color;
  const Eigen::Matrix3Xd by_color = random_cloud(4).color;
  SurfelCloud gradient = SurfelCloud::zero(4);
  gradient.color = by_color;
  Eigen::Matrix3Xd by_albedo;
  Eigen::Matrix<double, kShadingTerms, 4> by_light;
  shade_backward(cloud, albedo, light, &gradient, &by_albedo, &by_light);
  const auto value = [&] { return shade(cloud, albedo, light).cwiseProduct(by_color).sum(); };
  const auto compare = [&](auto* values, const auto& by) { compare_slopes(values, by, value); };
  compare(&cloud.rotation, gradient.rotation);
  compare(&cloud.center, gradient.center);
  compare(&albedo, by_albedo);
  compare(&light.light, by_light);
}

TEST(SurfelShading, FindsTheLightThatShadesOneAlbedo) {
  const SurfelCloud cloud = random_cloud(400);
  Illumination light;
  light.light.col(0) << 0.5, 0.1, -0.2, 0.1, 0, 0.05, 0, 0, 0.02;
  const Eigen::VectorXd grey = shade(cloud, Eigen::Matrix3Xd::Ones(3, cloud.size()), light).row(0);
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1));
  const Illumination found =
      fit_illumination(cloud, grey, Eigen::VectorXd::Ones(cloud.size()), box);
  const Eigen::VectorXd again = shade(cloud, Eigen::Matrix3Xd::Ones(3, cloud.size()), found).row(0);
  EXPECT_LT((again - grey).cwiseAbs().maxCoeff(), 0.01);
}

// A view of a soft random blob, and a rendering of another.
struct Seen {
  TrainingView target;
  SurfelImages images;
  Image<std::uint8_t> mask;
  static constexpr int kSide = 14;
  Seen() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.2f, 0.9f);
    target.view.camera = {kSide, kSide, 20, 20, 6.5, 6.5};
    const auto fill = [&](Image<float>* image) {
      *image = Image<float>(kSide, kSide);
      for (float& v : image->data) v = uniform(random);
    };
    for (int c = 0; c < 3; ++c)
      fill(&target.color[c]), fill(&images.color[c]), fill(&images.normal[c]);
    fill(&target.alpha), fill(&images.alpha);
    images.depth = Image<float>(kSide, kSide);
    for (size_t i = 0; i < images.depth.data.size(); ++i) {
      images.alpha.data[i] = 0.6f + 0.3f * images.alpha.data[i];
      images.depth.data[i] = images.alpha.data[i] * (4 + 0.3f * uniform(random));
    }
    mask = Image<std::uint8_t>(kSide, kSide);
    for (std::uint8_t& m : mask.data) m = 1;
  }
};

TEST(SurfelLoss, GradientIsThatOfFiniteDifferences) {
  Seen seen;
  SurfelLossOptions options;
  SurfelImages by, unused;
  surfel_loss(seen.images, seen.target, seen.mask, options, &by);
  const auto compare = [&](Image<float>* image, const Image<float>& by_image) {
    double largest = 0;
    for (const float g : by_image.data) largest = std::max(largest, double(std::abs(g)));
    ASSERT_GT(largest, 0);
    for (int i = 31; i < Seen::kSide * Seen::kSide; i += 17) {
      const float kept = image->data[i], h = 2e-3f;
      image->data[i] = kept + h;
      const double up = surfel_loss(seen.images, seen.target, seen.mask, options, &unused);
      image->data[i] = kept - h;
      const double down = surfel_loss(seen.images, seen.target, seen.mask, options, &unused);
      image->data[i] = kept;
      EXPECT_NEAR((up - down) / (2 * h), by_image.data[i], 0.03 * largest);
    }
  };
  compare(&seen.images.color[1], by.color[1]);
  compare(&seen.images.alpha, by.alpha);
  compare(&seen.images.depth, by.depth);
  compare(&seen.images.normal[2], by.normal[2]);
}

TEST(SurfelLoss, IsNothingWhereTheRenderingIsThePicture) {
  Seen seen;
  for (int c = 0; c < 3; ++c) seen.images.color[c] = seen.target.color[c];
  seen.images.alpha = seen.target.alpha;
  SurfelLossOptions options;
  options.consistency = 0;
  SurfelImages by;
  EXPECT_NEAR(surfel_loss(seen.images, seen.target, seen.mask, options, &by), 0, 1e-5);
}

// A plane z = 0 with the normal n, a point every unit.
SurfelSet plane(int side) {
  SurfelSet set;
  set.values = Eigen::MatrixXd::Zero(SurfelSet::kRows, side * side);
  for (int i = 0; i < side * side; ++i) {
    set.values(SurfelSet::kCenter, i) = i % side;
    set.values(SurfelSet::kCenter + 1, i) = i / side;
    set.values(SurfelSet::kRotation, i) = 1;
    set.values(SurfelSet::kOpacity, i) = 2;
  }
  return set;
}

TEST(SurfelSmoothness, LeavesAPlaneAloneAndPullsAPointBackToIt) {
  SurfelSet set = plane(5);
  const auto pairs = neighbour_pairs(set, 8, 2.5, 30);
  SurfelCloud gradient = SurfelCloud::zero(set.size());
  smooth_gradient(set.cloud(set.albedo()), pairs, 1, 20, 1, &gradient);
  EXPECT_LT(gradient.center.norm() + gradient.rotation.norm(), 1e-12);
  set.values(SurfelSet::kCenter + 2, 12) = 0.2;
  smooth_gradient(set.cloud(set.albedo()), pairs, 1, 20, 1, &gradient);
  EXPECT_GT(gradient.center(2, 12), 0);
}

TEST(SurfelSmoothness, GradientIsThatOfFiniteDifferences) {
  SurfelCloud cloud = random_cloud(5);
  const std::vector<std::pair<int, int>> pairs = {{0, 1}, {1, 2}, {3, 4}, {0, 4}};
  SurfelCloud gradient = SurfelCloud::zero(5), unused = gradient;
  // So wide an edge that the weights of the pairs, which are no part of the gradient, stay.
  constexpr double kEdgeDeg = 1e6;
  smooth_gradient(cloud, pairs, 0.5, kEdgeDeg, 3, &gradient);
  const auto value = [&] { return smooth_gradient(cloud, pairs, 0.5, kEdgeDeg, 3, &unused); };
  const auto compare = [&](auto* values, const auto& by) { compare_slopes(values, by, value); };
  compare(&cloud.center, gradient.center);
  compare(&cloud.rotation, gradient.rotation);
}

TEST(SurfelDensity, ClonesThoseThatArePulledHardestAlongTheirLongerAxis) {
  SurfelSet set = plane(2);
  set.values(SurfelSet::kLogScale, 2) = std::log(0.3);
  set.values(SurfelSet::kLogScale + 1, 2) = std::log(0.1);
  Eigen::Matrix2Xd pull = Eigen::Matrix2Xd::Zero(2, 4);
  pull.col(1) << 0.1, 0;
  pull.col(2) << 0, -3;
  const DensityChange change = clone_split(set, pull, Eigen::VectorXd::Ones(4), 0.05, 1e-3, 1);
  EXPECT_EQ(change.split, 1);
  EXPECT_EQ(change.kept, (std::vector<int>{0, 1, 3}));
  ASSERT_EQ(change.added.cols(), 2);
  const Eigen::VectorXd apart = change.added.col(1) - change.added.col(0);
  EXPECT_NEAR(apart.segment<3>(SurfelSet::kCenter).norm(), 2 * 0.8 * 0.3, 1e-9);
  const Eigen::VectorXd middle = 0.5 * (change.added.col(0) + change.added.col(1));
  EXPECT_LT((middle - set.values.col(2)).segment<3>(SurfelSet::kCenter).norm(), 1e-12);
  EXPECT_NEAR(std::exp(change.added(SurfelSet::kLogScale, 0)), 0.3 / 1.6, 1e-9);
  EXPECT_NEAR(std::exp(change.added(SurfelSet::kLogScale + 1, 1)), 0.1 / 1.6, 1e-9);
}

TEST(SurfelDensity, SplitsOnlyAlongNegativeEigenvaluesAndHalvesOpacity) {
  const SurfelSet set = plane(2);
  Eigen::Matrix3Xd splitting = Eigen::Matrix3Xd::Zero(3, 4);
  splitting.col(0) << 1, 0, 2;   // convex: no
  splitting.col(2) << 3, 0, -1;  // along v: yes
  const DensityChange change =
      steep_split(set, splitting, Eigen::VectorXd::Ones(4), 0.05, 1e-3, 10);
  EXPECT_EQ(change.split, 1);
  EXPECT_EQ(change.kept, (std::vector<int>{0, 1, 3}));
  ASSERT_EQ(change.added.cols(), 2);
  const Eigen::VectorXd apart = change.added.col(1) - change.added.col(0);
  EXPECT_NEAR(apart[SurfelSet::kCenter], 0, 1e-12);
  EXPECT_GT(std::abs(apart[SurfelSet::kCenter + 1]), 0.1);
  const auto alpha = [](double logit) { return 1 / (1 + std::exp(-logit)); };
  EXPECT_NEAR(alpha(change.added(SurfelSet::kOpacity, 0)), alpha(2) / 2, 1e-9);
}

TEST(SurfelDensity, PrunesWhatIsFaintOrUnseen) {
  SurfelSet set = plane(2);
  set.values(SurfelSet::kOpacity, 1) = -6;
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(4);
  weight[3] = 0;
  const DensityChange change =
      steep_split(set, Eigen::Matrix3Xd::Zero(3, 4), weight, 0.05, 1e-3, 10);
  EXPECT_EQ(change.kept, (std::vector<int>{0, 2}));
  EXPECT_EQ(change.pruned, 2);
}

TEST(SurfelDensity, MergesPairsThatDoTheSameWorkBetweenThem) {
  const SurfelSet set = plane(2);
  const std::vector<std::pair<int, int>> pairs = {{0, 1}, {0, 2}, {2, 3}};
  const DensityChange change = merge_pairs(set, pairs, Eigen::Vector3d(0.95, 0.99, 0.5), 0.9);
  EXPECT_EQ(change.merged, 1);  // 0 is taken by the better pair
  EXPECT_EQ(change.kept, (std::vector<int>{1, 3}));
  EXPECT_NEAR(change.added(SurfelSet::kCenter + 1, 0), 0.5, 1e-12);
  EXPECT_GT(change.added(SurfelSet::kLogScale + 1, 0), set.values(SurfelSet::kLogScale + 1, 0));
  const auto alpha = [](double logit) { return 1 / (1 + std::exp(-logit)); };
  EXPECT_NEAR(alpha(change.added(SurfelSet::kOpacity, 0)), 1 - std::pow(1 - alpha(2), 2), 1e-9)
      << "what both let through";
}

TEST(SurfelSet, BacksOfSurfelsAreNotSeen) {
  SurfelSet set = plane(2);
  set.values.col(1).segment<4>(SurfelSet::kRotation) << 0, 1, 0, 0;  // the other way
  View view;
  view.camera = {8, 8, 10, 10, 3.5, 3.5};
  view.cam_from_world.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();  // from above
  view.cam_from_world.translation = {0, 0, 10};
  std::vector<int> indices;
  const SurfelCloud seen = facing_surfels(set.cloud(set.albedo()), view, &indices);
  EXPECT_EQ(indices, (std::vector<int>{0, 2, 3}));
  SurfelGradient part = SurfelGradient::zero(3);
  part.opacity << 1, 2, 3;
  EXPECT_EQ(spread_gradient(part, indices, 4).opacity, Eigen::Vector4d(1, 0, 2, 3));
  EXPECT_EQ(seen.center.col(1), set.values.col(2).head<3>());
}

SurfelField two_planes() {
  SurfelField field;
  field.surfels = plane(12);
  field.spacing = 1;
  field.surfels.values.middleRows<2>(SurfelSet::kLogScale).setConstant(std::log(0.6));
  const double s = std::sqrt(0.5);
  for (int i = 0; i < 144; ++i) {
    if (i % 12 < 6) continue;  // the right half goes down at a right angle
    field.surfels.values(SurfelSet::kCenter, i) = 5.5;
    field.surfels.values(SurfelSet::kCenter + 2, i) = -(i % 12 - 5.5);
    field.surfels.values.col(i).segment<4>(SurfelSet::kRotation) << s, 0, s, 0;
  }
  return field;
}

TEST(SurfelMaps, KeepCreasesThatABlendWouldRound) {
  const SurfelField field = two_planes();
  View view;
  view.camera = {120, 120, 200, 200, 59.5, 59.5};
  // Looks at the crease from both planes' side, x to the right.
  const Eigen::Vector3d forward = Eigen::Vector3d(-1, 0, -1).normalized();
  Eigen::Matrix3d R;
  R.row(2) = forward, R.row(1) = Eigen::Vector3d(0, 1, 0), R.row(0) = R.row(1).cross(R.row(2));
  view.cam_from_world.rotation = R;
  view.cam_from_world.translation = -R * (Eigen::Vector3d(5.5, 5.5, 0) - 30 * forward);
  const Eigen::Vector3d up = R * Eigen::Vector3d(0, 0, 1), side = R * Eigen::Vector3d(1, 0, 0);
  const auto worst = [&](double mode_deg) {
    const GeometryMaps maps = render_geometry(field, view, mode_deg);
    double least = 1;
    for (int x = 45; x < 75; ++x) {
      const Eigen::Vector3d n(maps.normal[0].at(x, 60), maps.normal[1].at(x, 60),
                              maps.normal[2].at(x, 60));
      EXPECT_NEAR(n.norm(), 1, 1e-5);
      least = std::min(least, std::max(n.dot(up), n.dot(side)));
    }
    return std::acos(std::min(1.0, least)) * 180 / M_PI;
  };
  EXPECT_LT(worst(25), 1);
  EXPECT_GT(worst(0), 15);
}

// A ball of unit radius from six sides, grey, of about 1300 pixels.
std::vector<TrainingView> ball() {
  constexpr int kSize = 64;
  std::vector<TrainingView> views(6);
  for (int k = 0; k < 6; ++k) {
    View& v = views[k].view;
    v.camera = {kSize, kSize, 64, 64, 31.5, 31.5};
    const Eigen::Vector3d forward = (k % 2 ? 1 : -1) * Eigen::Vector3d::Unit(k / 2);
    const Eigen::Vector3d right = Eigen::Vector3d::Unit((k / 2 + 1) % 3);
    v.cam_from_world.rotation.row(0) = right;
    v.cam_from_world.rotation.row(1) = forward.cross(right);
    v.cam_from_world.rotation.row(2) = forward;
    v.cam_from_world.translation = {0, 0, 3.2};
    views[k].alpha = Image<float>(kSize, kSize);
    for (int i = 0; i < kSize * kSize; ++i)
      views[k].alpha.data[i] = std::hypot(i % kSize - 31.5, i / kSize - 31.5) < 20.5;
    for (Image<float>& c : views[k].color) {
      c = views[k].alpha;
      for (float& x : c.data) x *= 0.5f;
    }
  }
  return views;
}

TEST(SurfelField, PicturesOfLargeObjectsAreMadeSmallerAndSmallOnesAreNot) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-1.1), Eigen::Vector3d::Constant(1.1));
  SurfelFieldOptions options;
  options.surfels = 200, options.renderings = 6, options.side_px = 64;
  const SurfelField whole = train_surfels(ball(), box, options);
  ASSERT_GT(whole.surfels.size(), 50);
  EXPECT_EQ(whole.side_px, 64);
  options.pixels = 330;  // a quarter
  const SurfelField less = train_surfels(ball(), box, options);
  EXPECT_NEAR(less.side_px, 32, 1);
  EXPECT_EQ(less.drawing.lowpass_px, whole.drawing.lowpass_px);  // of a view, not of the fit
  double off = 0;
  for (int i = 0; i < less.surfels.size(); ++i)
    off += std::abs(less.surfels.center(i).norm() - 1) / less.surfels.size();
  EXPECT_LT(off, 0.1);
}

TEST(SurfelField, TellsPrintFromLightWhetherColoursFollowNormalsOrNot) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-1.1), Eigen::Vector3d::Constant(1.1));
  std::vector<TrainingView> striped = ball();
  for (TrainingView& v : striped)
    for (Image<float>& c : v.color)
      for (size_t i = 0; i < c.data.size(); ++i) c.data[i] *= i / 8 % 2 ? 1.0f : 0.4f;
  for (const bool shading : {true, false}) {
    SurfelFieldOptions options;
    options.surfels = 200, options.renderings = 6, options.side_px = 64;
    options.shading = shading;
    EXPECT_GT(train_surfels(ball(), box, options).evenness, kEven);
    EXPECT_LT(train_surfels(striped, box, options).evenness, kEven);
  }
}

TEST(SurfelPly, HoldsARowOfSixteenNumbersPerSurfel) {
  const std::string ply = surfel_ply(two_planes());
  EXPECT_NE(ply.find("element vertex 144\n"), std::string::npos);
  const size_t header = ply.find("end_header\n") + 11;
  EXPECT_EQ(ply.size() - header, 144u * 16 * 4);
}

}  // namespace
}  // namespace sketchsplat

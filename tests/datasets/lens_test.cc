// SPDX-License-Identifier: MIT
#include "datasets/types/lens.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "datasets/types/view.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;

Lens::Terms terms(double k1, double k2 = 0, double p1 = 0, double p2 = 0, double k3 = 0,
                  double k4 = 0, double k5 = 0, double k6 = 0) {
  Lens::Terms t;
  t.k1 = k1, t.k2 = k2, t.p1 = p1, t.p2 = p2, t.k3 = k3, t.k4 = k4, t.k5 = k5, t.k6 = k6;
  return t;
}

const Lens kBarrel(LensModel::kOpencv, terms(-0.31, 0.12, 0.0013, -0.0021));
const Lens kRational(LensModel::kFullOpencv,
                     terms(0.21, -0.35, -0.004, 0.002, 0.17, 0.05, -0.11, 0.08));

Lens fisheye() {
  Lens::Terms t;
  t.k1 = 0.03, t.k2 = -0.012, t.k3 = 0.004, t.k4 = -0.0007;
  return {LensModel::kOpencvFisheye, t};
}

std::vector<Lens> all_lenses() {
  return {Lens(),
          Lens(LensModel::kSimpleRadial, terms(-0.12)),
          Lens(LensModel::kRadial, terms(0.2, -0.05)),
          kBarrel,
          kRational,
          fisheye()};
}

std::vector<Vector2d> points() {
  std::vector<Vector2d> out;
  for (double x = -0.6; x <= 0.6; x += 0.15)
    for (double y = -0.6; y <= 0.6; y += 0.2) out.push_back({x, y});
  out.push_back({0, 0});
  out.push_back({1e-9, -2e-9});
  return out;
}

void expect_at(const Lens& lens, const Vector2d& ideal, const Vector2d& distorted) {
  EXPECT_LT((lens.distort(ideal) - distorted).norm(), 1e-14) << lens.distort(ideal).transpose();
}

TEST(Lens, DistortsAsOpencvDoes) {
  // cv2.projectPoints and cv2.fisheye.projectPoints (OpenCV 4.6) with these parameters.
  expect_at(kBarrel, {0.3, -0.2}, {0.2877114, -0.1918206});
  expect_at(kBarrel, {-0.55, 0.4}, {-0.4880753125, 0.35485875});
  expect_at(kBarrel, {0.05, 0.62}, {0.04415880966, 0.558147085784});
  expect_at(kRational, {0.3, -0.2}, {0.3061581550809324, -0.20445210338728834});
  expect_at(kRational, {-0.55, 0.4}, {-0.5633370809753255, 0.4085224225275094});
  expect_at(fisheye(), {0.3, -0.2}, {0.2889152110614414, -0.1926101407076276});
  expect_at(fisheye(), {-0.55, 0.4}, {-0.48751208099502163, 0.3545542407236521});
}

TEST(Lens, SimplerModelsAreSpecialCases) {
  for (const Vector2d& p : points()) {
    const Lens radial(LensModel::kRadial, terms(-0.2, 0.03));
    EXPECT_EQ(radial.distort(p), Lens(LensModel::kFullOpencv, terms(-0.2, 0.03)).distort(p));
    const double q = p.squaredNorm();
    EXPECT_LT((radial.distort(p) - p * (1 - 0.2 * q + 0.03 * q * q)).norm(), 1e-15);
  }
}

TEST(Lens, OnlyPinholesAreTheIdentity) {
  EXPECT_TRUE(Lens().is_identity());
  EXPECT_TRUE(Lens(LensModel::kOpencv, terms(0)).is_identity());
  EXPECT_FALSE(Lens(LensModel::kOpencv, terms(0, 0, 0, 1e-9)).is_identity());
  EXPECT_FALSE(Lens(LensModel::kOpencvFisheye, terms(0)).is_identity()) << "it draws angles";
  EXPECT_TRUE(std::isinf(Lens().range()));
  EXPECT_EQ(Lens().distort({0.4, 0.2}), Vector2d(0.4, 0.2));
}

TEST(Lens, JacobianIsTheDerivativeByDifferencesAndByJets) {
  for (const Lens& lens : all_lenses())
    for (const Vector2d& p : points()) {
      const Eigen::Matrix2d J = lens.jacobian(p);
      Eigen::Matrix2d differences, jets;
      const double h = 1e-6;
      using Jet = ceres::Jet<double, 2>;
      LensTerms<Jet> k;
      const Lens::Terms& t = lens.terms();
      k.k1 = Jet(t.k1), k.k2 = Jet(t.k2), k.p1 = Jet(t.p1), k.p2 = Jet(t.p2);
      k.k3 = Jet(t.k3), k.k4 = Jet(t.k4), k.k5 = Jet(t.k5), k.k6 = Jet(t.k6);
      const Eigen::Matrix<Jet, 2, 1> at(Jet(p.x(), 0), Jet(p.y(), 1));
      const Eigen::Matrix<Jet, 2, 1> there = distort(lens.model(), k, at);
      for (int c = 0; c < 2; ++c) {
        const Vector2d step = h * Vector2d::Unit(c);
        differences.col(c) = (lens.distort(p + step) - lens.distort(p - step)) / (2 * h);
        jets.row(c) = there[c].v.transpose();
        EXPECT_NEAR(there[c].a, lens.distort(p)[c], 1e-15);
      }
      EXPECT_LT((J - jets).norm(), 1e-12) << int(lens.model()) << " at " << p.transpose();
      EXPECT_LT((J - differences).norm(), 1e-8) << int(lens.model()) << " at " << p.transpose();
    }
}

TEST(Lens, UndistortIsTheInverse) {
  for (const Lens& lens : all_lenses())
    for (const Vector2d& p : points()) {
      Vector2d back;
      ASSERT_TRUE(lens.undistort(lens.distort(p), &back)) << int(lens.model());
      EXPECT_LT((back - p).norm(), 1e-11);
    }
  Vector2d wide;
  ASSERT_TRUE(fisheye().undistort(fisheye().distort({8, -3}), &wide)) << "83 degrees off the axis";
  EXPECT_LT((wide - Vector2d(8, -3)).norm(), 1e-9);
}

TEST(Lens, TheRangeEndsWhereTheRadiusStopsGrowing) {
  // r (1 - r^2 / 4) turns at sqrt(4 / 3), where it is 0.7698.
  const Lens lens(LensModel::kSimpleRadial, terms(-0.25));
  EXPECT_NEAR(lens.range(), std::sqrt(4.0 / 3), 1e-12);
  Vector2d ideal;
  EXPECT_TRUE(lens.undistort({0.76, 0}, &ideal));
  EXPECT_LT(ideal.norm(), lens.range());
  EXPECT_FALSE(lens.undistort({0.78, 0}, &ideal)) << "the lens draws nothing there";
  EXPECT_FALSE(lens.undistort({0, -40}, &ideal));
  EXPECT_TRUE(lens.draws({1.1, 0}));
  EXPECT_FALSE(lens.draws({1.2, 0}));
  EXPECT_TRUE(std::isinf(Lens(LensModel::kRadial, terms(0.2, 0.1)).range()));
  // A positive highest term: it turns twice, the first time counts.
  const Lens wavy(LensModel::kRadial, terms(-0.5, 0.1));
  const auto radius = [&](double r) { return wavy.distort({r, 0}).x(); };
  EXPECT_GT(radius(wavy.range()), radius(wavy.range() - 1e-3));
  EXPECT_GT(radius(wavy.range()), radius(wavy.range() + 1e-3));
  // A denominator that vanishes.
  EXPECT_NEAR(Lens(LensModel::kFullOpencv, terms(0, 0, 0, 0, 0, -0.5)).range(), std::sqrt(2), 1e-9);
  // Angles that turn back: t (1 - t^2 / 3) at t = 1.
  EXPECT_NEAR(Lens(LensModel::kOpencvFisheye, terms(-1.0 / 3)).range(), std::tan(1.0), 1e-9);
}

TEST(Lens, NoPointComesBackFromWhatIsNoNumber) {
  Vector2d ideal;
  EXPECT_FALSE(Lens().undistort({NAN, 0}, &ideal));
  EXPECT_FALSE(kBarrel.undistort({NAN, 0}, &ideal));
  EXPECT_FALSE(kBarrel.undistort({INFINITY, 0}, &ideal));
}

TEST(View, PixelsGoThroughTheLensAndBackWithTheirJacobian) {
  View view;
  view.camera = {800, 600, 700, 650, 390, 310};
  view.lens = kBarrel;
  const Vector2d ideal(100, 520);
  Vector2d image, back;
  Eigen::Matrix2d J, K;
  ASSERT_TRUE(view.image_pixel(ideal, &image, &J));
  const Vector2d xy((100 - 390) / 700.0, (520 - 310) / 650.0), bent = kBarrel.distort(xy);
  EXPECT_LT((image - Vector2d(700 * bent.x() + 390, 650 * bent.y() + 310)).norm(), 1e-10);
  ASSERT_TRUE(view.ideal_pixel(image, &back, &K));
  EXPECT_LT((back - ideal).norm(), 1e-8);
  EXPECT_LT((J - K).norm(), 1e-10);
  for (int c = 0; c < 2; ++c) {
    Vector2d a, b;
    view.image_pixel(ideal + 1e-3 * Vector2d::Unit(c), &b);
    view.image_pixel(ideal - 1e-3 * Vector2d::Unit(c), &a);
    EXPECT_LT((J.col(c) - (b - a) / 2e-3).norm(), 1e-7);
  }
  view.lens = Lens();
  ASSERT_TRUE(view.ideal_pixel({3.25, -7}, &back, &K));
  EXPECT_EQ(back, Vector2d(3.25, -7));
  EXPECT_EQ(K, Eigen::Matrix2d(Eigen::Matrix2d::Identity()));
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "sketches/fit/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Where the same curve is tried: unit, small and large units, turned and far from the origin.
struct Placement {
  double scale;
  Eigen::Matrix3d rotation;
  Vector3d shift;
  Vector3d operator()(const Vector3d& p) const { return scale * (rotation * (p + shift)); }
};
std::vector<Placement> placements() {
  Random random;
  std::vector<Placement> out = {{1, Eigen::Matrix3d::Identity(), {0, 0, 0}}};
  for (double scale : {1.0, 1e-3, 1e3})
    for (double shift : {1.0, 20.0})
      out.push_back({scale, random.rotation(), shift * random.point()});
  return out;
}

template <typename Curve>
Matrix3Xd sampled(const Placement& place, int n, double noise, Curve curve) {
  Random random;
  Matrix3Xd out(3, n);
  for (int i = 0; i < n; ++i)
    out.col(i) = place(curve(n > 1 ? double(i) / (n - 1) : 0) +
                       noise * Vector3d(random.noise(), random.noise(), random.noise()));
  return out;
}

Matrix3Xd shuffled(const Matrix3Xd& points) {
  Matrix3Xd out(3, points.cols());
  for (int i = 0; i < points.cols(); ++i) out.col(i) = points.col((i * 37 + 11) % points.cols());
  return out;
}

Vector3d on_circle(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

TEST(FitLine, FindsTheLineAndItsEnds) {
  const Vector3d a(1, 2, 3), b(2, 4, 1);
  for (const Placement& place : placements()) {
    const auto curve = [&](double t) -> Vector3d { return a + t * (b - a); };
    const LineFit exact = fit_line(shuffled(sampled(place, 31, 0, curve)));
    ASSERT_TRUE(exact.success);
    const bool swapped = (exact.begin - place(a)).norm() > place.scale;
    EXPECT_LT((exact.begin - place(swapped ? b : a)).norm(), 1e-12 * place.scale);
    EXPECT_LT((exact.end - place(swapped ? a : b)).norm(), 1e-12 * place.scale);
    EXPECT_LT(exact.max_distance, 1e-12 * place.scale);
    const LineFit noisy = fit_line(sampled(place, 400, 0.01, curve));
    EXPECT_NEAR(noisy.rms, std::sqrt(2) * 0.01 * place.scale, 0.1 * 0.01 * place.scale);
    EXPECT_GT(noisy.max_distance, noisy.rms);
    const double cosine =
        (noisy.end - noisy.begin).normalized().dot((place(b) - place(a)).normalized());
    EXPECT_GT(std::abs(cosine), 1 - 1e-5);
  }
}

TEST(FitLine, ObeysItsWeights) {
  Matrix3Xd p(3, 5);
  p << 0, 1, 2, 3, 1,  //
      0, 0, 0, 0, 5,   //
      0, 0, 0, 0, 0;
  Eigen::VectorXd w(5);
  w << 1, 1, 1, 1, 0;
  const LineFit fit = fit_line(p, w);
  ASSERT_TRUE(fit.success);
  EXPECT_LT(fit.max_distance, 1e-14) << "a point of weight 0 is not there";
  EXPECT_NEAR((fit.end - fit.begin).norm(), 3, 1e-14);
  w[4] = 1e-9;
  EXPECT_GT(fit_line(p, w).max_distance, 4.9);
  EXPECT_LT(fit_line(p, w).rms, 1e-3);
}

TEST(FitCircle, FindsFullCirclesAndShortArcsExactly) {
  for (const Placement& place : placements())
    for (double degrees : {360.0, 180.0, 90.0, 20.0, 5.0}) {
      const CircleFit fit = fit_circle(shuffled(
          sampled(place, 40, 0, [&](double t) { return on_circle(t * degrees * M_PI / 180); })));
      ASSERT_TRUE(fit.success) << degrees;
      // Rounding of the input grows with the inverse sagitta.
      const double tolerance =
          1e-11 / std::pow(std::min(1.0, degrees / 90), 2) * place.scale * (1 + place.shift.norm());
      EXPECT_NEAR(fit.radius, place.scale, tolerance) << degrees;
      EXPECT_LT((fit.centre - place({0, 0, 0})).norm(), tolerance) << degrees;
      EXPECT_NEAR(std::abs(fit.normal.dot(place.rotation.col(2))), 1, 1e-12) << degrees;
      EXPECT_LT(fit.max_distance, 1e-13 * place.scale * (1 + place.shift.norm())) << degrees;
    }
}

TEST(FitCircle, StaysUnbiasedUnderNoise) {
  for (const Placement& place : placements()) {
    const double noise = 0.005;
    const CircleFit full =
        fit_circle(sampled(place, 500, noise, [](double t) { return on_circle(t * 2 * M_PI); }));
    ASSERT_TRUE(full.success);
    EXPECT_NEAR(full.radius / place.scale, 1, 1e-3);
    EXPECT_NEAR(full.rms / place.scale, std::sqrt(2) * noise, 0.1 * noise);
    // A short arc: the algebraic fit shrinks the circle, least squares do not.
    const CircleFit part =
        fit_circle(sampled(place, 500, noise, [](double t) { return on_circle(t * M_PI / 3); }));
    ASSERT_TRUE(part.success);
    EXPECT_NEAR(part.radius / place.scale, 1, 0.03);
    EXPECT_GT(std::abs(part.normal.dot(place.rotation.col(2))), 0.999);
  }
}

TEST(FitCircle, IsAMinimumOfTheDistances) {
  const Matrix3Xd points =
      sampled(placements()[1], 60, 0.03, [](double t) { return on_circle(t * 2.0); });
  const CircleFit fit = fit_circle(points);
  const auto cost = [&](const Vector3d& centre, const Vector3d& axis) {
    const Vector3d c[2] = {centre, axis};
    double sum = 0;
    for (int i = 0; i < points.cols(); ++i)
      sum += std::pow(closest_on_curve(StrokeKind::kCircle, c, points.col(i)).distance, 2);
    return sum;
  };
  const Vector3d axis = fit.radius * fit.normal;
  const double least = cost(fit.centre, axis);
  EXPECT_NEAR(std::sqrt(least / 60), fit.rms, 1e-12);
  for (int k = 0; k < 6; ++k)
    for (double h : {-1e-3, 1e-3}) {
      const Vector3d e = h * Vector3d::Unit(k % 3);
      EXPECT_GT(k < 3 ? cost(fit.centre + e, axis) : cost(fit.centre, axis + e), least);
    }
}

TEST(FitCircle, TakesThreePointsAsTheyAre) {
  Matrix3Xd p(3, 3);
  p << 1, 0, -1, 0, 1, 0, 2, 2, 2;
  const CircleFit fit = fit_circle(p);
  ASSERT_TRUE(fit.success);
  EXPECT_NEAR(fit.radius, 1, 1e-12);
  EXPECT_LT((fit.centre - Vector3d(0, 0, 2)).norm(), 1e-12);
}

TEST(FitArc, FindsBeginApexAndEndInTheOrderOfThePoints) {
  for (const Placement& place : placements())
    for (double degrees : {5.0, 60.0, 180.0, 270.0, 350.0})
      for (double sign : {1.0, -1.0}) {
        const double angle = sign * degrees * M_PI / 180;
        const ArcFit fit =
            fit_arc(sampled(place, 50, 0, [&](double t) { return on_circle(0.4 + t * angle); }));
        ASSERT_TRUE(fit.success);
        const double tolerance = 1e-12 * place.scale * (1 + place.shift.norm());
        EXPECT_LT((fit.begin - place(on_circle(0.4))).norm(), tolerance) << degrees;
        EXPECT_LT((fit.apex - place(on_circle(0.4 + angle / 2))).norm(), tolerance) << degrees;
        EXPECT_LT((fit.end - place(on_circle(0.4 + angle))).norm(), tolerance) << degrees;
      }
}

TEST(FitArc, SurvivesNoiseAndRefusesAFullTurn) {
  for (const Placement& place : placements()) {
    const ArcFit fit =
        fit_arc(sampled(place, 200, 0.003, [](double t) { return on_circle(2 * t); }));
    ASSERT_TRUE(fit.success);
    EXPECT_LT((fit.apex - place(on_circle(1))).norm(), 0.01 * place.scale);
    EXPECT_LT((fit.begin - place(on_circle(0))).norm(), 0.02 * place.scale);
    EXPECT_FALSE(fit_arc(sampled(place, 50, 0, [](double t) { return on_circle(7 * t); })).success);
  }
}

TEST(FitArc, BendsBetweenGivenEnds) {
  for (const Placement& place : placements())
    for (double degrees : {1.0, 60.0, 180.0, 300.0}) {
      const double angle = degrees * M_PI / 180;
      const auto curve = [&](double t) { return on_circle(t * angle); };
      const Vector3d begin = place(curve(0)), end = place(curve(1));
      const ArcFit exact = fit_arc(shuffled(sampled(place, 40, 0, curve)), begin, end);
      ASSERT_TRUE(exact.success);
      EXPECT_EQ(exact.begin, begin);
      EXPECT_EQ(exact.end, end);
      EXPECT_LT((exact.apex - place(on_circle(angle / 2))).norm(),
                1e-7 * place.scale * (1 + place.shift.norm()))
          << degrees;
      const ArcFit noisy = fit_arc(sampled(place, 200, 0.002, curve), begin, end);
      EXPECT_LT((noisy.apex - place(on_circle(angle / 2))).norm(), 0.01 * place.scale) << degrees;
    }
  Matrix3Xd straight(3, 3);
  straight << 0.2, 0.5, 0.8, 0, 0, 0, 0, 0, 0;
  const ArcFit fit = fit_arc(straight, {0, 0, 0}, {1, 0, 0});
  ASSERT_TRUE(fit.success);
  EXPECT_LT((fit.apex - Vector3d(0.5, 0, 0)).norm(), 1e-12);
  EXPECT_FALSE(fit_arc(straight, {0, 0, 0}, {0, 0, 0}).success);
  EXPECT_FALSE(fit_arc(Matrix3Xd(3, 0), {0, 0, 0}, {1, 0, 0}).success);
}

const Vector3d kCubic[4] = {{0, 0, 0}, {0.5, 1, 0.2}, {1.2, -0.4, 0.6}, {1.5, 0.5, 1}};

Vector3d on_cubic(double t) {
  Vector3d p, d;
  evaluate_curve<double>(StrokeKind::kBezier, kCubic, t, &p, &d);
  return p;
}

TEST(FitBezier, FindsTheCubicThroughUnevenSamples) {
  const auto uneven = [](double t) { return on_cubic(t * t * (1.8 - 0.8 * t)); };
  for (const Placement& place : placements()) {
    const Matrix3Xd points = sampled(place, 60, 0, uneven);
    const std::optional<Vector3d> none, begin = place(kCubic[0]), end = place(kCubic[3]);
    for (const auto& [first, last] : {std::pair(none, none), std::pair(begin, none),
                                      std::pair(none, end), std::pair(begin, end)}) {
      const BezierFit fit = fit_bezier(points, first, last);
      ASSERT_TRUE(fit.success);
      EXPECT_LT(fit.max_distance, 1e-7 * place.scale);
      for (int k = 0; k < 4; ++k)
        EXPECT_LT((fit.control[k] - place(kCubic[k])).norm(), 1e-5 * place.scale) << k;
      EXPECT_EQ(fit.control[0], first.value_or(fit.control[0]));
      EXPECT_EQ(fit.control[3], last.value_or(fit.control[3]));
    }
  }
}

TEST(FitBezier, AveragesNoise) {
  for (const Placement& place : placements()) {
    const BezierFit fit = fit_bezier(sampled(place, 300, 0.004, on_cubic));
    ASSERT_TRUE(fit.success);
    EXPECT_NEAR(fit.rms, std::sqrt(2) * 0.004 * place.scale, 0.0006 * place.scale);
    double worst = 0;
    for (double t = 0.1; t <= 0.9; t += 0.1)
      worst = std::max(
          worst,
          closest_on_curve(StrokeKind::kBezier, fit.control.data(), place(on_cubic(t))).distance);
    EXPECT_LT(worst, 0.002 * place.scale);
  }
}

TEST(FitBezier, GivesAStraightCubicForCollinearPoints) {
  const BezierFit fit =
      fit_bezier(sampled(placements()[2], 20, 0, [](double t) { return Vector3d(t, 2 * t, -t); }));
  ASSERT_TRUE(fit.success);
  EXPECT_LT(fit.max_distance, 1e-10);
}

TEST(FitBezier, BeatsNoneOfItsOwnPerturbations) {
  const Matrix3Xd points = sampled(placements()[0], 80, 0.02, on_cubic);
  const BezierFit fit = fit_bezier(points, kCubic[0], kCubic[3]);
  const auto cost = [&](const std::array<Vector3d, 4>& c) {
    double sum = 0;
    for (int i = 0; i < points.cols(); ++i)
      sum += std::pow(closest_on_curve(StrokeKind::kBezier, c.data(), points.col(i)).distance, 2);
    return sum;
  };
  const double least = cost(fit.control);
  EXPECT_NEAR(std::sqrt(least / 80), fit.rms, 1e-12);
  for (int k = 0; k < 12; ++k) {
    std::array<Vector3d, 4> c = fit.control;
    if (k / 3 == 0 || k / 3 == 3) continue;
    c[k / 3][k % 3] += 2e-3;
    EXPECT_GT(cost(c), least) << k;
    c[k / 3][k % 3] -= 4e-3;
    EXPECT_GT(cost(c), least) << k;
  }
}

TEST(FitEllipse, FindsFullAndPartialEllipses) {
  for (const Placement& place : placements())
    for (double ratio : {0.9, 0.4, 0.05})
      for (double part : {1.0, 0.6, 0.3}) {
        const EllipseFit fit = fit_ellipse(shuffled(sampled(place, 60, 0, [&](double t) {
          const double a = 0.3 + t * part * 2 * M_PI;
          return Vector3d(std::cos(a), ratio * std::sin(a), 0);
        })));
        ASSERT_TRUE(fit.success) << ratio << " " << part;
        const double tolerance = 1e-6 * place.scale;
        EXPECT_LT((fit.centre - place({0, 0, 0})).norm(), tolerance) << ratio << " " << part;
        EXPECT_NEAR(fit.u.norm(), place.scale, tolerance) << ratio << " " << part;
        EXPECT_NEAR(fit.v.norm(), ratio * place.scale, tolerance) << ratio << " " << part;
        EXPECT_NEAR(std::abs(fit.u.normalized().dot(place.rotation.col(0))), 1, 1e-6);
        EXPECT_NEAR(fit.u.normalized().dot(fit.v.normalized()), 0, 1e-9);
        EXPECT_LT(fit.max_distance, tolerance);
      }
}

TEST(FitEllipse, AveragesNoise) {
  for (const Placement& place : placements()) {
    const EllipseFit fit = fit_ellipse(sampled(place, 400, 0.004, [](double t) {
      return Vector3d(std::cos(2 * M_PI * t), 0.5 * std::sin(2 * M_PI * t), 0);
    }));
    ASSERT_TRUE(fit.success);
    EXPECT_NEAR(fit.u.norm() / place.scale, 1, 2e-3);
    EXPECT_NEAR(fit.v.norm() / place.scale, 0.5, 2e-3);
    EXPECT_NEAR(fit.rms / place.scale, std::sqrt(2) * 0.004, 6e-4);
  }
}

// Whether all numbers of a failed fit are zero or at least finite.
template <typename Fit>
void expect_refused(const Fit& fit, const Matrix3Xd& points) {
  EXPECT_FALSE(fit.success) << points;
  EXPECT_EQ(fit.rms, 0);
  EXPECT_EQ(fit.max_distance, 0);
}

TEST(Fits, RefuseWhatIsDegenerate) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Matrix3Xd> nothing = {Matrix3Xd(3, 0), Matrix3Xd::Ones(3, 1),
                                    Matrix3Xd::Constant(3, 50, 0.1), Matrix3Xd::Zero(3, 50)};
  Matrix3Xd broken = Matrix3Xd::Random(3, 20);
  broken(1, 7) = nan;
  nothing.push_back(broken);
  broken(1, 7) = std::numeric_limits<double>::infinity();
  nothing.push_back(broken);
  for (const Matrix3Xd& p : nothing) {
    expect_refused(fit_line(p), p);
    expect_refused(fit_circle(p), p);
    expect_refused(fit_arc(p), p);
    expect_refused(fit_bezier(p), p);
    expect_refused(fit_ellipse(p), p);
  }
  for (const Placement& place : placements())
    for (int n : {2, 3, 6, 50}) {
      const Matrix3Xd line =
          sampled(place, n, 0, [](double t) { return Vector3d(1 + t, 2 - t, 3 * t); });
      expect_refused(fit_circle(line), line);
      expect_refused(fit_arc(line), line);
      expect_refused(fit_ellipse(line), line);
      EXPECT_TRUE(fit_line(line).success);
    }
}

TEST(Fits, AreFiniteForAnyFewPoints) {
  Random random;
  for (int n = 1; n < 12; ++n)
    for (int round = 0; round < 20; ++round) {
      Matrix3Xd p(3, n);
      for (int i = 0; i < n; ++i)  // coarse coordinates: many coincide
        p.col(i) = (2 * random.point()).array().round();
      const CircleFit circle = fit_circle(p);
      EXPECT_TRUE(circle.centre.allFinite() && std::isfinite(circle.radius));
      const ArcFit arc = fit_arc(p);
      EXPECT_TRUE(arc.begin.allFinite() && arc.apex.allFinite() && arc.end.allFinite());
      const BezierFit bezier = fit_bezier(p);
      for (const Vector3d& c : bezier.control) EXPECT_TRUE(c.allFinite());
      const EllipseFit ellipse = fit_ellipse(p);
      EXPECT_TRUE(ellipse.centre.allFinite() && ellipse.u.allFinite() && ellipse.v.allFinite());
    }
}

}  // namespace
}  // namespace sketchsplat

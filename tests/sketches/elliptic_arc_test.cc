// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/fit/ellipse_run.h"
#include "sketches/fit/segment.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr auto kKind = StrokeKind::kEllipticArc;

Vector3d point_at(const ControlPoints& c, double t) {
  Vector3d p, d;
  evaluate_curve<double>(kKind, c.p.data(), t, &p, &d);
  return p;
}

// A tilted ellipse, by conjugate semi-diameters that are not its axes.
struct Tilted {
  Vector3d centre{0.3, -0.2, 0.5}, p{0.5, 0.1, 0.2}, q{-0.05, 0.3, 0.1};
  Vector3d at(double psi) const { return centre + std::cos(psi) * p + std::sin(psi) * q; }
  ControlPoints arc(double from, double to) const { return elliptic_arc(centre, p, q, from, to); }
  double off(const Vector3d& x) const {  // 0 on it
    const Vector3d n = p.cross(q), v = x - centre;
    const double c = v.cross(q).dot(n) / n.squaredNorm(), s = p.cross(v).dot(n) / n.squaredNorm();
    return std::abs(std::hypot(c, s) - 1) + std::abs(v.dot(n.normalized()));
  }
};

TEST(EllipticArc, RunsOnItsEllipseFromEndToEnd) {
  const Tilted e;
  for (double turn : {0.01, 0.3, 0.55, 0.6, 1.0, 2.0, M_PI, 5.0, 6.05, 6.1, 6.19})
    for (double from : {-1.0, 0.4, 3.0}) {
      const ControlPoints c = e.arc(from, from + turn);
      EXPECT_LT((point_at(c, 0) - c.p[0]).norm() + (point_at(c, 1) - c.p[3]).norm(), 1e-15);
      for (double t : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0})
        EXPECT_LT((point_at(c, t) - e.at(from + t * turn)).norm(), 1e-9) << turn << " at " << t;
      const EllipticArcParameters k = elliptic_arc_parameters(c);
      EXPECT_NEAR(k.half_angle, turn / 2, 1e-8);
      EXPECT_LT((k.centre - e.centre).norm(), 1e-4 / turn / turn * 1e-4) << turn;
      EXPECT_LT((k.at(0) - e.at(from + turn / 2)).norm(), 1e-9);
    }
}

TEST(EllipticArc, OfACircleIsTheCircularArc) {
  for (double turn : {0.2, 1.5, 4.0}) {
    const Vector3d x(0.4, 0, 0.3), y(0, 0.5, 0);
    const ControlPoints c = elliptic_arc({1, 2, 3}, x, y, -turn / 2, turn / 2);
    const Vector3d arc[3] = {c.p[0], c.p[1], c.p[3]};
    for (double t : {0.05, 0.3, 0.7}) {
      Vector3d p, d;
      evaluate_curve<double>(StrokeKind::kArc, arc, t, &p, &d);
      EXPECT_LT((point_at(c, t) - p).norm(), 1e-12);
    }
  }
}

TEST(EllipticArc, HasEndsOnItsEllipseWhateverTheColumnsAre) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    ControlPoints c;
    c.count = 4;
    const double size = std::pow(10, 3 * random.uniform());
    for (int k = 0; k < 4; ++k) c.p[k] = size * random.point();
    if (i % 5 == 0) c.p[1] = (c.p[0] + c.p[3]) / 2 + 1e-7 * size * random.point();
    if (i % 7 == 0) c.p[2] = c.p[1];
    if (i % 11 == 0) c.p[3] = c.p[0];
    if (i % 13 == 0) c.p[1] = (c.p[0] + c.p[3]) / 2;
    for (double t : {0.0, 0.2, 0.9, 1.0}) ASSERT_TRUE(point_at(c, t).allFinite()) << i;
    EXPECT_LT((point_at(c, 0) - c.p[0]).norm() + (point_at(c, 1) - c.p[3]).norm(), 1e-12 * size);
    const EllipticArcParameters k = elliptic_arc_parameters(c);
    if (k.straight) continue;
    const double reach = k.p.norm() + k.q.norm() + size;
    EXPECT_LT((k.at(-k.half_angle) - c.p[0]).norm(), 1e-12 * reach) << i;
    EXPECT_LT((k.at(k.half_angle) - c.p[3]).norm(), 1e-12 * reach) << i;
    EXPECT_LT((k.at(0) - c.p[1]).norm(), 1e-12 * reach) << i;
    EXPECT_LT((k.at(0.6 * k.half_angle) - point_at(c, 0.8)).norm(), 1e-10 * reach) << i;
  }
}

// Ten numbers tell an arc of an ellipse: five its shape in the plane, three the plane, two the
// ends.
TEST(EllipticArc, HasTenDegreesOfFreedomAndTwoThatDoNotCount) {
  ControlPoints c = Tilted().arc(-0.7, 1.6);
  Eigen::MatrixXd J(3 * 9, 12);
  const double h = 1e-6;
  for (int k = 0; k < 12; ++k)
    for (int i = 0; i < 9; ++i) {
      ControlPoints a = c, b = c;
      a.p[k / 3][k % 3] += h, b.p[k / 3][k % 3] -= h;
      J.block<3, 1>(3 * i, k) = (point_at(a, i / 8.0) - point_at(b, i / 8.0)) / (2 * h);
    }
  const Eigen::VectorXd s = svd(J).values;
  EXPECT_GT(s[9], 1e-2 * s[0]);
  EXPECT_LT(s[10], 1e-7 * s[0]);
  const Vector3d rise = c.p[1] - (c.p[0] + c.p[3]) / 2, before = point_at(c, 0.2);
  c.p[2] += rise.cross(Vector3d(0.3, -0.8, 0.1));
  EXPECT_LT((point_at(c, 0.2) - before).norm(), 1e-14);
}

TEST(EllipticArc, GoesOnSmoothlyWhereTheQuarterPointLeavesItsBounds) {
  ControlPoints c = Tilted().arc(-1, 1);
  const Vector3d middle = (c.p[0] + c.p[3]) / 2, rise = c.p[1] - middle;
  const auto at = [&](double g) {
    c.p[2] = middle + g * rise;
    return point_at(c, 0.25);
  };
  const double h = 1e-5;
  for (double g = 0.45; g < 0.752; g += 0.00037) {
    const double there = (at(g) - middle).dot(rise) / rise.squaredNorm();
    EXPECT_TRUE(std::isfinite(there)) << g;
    // The same slope to the left and to the right: no kink at the bounds.
    const Vector3d left = (at(g) - at(g - h)) / h, right = (at(g + h) - at(g)) / h;
    EXPECT_LT((left - right).norm(), 0.02 * (1 + left.norm())) << g;
  }
}

TEST(EllipticArc, HasPiecesAndContinuationsOnTheSameEllipse) {
  const Tilted e;
  const ControlPoints c = e.arc(0.3, 2.0);
  for (const auto& [t0, t1] : {std::pair(0.2, 0.7), {-0.4, 1.3}, {0.5, 1.0}, {0.0, 0.02}}) {
    const ControlPoints part = subcurve(kKind, c, t0, t1);
    for (double t : {0.0, 0.3, 1.0}) {
      EXPECT_LT(e.off(point_at(part, t)), 1e-9);
      EXPECT_LT((point_at(part, t) - point_at(c, t0 + t * (t1 - t0))).norm(), 1e-9);
    }
  }
}

TEST(EllipticArc, KnowsItsNearestPoint) {
  Random random;
  const ControlPoints c = Tilted().arc(-2.2, 2.5);
  for (int i = 0; i < 200; ++i) {
    const Vector3d q = c.p[1] + random.point();
    const ClosestPoint found = closest_on_curve(kKind, c.p.data(), q);
    double best = 1e300;
    for (int k = 0; k <= 2000; ++k) best = std::min(best, (point_at(c, k / 2000.0) - q).norm());
    EXPECT_LE(found.distance, best + 1e-12);
    EXPECT_GT(found.distance, best - 1e-5);
  }
}

// Points along an ellipse with noise.
Matrix3Xd noisy(const Tilted& e, double from, double to, int n, double sigma, Random* random) {
  Matrix3Xd p(3, n);
  for (int i = 0; i < n; ++i) {
    p.col(i) = e.at(from + (to - from) * i / (n - 1));
    for (int k = 0; k < 3; ++k) p(k, i) += sigma * random->noise();
  }
  return p;
}

TEST(EllipseAlong, FindsTheEllipseOfPointsInEitherOrder) {
  Random random;
  const Tilted e;
  for (double turn : {1.0, 2.0, 4.0, 6.0})
    for (bool back : {false, true}) {
      Matrix3Xd p = noisy(e, 0.5, 0.5 + turn, 60, 0, &random);
      if (back) p = p.rowwise().reverse().eval();
      const EllipseRun run = ellipse_along(p);
      ASSERT_TRUE(run.ok) << turn;
      EXPECT_LT((run.centre - e.centre).norm(), 1e-6) << turn;
      EXPECT_NEAR(run.sweep(), turn, 1e-5);
      EXPECT_LT((run.at(run.angle[0]) - p.col(0)).norm(), 1e-7);
      EXPECT_LT(run.distance.maxCoeff(), 1e-7);
    }
}

TEST(EllipseAlong, IsAsGoodAsTheNoiseAllows) {
  Random random;
  const Tilted e;
  const double sigma = 1e-3;
  for (double turn : {1.5, 3.0, 5.0}) {
    const Matrix3Xd p = noisy(e, -turn / 2, turn / 2, 200, sigma, &random);
    const EllipseRun run = ellipse_along(p);
    ASSERT_TRUE(run.ok);
    // Two of three dimensions are square to the curve, and ten of 400 numbers are fitted.
    const double rms = std::sqrt(run.distance.squaredNorm() / 200);
    EXPECT_NEAR(rms, sigma * std::sqrt(2.0), 0.15 * sigma);
    for (double psi : {-0.4, 0.0, 0.4}) EXPECT_LT(e.off(run.at(psi * turn)), 12 * sigma) << turn;
  }
}

TEST(EllipseAlong, RefusesWhatIsNoEllipse) {
  Matrix3Xd line(3, 40), few = Matrix3Xd::Random(3, 5), spot = Matrix3Xd::Ones(3, 40);
  for (int i = 0; i < 40; ++i) line.col(i) = i * Vector3d(1, 2, 3);
  EXPECT_FALSE(ellipse_along(line).ok);
  EXPECT_FALSE(ellipse_along(few).ok);
  EXPECT_FALSE(ellipse_along(spot).ok);
  Random random;
  EXPECT_FALSE(ellipse_along(noisy(Tilted(), 0, 0.6, 60, 0, &random)).ok);  // too little of it
}

// What cut_run makes of points with the noise that it is told.
std::vector<RunPiece> described(const Matrix3Xd& p, double sigma) {
  Matrix3Xd t(3, p.cols());
  for (int i = 0; i < p.cols(); ++i)
    t.col(i) =
        (p.col(std::min<int>(i + 3, int(p.cols()) - 1)) - p.col(std::max(i - 3, 0))).normalized();
  return cut_run(p, t, false, sigma, 0.01, {});
}

TEST(CutRun, DescribesAnArcOfAnEllipseAsOne) {
  Random random;
  const Tilted e;
  for (double turn : {2.0, M_PI, 4.5}) {
    const double sigma = 3e-3;
    const auto pieces = described(noisy(e, 0.2, 0.2 + turn, 150, sigma, &random), 1.2 * sigma);
    ASSERT_EQ(pieces.size(), 1u) << turn;
    EXPECT_EQ(pieces[0].fit.kind, kKind);
    EXPECT_LT((pieces[0].fit.begin - e.at(0.2)).norm(), 6 * sigma);
    EXPECT_LT((pieces[0].fit.end - e.at(0.2 + turn)).norm(), 6 * sigma);
  }
}

TEST(CutRun, DoesNotTakeNoiseOnACircleForAnEllipse) {
  Tilted e;
  e.p = {0.4, 0, 0.3}, e.q = {0, 0.5, 0};
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Random random;
    random.engine.seed(seed);
    const auto pieces = described(noisy(e, 0, 1.0 + 0.3 * seed, 120, 3e-3, &random), 3.6e-3);
    ASSERT_EQ(pieces.size(), 1u) << seed;
    EXPECT_EQ(pieces[0].fit.kind, StrokeKind::kArc) << seed;
  }
}

TEST(CutRun, LeavesACurveInSpaceToCubics) {
  Matrix3Xd p(3, 150);
  Random random;
  for (int i = 0; i < 150; ++i) {
    const double t = i / 149.0;
    p.col(i) =
        Vector3d(t, 0.4 * t * (1 - t), 0.3 * t * (t - 0.5) * (t - 1)) + 1e-3 * random.point();
  }
  const auto pieces = described(p, 1e-3);
  ASSERT_GE(pieces.size(), 1u);
  for (const RunPiece& piece : pieces) EXPECT_NE(piece.fit.kind, kKind);
}

TEST(CutRun, ClosesAnEllipseThatIsAllButWhole) {
  Random random;
  const auto pieces = described(noisy(Tilted(), 0, 6.2, 200, 2e-3, &random), 2.4e-3);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].fit.kind, StrokeKind::kEllipse);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "eval/inspect/tolerance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "eval/inspect/edge_check.h"
#include "eval/inspect/nominal.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "sketches/solve/covariance.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;

DeviationMixture one(const DeviationModel& model) { return {{model}, {1}}; }

DeviationMixture one_place(const Vector2d& mean, const Matrix2d& covariance) {
  DeviationModel m;
  m.mean = mean;
  m.modes = covariance.llt().matrixL();
  return one(m);
}

TEST(Interval, IsThatOfTheNormalDistribution) {
  EXPECT_NEAR(interval_probability(0, 1, 1.959964), 0.95, 1e-6);
  EXPECT_NEAR(interval_probability(1, 0.5, 1), 0.5, 1e-4);
  EXPECT_EQ(interval_probability(0.9, 0, 1), 1);
  EXPECT_EQ(interval_probability(-1.1, 0, 1), 0);
}

// Deviations 0.05 and 0.10 along two axes, a tube of 0.2: 0.839 <= 0.945 <= 0.954, by draws of
// another program.
TEST(Tube, SquaresInsideAndAroundTheDiscBoundIt) {
  const DeviationMixture m =
      one_place({0, 0}, Vector2d(0.05 * 0.05, 0.1 * 0.1).asDiagonal().toDenseMatrix());
  TubeProbability p;
  bound_tube({m}, 0.2, &p);
  EXPECT_NEAR(p.low, 0.839, 0.001);
  EXPECT_NEAR(p.high, 0.954, 0.001);
  EXPECT_NEAR(share_within(draw_largest({m}), 0.2), 0.945, 0.01);
}

TEST(Tube, DoesNotDependOnHowTheAxesAreTurned) {
  const Matrix2d c = Vector2d(0.01, 0.04).asDiagonal();
  const Eigen::Rotation2Dd turn(0.7);
  TubeProbability straight, turned;
  bound_tube({one_place({0.1, 0.05}, c)}, 0.3, &straight);
  bound_tube({one_place(turn * Vector2d(0.1, 0.05), turn.matrix() * c * turn.matrix().transpose())},
             0.3, &turned);
  EXPECT_NEAR(straight.low, turned.low, 1e-12);
  EXPECT_NEAR(straight.high, turned.high, 1e-12);
}

TEST(Tube, WithoutErrorsIsYesOrNo) {
  DeviationModel m;
  m.mean = Vector2d(0.3, 0.0);
  m.modes = MatrixXd::Zero(2, 0);
  TubeProbability p;
  bound_tube({one(m)}, 0.5, &p);
  EXPECT_EQ(p.low, 1);
  EXPECT_EQ(p.high, 1);
  EXPECT_EQ(share_within(draw_largest({one(m)}), 0.5), 1);
  EXPECT_EQ(share_within(draw_largest({one(m)}), 0.2), 0);
}

TEST(Tube, PiecesErrIndependently) {
  const DeviationMixture m = one_place({0, 0}, Matrix2d::Identity());
  const double one = share_within(draw_largest({m}), 1.5);
  const double three = share_within(draw_largest({m, m, m}), 1.5);
  EXPECT_NEAR(one, 1 - std::exp(-1.5 * 1.5 / 2), 0.02);
  EXPECT_NEAR(three, one * one * one, 0.02);
}

TEST(Tube, AMixtureIsThatOfItsParts) {
  DeviationMixture m = one_place({0, 0}, Matrix2d::Identity());
  m.parts.push_back(one_place({0, 0}, 16 * Matrix2d::Identity()).parts[0]);
  m.weights = {0.75, 0.25};
  const auto rayleigh = [](double r) { return 1 - std::exp(-r * r / 2); };
  const double exact = 0.75 * rayleigh(2) + 0.25 * rayleigh(0.5);
  EXPECT_NEAR(share_within(draw_largest({m}), 2), exact, 0.02);
  TubeProbability p;
  bound_tube({m}, 2, &p);
  EXPECT_LT(p.low, exact);
  EXPECT_GT(p.high, exact);
}

// A nominal stroke, a measured one with a covariance about as far off as it says.
struct Case {
  Sketch nominal, measured;
  double tolerance = 0;
};

Case make_case(Random* random, int i) {
  static const StrokeKind kKinds[] = {StrokeKind::kLine, StrokeKind::kArc, StrokeKind::kCircle,
                                      StrokeKind::kBezier, StrokeKind::kEllipse};
  const StrokeKind kind = kKinds[i % 5];
  const double sigma = 2e-4 * std::pow(10, random->uniform());
  Case c;
  const Eigen::Matrix3d r = random->rotation();
  std::vector<Vector3d> p = {{0, 0, 0}, {1, 0, 0}};
  if (kind == StrokeKind::kArc) p = {{0, 0, 0}, {0.5, 0.3 + 0.2 * random->uniform(), 0}, {1, 0, 0}};
  if (kind == StrokeKind::kCircle) p = {{0, 0, 0}, {0, 0, 0.4}};
  if (kind == StrokeKind::kEllipse) p = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.3, 0}};
  if (kind == StrokeKind::kBezier) p = {{0, 0, 0}, {0.3, 0.3, 0}, {0.6, -0.2, 0.1}, {1, 0, 0}};
  const MatrixXd a = 0.5 * MatrixXd::Random(3 * p.size(), 3 * p.size()) +
                     MatrixXd::Identity(3 * p.size(), 3 * p.size());
  const MatrixXd covariance = sigma * sigma * a * a.transpose();
  const auto add = [&](Sketch* s, const std::vector<Vector3d>& points) {
    std::vector<Vector3d> q;
    for (const Vector3d& x : points) q.push_back(r * x);
    if (is_closed(kind)) {
      s->add_stroke(kind, -1, -1, q);
    } else {
      const int b = s->add_node(q.front()), e = s->add_node(q.back());
      s->add_stroke(kind, b, e, {q.begin() + 1, q.end() - 1});
    }
  };
  add(&c.nominal, p);
  for (Vector3d& x : p) x += 2 * sigma * random->point();
  add(&c.measured, p);
  Evidence& e = c.measured.evidence[0];
  e.covariance = upper_triangle(covariance);
  e.determined = int(covariance.rows());
  e.sigma = sigma;
  c.tolerance = sigma * (1.5 + 4 * std::abs(random->uniform()));
  return c;
}

// Draws of the control points themselves, held against the nominal curve: nothing is linear here.
double drawn_share(const Case& c, const EdgeMatch& match, Random* random) {
  constexpr int kDrawn = 250, kPlaces = 30;
  const MatrixXd covariance = from_upper_triangle(c.measured.evidence[0].covariance);
  const MatrixXd root = covariance.llt().matrixL();
  double from = 1, to = 0;
  for (const EdgePlace& p : match.places)
    if (p.stroke >= 0) from = std::min(from, p.t), to = std::max(to, p.t);
  const ControlPoints controls = control_points(c.measured, 0);
  int within = 0;
  for (int i = 0; i < kDrawn; ++i) {
    Eigen::VectorXd z(covariance.rows());
    for (int k = 0; k < z.size(); ++k) z[k] = random->noise();
    const Eigen::VectorXd d = root * z;
    ControlPoints moved = controls;
    for (int k = 0; k < moved.count; ++k) moved.p[k] += d.segment<3>(3 * k);
    bool all = true;
    for (int k = 0; k <= kPlaces && all; ++k) {
      const double t = from + (to - from) * k / kPlaces;
      Vector3d x, dx;
      evaluate_curve<double>(c.measured.strokes[0].kind, moved.p.data(), t, &x, &dx);
      const ClosestPoint near = distance_to_stroke(c.nominal, 0, x);
      // What slides over the end of the nominal curve is not across it.
      Vector3d y, dy;
      evaluate_stroke(c.nominal, 0, near.t, &y, &dy);
      const Vector3d u = dy.normalized(), gap = x - y;
      all = (gap - u * u.dot(gap)).norm() <= c.tolerance;
    }
    within += all;
  }
  return double(within) / kDrawn;
}

TEST(Tube, BoundsEncloseDrawsOfTheControlPointsOfAThousandStrokes) {
  constexpr int kCases = 1000;
  std::srand(1);  // of Eigen's Random()
  Random random;
  const SigmaModel plain;  // without a footprint, covariances are taken as they are
  double low_gap = 0, high_gap = 0, off = 0, outside = 0;
  for (int i = 0; i < kCases; ++i) {
    const Case c = make_case(&random, i);
    const Nominal nominal = make_nominal(c.nominal, "part");
    const Association a = associate(c.measured, nominal, {});
    ASSERT_EQ(a.edges[0].presence, Presence::kFound) << i;
    const bool straight = c.nominal.strokes[0].kind == StrokeKind::kLine;
    DeviationModel model = piece_errors(c.measured, places_beside(a.edges[0], 0, straight ? 2 : 13),
                                        c.nominal.strokes[0].kind, true, plain)
                               .model;
    model.between = straight ? 1 : 0.95;
    TubeProbability within;
    bound_tube({one(model)}, c.tolerance, &within);
    within.likely = share_within(draw_largest({one(model)}), c.tolerance);
    const double drawn = drawn_share(c, a.edges[0], &random);
    const double chance = 3.5 * std::sqrt(std::max(drawn * (1 - drawn), 0.01) / 250);
    EXPECT_LE(within.low, drawn + chance) << i;
    EXPECT_GE(within.high, drawn - chance) << i;
    EXPECT_LE(within.low, within.likely + 0.02) << i;
    EXPECT_GE(within.high, within.likely - 0.02) << i;
    low_gap += (drawn - within.low) / kCases;
    high_gap += (within.high - drawn) / kCases;
    off += std::abs(within.likely - drawn) / kCases;
    outside += drawn < within.low || drawn > within.high;
  }
  RecordProperty("mean gap below", std::to_string(low_gap));
  RecordProperty("mean gap above", std::to_string(high_gap));
  std::printf(
      "bounds lie %.3f below and %.3f above what 250 draws say, the likely probability %.3f "
      "off, mean of %d strokes; %g lie outside by chance of the draws\n",
      low_gap, high_gap, off, kCases, outside);
  EXPECT_LT(off, 0.03);
  EXPECT_LT(outside, 0.02 * kCases);
}

}  // namespace
}  // namespace sketchsplat

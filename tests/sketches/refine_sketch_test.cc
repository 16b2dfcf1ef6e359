// SPDX-License-Identifier: MIT
#include "sketches/solve/refine_sketch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sketches/curve/closest.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/graph/smooth_joint.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Quadratics that want every sample at its target, across its tangent alone, as edgels do.
SampleQuadratics wish(const Samples& now, const Matrix3Xd& target, double strength = 1) {
  SampleQuadratics q;
  q.slope.resize(3, now.position.cols());
  for (int i = 0; i < now.position.cols(); ++i) {
    const Vector3d t = now.tangent.col(i);
    q.information.push_back(strength * (Matrix3d::Identity() - t * t.transpose()));
    q.slope.col(i) = q.information.back() * (now.position.col(i) - target.col(i));
  }
  return q;
}

// A line, an arc and a cubic joined end to end in a triangle.
Sketch triangle() {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0.1}), c = s.add_node({0.5, 0.9, 0});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kArc, b, c, {{0.9, 0.6, 0.1}});
  s.add_stroke(StrokeKind::kBezier, c, a, {{0.3, 0.7, 0.3}, {0.1, 0.2, -0.2}});
  return s;
}

TEST(RefineSketch, QuadraticsPullALineOntoItsTargets) {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  const SampleLayout layout = plan_samples(s, 0.05);
  const Samples now = evaluate_samples(s, layout);
  Matrix3Xd target = now.position;
  for (int i = 0; i < target.cols(); ++i)
    target.col(i) += Vector3d(0.4, 0.02 + 0.01 * target(0, i), -0.01);  // 0.4 along says nothing
  const RefineSketchResult r = refine_sketch(s, layout, wish(now, target));
  EXPECT_LT((r.sketch.nodes.col(0) - Vector3d(0, 0.02, -0.01)).norm(), 1e-4);
  EXPECT_LT((r.sketch.nodes.col(1) - Vector3d(1, 0.03, -0.01)).norm(), 1e-4);
  EXPECT_LT(r.final_cost, r.initial_cost);
  // Before the pull the targets cost this much more than what is reached.
  double expected = 0;
  for (int i = 0; i < target.cols(); ++i)
    expected -= (target.col(i) - now.position.col(i)).bottomRows<2>().squaredNorm();
  EXPECT_NEAR(r.final_cost - r.initial_cost, expected, 1e-3 * std::abs(expected));
}

TEST(RefineSketch, EveryKindReachesACurveOfItsKind) {
  const Sketch s = triangle();
  Sketch truth = s;
  truth.nodes.colwise() += Vector3d(0.004, -0.006, 0.005);
  truth.handles.colwise() += Vector3d(-0.005, 0.004, 0.006);
  const SampleLayout layout = plan_samples(s, 0.05);
  Sketch moved = s;
  for (int round = 0; round < 4; ++round) {  // tangents turn on the way
    const Samples now = evaluate_samples(moved, layout);
    moved =
        refine_sketch(moved, layout, wish(now, evaluate_samples(truth, layout).position)).sketch;
  }
  EXPECT_LT((moved.nodes - truth.nodes).cwiseAbs().maxCoeff(), 2e-4);
  for (int k = 0; k < s.size(); ++k)
    for (double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      Vector3d p, d;
      evaluate_stroke(moved, k, t, &p, &d);
      const Matrix3Xd curve = sample_stroke(truth, k, 1e-3);
      EXPECT_LT((curve.colwise() - p).colwise().norm().minCoeff(), 6e-4);
    }
}

TEST(RefineSketch, AnEllipticArcReachesItsEllipse) {
  const Vector3d centre(0.1, 0.2, 0.3), p(0.5, 0.1, 0), q(-0.1, 0.3, 0.1);
  const auto arc_of = [](const ControlPoints& c) {
    Sketch s;
    const int a = s.add_node(c.p[0]), b = s.add_node(c.p[3]);
    s.add_stroke(StrokeKind::kEllipticArc, a, b, {c.p[1], c.p[2]});
    return s;
  };
  for (double turn : {1.2, 3.0, 5.0}) {
    const ControlPoints start = elliptic_arc(centre, p, q, -0.2, turn);
    const Sketch truth = arc_of(
        elliptic_arc(centre, 1.02 * p + 0.01 * q, 0.97 * q + Vector3d(0, 0, 0.01), -0.2, turn));
    const Matrix3Xd curve = sample_stroke(truth, 0, 1e-3);
    Sketch moved = arc_of(start);
    for (int round = 0; round < 6; ++round) {
      const SampleLayout layout = plan_samples(moved, 0.03);
      const Samples now = evaluate_samples(moved, layout);
      Matrix3Xd target = now.position;
      for (int i = 0; i < target.cols(); ++i)
        target.col(i) = distance_to_stroke(truth, 0, now.position.col(i)).position;
      moved = refine_sketch(moved, layout, wish(now, target)).sketch;
    }
    for (double t : {0.05, 0.3, 0.5, 0.7, 0.95}) {
      Vector3d x, d;
      evaluate_stroke(moved, 0, t, &x, &d);
      EXPECT_LT((curve.colwise() - x).colwise().norm().minCoeff(), 1e-3) << turn << " at " << t;
    }
  }
}

// A wave as three cubics with tangents that miss one another, and targets with noise.
struct Wave {
  Sketch sketch;
  static Vector3d at(double x) { return {x, 0.3 * std::sin(2 * x), 0.1 * x * x}; }
  static Vector3d slope(double x) { return {1, 0.6 * std::cos(2 * x), 0.2 * x}; }
  Wave() {
    for (int k = 0; k <= 3; ++k) sketch.add_node(at(k));
    for (int k = 0; k < 3; ++k) {
      const double kink = 0.04;  // about 2 deg either way
      sketch.add_stroke(StrokeKind::kBezier, k, k + 1,
                        {at(k) + slope(k) / 3 + Vector3d(0, kink / 3, 0),
                         at(k + 1) - slope(k + 1) / 3 + Vector3d(0, kink / 3, 0)});
    }
  }
};
Matrix3Xd noisy_targets(const Samples& now, double sigma) {
  Matrix3Xd target = now.position;
  for (int i = 0; i < target.cols(); ++i) {
    double x = target(0, i);
    for (int k = 0; k < 20; ++k)
      x += (now.position.col(i) - Wave::at(x)).dot(Wave::slope(x)) / Wave::slope(x).squaredNorm();
    target.col(i) = Wave::at(x) + sigma * Vector3d(0, std::sin(37. * i), std::sin(53. * i + 1));
  }
  return target;
}
double rms_off_wave(const Sketch& s) {
  double sum = 0;
  int n = 0;
  for (int k = 0; k < s.size(); ++k)
    for (int i = 0; i <= 50; ++i, ++n) {
      Vector3d p, d;
      evaluate_stroke(s, k, i / 50.0, &p, &d);
      double x = p.x();
      for (int it = 0; it < 20; ++it)
        x += (p - Wave::at(x)).dot(Wave::slope(x)) / Wave::slope(x).squaredNorm();
      sum += (p - Wave::at(x)).squaredNorm();
    }
  return std::sqrt(sum / n);
}

TEST(RefineSketch, SmoothJointsOfANoisySplineEndBelowADegreeAndCostNothing) {
  const Wave wave;
  const double degree = M_PI / 180, sigma = 0.006;
  RefineSketchOptions smooth;
  smooth.smooth_angle = 8 * degree;
  smooth.smooth_weight = std::pow(sigma / (0.2 * degree), 2);
  Sketch with = wave.sketch, without = wave.sketch;
  for (int round = 0; round < 4; ++round)
    for (Sketch* s : {&with, &without}) {
      const SampleLayout layout = plan_samples(*s, 0.02);
      const Samples now = evaluate_samples(*s, layout);
      *s = refine_sketch(*s, layout, wish(now, noisy_targets(now, sigma)),
                         s == &with ? smooth : RefineSketchOptions())
               .sketch;
    }
  const auto worst = [](const Sketch& s) {
    double angle = 0;
    for (const SmoothJoint& j : find_smooth_joints(s, M_PI)) angle = std::max(angle, j.angle);
    return angle;
  };
  ASSERT_EQ(find_smooth_joints(with, M_PI).size(), 2u);
  EXPECT_GT(worst(wave.sketch), 2 * degree);
  EXPECT_GT(worst(without), 1 * degree) << "else this test shows nothing";
  EXPECT_LT(worst(with), 1 * degree);
  EXPECT_LT(rms_off_wave(with), 1.02 * rms_off_wave(without));
}

TEST(RefineSketch, ACornerIsNoSmoothJoint) {
  Wave wave;
  wave.sketch.handles.col(2) += Vector3d(0, 0, 0.3);  // some 40 deg
  EXPECT_EQ(find_smooth_joints(wave.sketch, 8 * M_PI / 180).size(), 1u);
  // Nor is one where a third stroke begins.
  const int n = wave.sketch.add_node({2, 2, 2});
  wave.sketch.add_stroke(StrokeKind::kLine, 2, n, {});
  EXPECT_EQ(find_smooth_joints(wave.sketch, 8 * M_PI / 180).size(), 0u);
}

TEST(RefineSketch, StrokesThatShareANodeStayJoined) {
  const Sketch s = triangle();
  const SampleLayout layout = plan_samples(s, 0.1);
  const Samples now = evaluate_samples(s, layout);
  Matrix3Xd target = now.position;
  target.row(2).array() += 0.02;
  const RefineSketchResult r = refine_sketch(s, layout, wish(now, target));
  ASSERT_EQ(r.sketch.nodes.cols(), 3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(r.sketch.strokes[k].begin, s.strokes[k].begin);
    EXPECT_EQ(r.sketch.strokes[k].end, s.strokes[k].end);
    EXPECT_NEAR(r.sketch.nodes(2, k) - s.nodes(2, k), 0.02, 2e-3);
  }
}

// At the least cost the gradient of the quadratics, pulled back to the control points, vanishes.
TEST(RefineSketch, StopsWhereTheGradientVanishes) {
  const Sketch s = triangle();
  const SampleLayout layout = plan_samples(s, 0.05);
  const Samples now = evaluate_samples(s, layout);
  Matrix3Xd target = now.position;
  for (int i = 0; i < target.cols(); ++i)
    target.col(i) += 0.01 * Vector3d(std::sin(2. * i), std::cos(3. * i), std::sin(5. * i));
  const SampleQuadratics q = wish(now, target);
  const auto gradient_norm = [&](const Sketch& at) {
    const Samples there = evaluate_samples(at, layout);
    Samples g = {Matrix3Xd::Zero(3, layout.size()), Matrix3Xd::Zero(3, layout.size())};
    for (int i = 0; i < layout.size(); ++i)
      g.position.col(i) =
          2 * q.information[i] * (there.position.col(i) - now.position.col(i)) + 2 * q.slope.col(i);
    const SketchGradient by = evaluate_samples_backward(at, layout, g);
    return std::hypot(by.nodes.norm(), by.handles.norm());
  };
  RefineSketchOptions free;
  free.stiffness = 1e-9;
  free.max_iterations = 100;
  const double before = gradient_norm(s);
  ASSERT_GT(before, 1e-3);
  EXPECT_LT(gradient_norm(refine_sketch(s, layout, q, free).sketch), 1e-2 * before);
}

TEST(RefineSketch, ScalesWithTheUnit) {
  for (double f : {1e-3, 1e3}) {
    Sketch s = triangle();
    const SampleLayout layout = plan_samples(s, 0.1);
    const Samples now = evaluate_samples(s, layout);
    Matrix3Xd target = now.position;
    target.row(1).array() += 0.01;
    const RefineSketchResult expected = refine_sketch(s, layout, wish(now, target));
    s.nodes *= f, s.handles *= f;
    const SampleLayout same = plan_samples(s, 0.1 * f);
    ASSERT_EQ(same.size(), layout.size());
    const RefineSketchResult r =
        refine_sketch(s, same, wish(evaluate_samples(s, same), f * target, 1 / (f * f)));
    EXPECT_LT((r.sketch.nodes / f - expected.sketch.nodes).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(r.final_cost, expected.final_cost, 1e-6 * std::abs(expected.final_cost));
  }
}

TEST(RefineSketch, WhereNothingIsWantedNothingMoves) {
  const Sketch s = triangle();
  const SampleLayout layout = plan_samples(s, 0.1);
  SampleQuadratics none;
  none.information.assign(layout.size(), Matrix3d::Zero());
  none.slope = Matrix3Xd::Zero(3, layout.size());
  const RefineSketchResult r = refine_sketch(s, layout, none);
  EXPECT_EQ(r.sketch.nodes, s.nodes);
  EXPECT_EQ(r.sketch.handles, s.handles);
  EXPECT_EQ(r.final_cost, 0);
  SampleQuadratics empty;
  empty.slope.resize(3, 0);
  EXPECT_EQ(refine_sketch(Sketch(), plan_samples(Sketch(), 0.1), empty).sketch.size(), 0);
}

TEST(RefineSketch, DegenerateStrokesDoNoHarm) {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0}), c = s.add_node({2, 0, 0});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kArc, b, c, {{1.5, 0, 0}});                       // straight
  s.add_stroke(StrokeKind::kBezier, c, c, {{2.5, 0.5, 0}, {2.5, -0.5, 0}});  // a loop
  s.add_stroke(StrokeKind::kCircle, -1, -1, {{0, 1, 0}, {0, 0, 0}});         // a point
  const int d = s.add_node({5, 5, 5}), e = s.add_node({5, 5, 5});
  s.add_stroke(StrokeKind::kLine, d, e, {});  // no length
  const SampleLayout layout = plan_samples(s, 0.1);
  const Samples now = evaluate_samples(s, layout);
  Matrix3Xd target = now.position;
  target.row(1).array() += 0.01;
  const RefineSketchResult r = refine_sketch(s, layout, wish(now, target));
  EXPECT_TRUE(r.sketch.nodes.allFinite());
  EXPECT_TRUE(r.sketch.handles.allFinite());
  EXPECT_NEAR(r.sketch.nodes(1, a), 0.01, 1e-3);
  SampleQuadratics nan = wish(now, target);
  nan.slope(1, 3) = std::nan("");
  const RefineSketchResult kept = refine_sketch(s, layout, nan);
  EXPECT_TRUE(kept.sketch.nodes.allFinite());
  EXPECT_NEAR(kept.sketch.nodes(1, a), 0.01, 1e-3) << "the other samples count";
}

}  // namespace
}  // namespace sketchsplat

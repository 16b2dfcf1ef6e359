// SPDX-License-Identifier: MIT
#include "sketches/curve/sample.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "sketches/curve/curve.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

TEST(PlanSamples, CountsByLengthAndAddsUpToIt) {
  const Sketch s = all_kinds();
  const double spacing = 0.017;
  const SampleLayout layout = plan_samples(s, spacing);
  ASSERT_EQ(int(layout.first.size()), s.size() + 1);
  EXPECT_EQ(layout.first.back(), layout.size());
  EXPECT_EQ(layout.t.size(), layout.stroke.size());
  EXPECT_EQ(layout.length.size(), layout.stroke.size());
  for (int i = 0; i < s.size(); ++i) {
    const double length = stroke_length(s, i);
    EXPECT_EQ(layout.first[i + 1] - layout.first[i], int(std::ceil(length / spacing)));
    double sum = 0;
    for (int k = layout.first[i]; k < layout.first[i + 1]; ++k) {
      EXPECT_EQ(layout.stroke[k], i);
      EXPECT_LE(layout.length[k], spacing);
      sum += layout.length[k];
    }
    EXPECT_NEAR(sum, length, 1e-12);
  }
}

TEST(PlanSamples, GivesEveryStrokeOneAtLeast) {
  const SampleLayout layout = plan_samples(all_kinds(), 1e6);
  EXPECT_EQ(layout.size(), 7);
  EXPECT_EQ(plan_samples(Sketch(), 1.0).size(), 0);
  EXPECT_EQ(plan_samples(Sketch(), 1.0).first.size(), 1u);
}

TEST(PlanSamples, ScalesWithTheUnitOfTheScene) {
  const SampleLayout one = plan_samples(all_kinds(), 0.05);
  for (double scale : {1e-3, 1e3}) {
    const Sketch s = moved(all_kinds(), scale, Eigen::Matrix3d::Identity(), {0, 0, 0});
    const SampleLayout layout = plan_samples(s, 0.05 * scale);
    ASSERT_EQ(layout.size(), one.size());
    for (int i = 0; i < one.size(); ++i) EXPECT_NEAR(layout.t[i], one.t[i], 1e-9);
  }
}

TEST(EvaluateSamples, GivesUnitTangentsAndZeroWhereTheCurveStandsStill) {
  Sketch s = all_kinds();
  const int n = s.add_node({7, 7, 7});
  s.add_stroke(StrokeKind::kLine, n, n, {});
  const SampleLayout layout = plan_samples(s, 0.1);
  const Samples samples = evaluate_samples(s, layout);
  for (int i = 0; i < layout.size(); ++i)
    EXPECT_NEAR(samples.tangent.col(i).norm(), layout.stroke[i] == 7 ? 0 : 1, 1e-14);
}

// A scalar of everything: weights for positions and tangents, and a square to be non-linear.
struct Objective {
  Matrix3Xd a, b;
  explicit Objective(int n) : a(3, n), b(3, n) {
    Random random;
    for (int i = 0; i < n; ++i) {
      a.col(i) = random.point();
      b.col(i) = random.point();
    }
  }
  double value(const Samples& s) const {
    return s.position.cwiseProduct(a).sum() + 0.5 * s.position.squaredNorm() +
           s.tangent.cwiseProduct(b).sum() + (s.tangent.array().cube() * a.array()).sum();
  }
  Samples gradient(const Samples& s) const {
    return {a + s.position, b + (3 * s.tangent.array().square() * a.array()).matrix()};
  }
};

void expect_central_differences(const Sketch& sketch, double tolerance) {
  const SampleLayout layout = plan_samples(sketch, 0.1);
  const Objective f(layout.size());
  const SketchGradient g =
      evaluate_samples_backward(sketch, layout, f.gradient(evaluate_samples(sketch, layout)));
  ASSERT_EQ(g.nodes.cols(), sketch.nodes.cols());
  ASSERT_EQ(g.handles.cols(), sketch.handles.cols());
  const double h = 1e-6;
  for (bool node : {true, false}) {
    const Matrix3Xd& expected = node ? g.nodes : g.handles;
    for (int i = 0; i < expected.size(); ++i) {
      double value[2];
      for (int side = 0; side < 2; ++side) {
        Sketch shifted = sketch;
        (node ? shifted.nodes : shifted.handles).data()[i] += side ? h : -h;
        value[side] = f.value(evaluate_samples(shifted, layout));
      }
      const double numeric = (value[1] - value[0]) / (2 * h);
      EXPECT_NEAR(expected.data()[i], numeric, tolerance * (1 + std::abs(numeric)))
          << (node ? "node " : "handle ") << i / 3 << " coordinate " << i % 3;
    }
  }
}

TEST(EvaluateSamplesBackward, AgreesWithCentralDifferencesOverSharedNodes) {
  expect_central_differences(all_kinds(), 1e-7);
}

TEST(EvaluateSamplesBackward, AgreesWithCentralDifferencesForAxisAlignedParts) {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kArc, b, a, {{0.5, 0.5, 0}});
  for (int k = 0; k < 3; ++k)
    s.add_stroke(StrokeKind::kCircle, -1, -1, {{0, 0, 0}, 0.3 * Vector3d::Unit(k)});
  s.add_stroke(StrokeKind::kEllipse, -1, -1, {{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}});
  expect_central_differences(s, 1e-7);
}

TEST(EvaluateSamplesBackward, KeepsTheApexOfAStraightArcAlive) {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0});
  s.add_stroke(StrokeKind::kArc, a, b, {{0.5, 0, 0}});
  expect_central_differences(s, 1e-5);
  s.handles(1, 0) = 1e-4;  // nearly straight
  expect_central_differences(s, 1e-5);
}

// The same chain in Jets, node by node: an oracle without a step width.
TEST(EvaluateSamplesBackward, AgreesWithJetsOfTheWholeChain) {
  using J = ceres::Jet<double, 1>;
  Random random;
  const Sketch sketch = moved(all_kinds(), 1.7, random.rotation(), random.point());
  const SampleLayout layout = plan_samples(sketch, 0.07);
  const Objective f(layout.size());
  const SketchGradient g =
      evaluate_samples_backward(sketch, layout, f.gradient(evaluate_samples(sketch, layout)));
  for (bool node : {true, false}) {
    const Matrix3Xd& expected = node ? g.nodes : g.handles;
    for (int i = 0; i < expected.size(); ++i) {
      J sum(0);
      for (int k = 0; k < layout.size(); ++k) {
        const Stroke& stroke = sketch.strokes[layout.stroke[k]];
        std::vector<Vec3<J>> c;
        const auto add = [&](const Matrix3Xd& m, int col, bool is_node) {
          c.push_back(m.col(col).cast<J>());
          if (is_node == node && col == i / 3) c.back()[i % 3].v[0] = 1;
        };
        if (!is_closed(stroke.kind)) add(sketch.nodes, stroke.begin, true);
        for (int h = 0; h < num_handles(stroke.kind); ++h)
          add(sketch.handles, stroke.handle + h, false);
        if (!is_closed(stroke.kind)) add(sketch.nodes, stroke.end, true);
        Vec3<J> p, d;
        evaluate_curve<J>(stroke.kind, c.data(), layout.t[k], &p, &d);
        const Vec3<J> u = d / sqrt(d.squaredNorm());
        for (int x = 0; x < 3; ++x)
          sum += p[x] * (f.a(x, k) + 0.5 * p[x]) + u[x] * (f.b(x, k) + u[x] * u[x] * f.a(x, k));
      }
      EXPECT_NEAR(expected.data()[i], sum.v[0], 1e-11 * (1 + std::abs(sum.v[0])));
    }
  }
}

TEST(EvaluateSamplesBackward, SumsWhatTheStrokesOfAJunctionSend) {
  Sketch s;
  const int hub = s.add_node({0, 0, 0});
  for (const Vector3d& p : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
    const int n = s.add_node(p);
    s.add_stroke(StrokeKind::kLine, hub, n, {});
  }
  const SampleLayout layout = plan_samples(s, 10);  // one sample in the middle of each
  Samples g;
  g.position = Matrix3Xd::Ones(3, layout.size());
  g.tangent = Matrix3Xd::Zero(3, layout.size());
  const SketchGradient out = evaluate_samples_backward(s, layout, g);
  EXPECT_LT((out.nodes.col(hub) - Vector3d(1.5, 1.5, 1.5)).norm(), 1e-15);
  EXPECT_LT((out.nodes.col(1) - Vector3d(0.5, 0.5, 0.5)).norm(), 1e-15);
}

TEST(EvaluateSamplesBackward, StaysFiniteForDegenerateStrokes) {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0});
  s.add_stroke(StrokeKind::kLine, a, a, {});
  s.add_stroke(StrokeKind::kArc, a, a, {{0, 0, 0}});
  s.add_stroke(StrokeKind::kArc, a, a, {{1, 0, 0}});
  s.add_stroke(StrokeKind::kArc, a, b, {{0.3, 0, 0}});
  s.add_stroke(StrokeKind::kArc, a, b, {{0.3, 1e-9, 0}});
  s.add_stroke(StrokeKind::kBezier, a, a, {{0, 0, 0}, {0, 0, 0}});
  s.add_stroke(StrokeKind::kBezier, a, b, {{1, 1, 0}, {0, 1, 0}});  // cusp in the middle
  s.add_stroke(StrokeKind::kEllipticArc, a, a, {{0, 0, 0}, {0, 0, 0}});
  s.add_stroke(StrokeKind::kEllipticArc, a, a, {{1, 0, 0}, {0.6, 0, 0}});
  s.add_stroke(StrokeKind::kEllipticArc, a, b, {{0.3, 0, 0}, {0.4, 0, 0}});
  s.add_stroke(StrokeKind::kEllipticArc, a, b, {{0.5, 1e-9, 0}, {0.5, 1, 0}});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {{0, 0, 0}, {0, 0, 0}});
  s.add_stroke(StrokeKind::kEllipse, -1, -1, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  for (double spacing : {10.0, 0.01}) {
    const SampleLayout layout = plan_samples(s, spacing);
    const Samples samples = evaluate_samples(s, layout);
    EXPECT_TRUE(samples.position.allFinite() && samples.tangent.allFinite());
    const SketchGradient g =
        evaluate_samples_backward(s, layout, Objective(layout.size()).gradient(samples));
    EXPECT_TRUE(g.nodes.allFinite());
    EXPECT_TRUE(g.handles.allFinite());
  }
}

}  // namespace
}  // namespace sketchsplat

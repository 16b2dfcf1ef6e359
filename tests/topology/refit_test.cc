// SPDX-License-Identifier: MIT
#include "topology/core/refit.h"

#include "tests/topology/build_sketch.h"

namespace sketchsplat {
namespace {

Run points(const std::vector<Vector3d>& p) {
  Run r{Eigen::Matrix3Xd(3, p.size()), Eigen::VectorXd::Ones(p.size())};
  for (size_t k = 0; k < p.size(); ++k) r.position.col(k) = p[k];
  return r;
}

TEST(Refit, ALineMinimisesSquaredDistances) {
  const auto line = refit_line({points({{0, 1, 0}, {0, -1, 0}, {10, 1, 0}, {10, -1, 0}})});
  ASSERT_TRUE(line);
  EXPECT_LT(std::abs(line->p[0].y()) + std::abs(line->p[1].y()), 1e-12);
  EXPECT_NEAR((line->p[1] - line->p[0]).norm(), 10, 1e-12);
}

TEST(Refit, PointsThatCoincideGiveNothing) {
  const auto same = points({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
  const Eigen::Vector4d t(0, 0.3, 0.6, 1);
  EXPECT_FALSE(refit_line({same}));
  EXPECT_FALSE(refit_circle(same));
  EXPECT_FALSE(refit_arc({same}, 0));
  EXPECT_FALSE(refit_bezier(same, t));
  EXPECT_FALSE(refit_ellipse(same, t));
}

TEST(Refit, PointsOnALineGiveNoCircle) {
  EXPECT_FALSE(refit_circle(points({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}})));
}

TEST(Refit, AnArcOfMoreThanHalfACircleIsRecovered) {
  Sketch s;
  add_arc(&s, {3, 4, 5}, 7, 20, 310);
  const Eigen::Matrix3Xd p = sample_stroke(s, 0, 0.5);
  const auto arc = refit_arc({{p, Eigen::VectorXd::Ones(p.cols())}}, 0);
  ASSERT_TRUE(arc);
  ASSERT_EQ(arc->kind, StrokeKind::kArc);
  EXPECT_LT(max_distance(*arc, p), 1e-9);
  EXPECT_NEAR(sample_curve(*arc).length, stroke_length(s, 0), 1e-9);
}

TEST(Refit, ACurveBetweenItsEndsComesBackToItsPointsInAnyOrder) {
  Sketch s;
  add_bezier(&s, {0, 0, 0}, {10, 30, 0}, {40, 30, 10}, {50, 0, 20});
  add_arc(&s, {0, 0, 0}, 20, 0, 130);
  for (int i : {0, 1}) {
    Eigen::Matrix3Xd p = sample_stroke(s, i, 1).rowwise().reverse();
    p.col(0).swap(p.col(p.cols() / 2));
    PlainCurve curve = plain_curve(s, i);
    curve.p[1] += Vector3d(1, -2, 0.5);
    ASSERT_GT(max_distance(curve, p), 0.5);
    EXPECT_LT(max_distance(refit_between(curve, p), p), 0.1) << kind_name(curve.kind);
    // What the points do not tell stays.
    const PlainCurve same = refit_between(curve, p.leftCols(i == 0 ? 1 : 0));
    EXPECT_EQ(same.p[1], curve.p[1]);
  }
}

TEST(Refit, ACubicIsRecoveredFromChordLengths) {
  Sketch s;
  add_bezier(&s, {0, 0, 0}, {1, 3, 0}, {4, 3, 1}, {5, 0, 2});
  const Eigen::Matrix3Xd p = sample_stroke(s, 0, 0.1);
  const int n = int(p.cols());
  const auto cubic =
      refit_bezier({p, Eigen::VectorXd::Ones(n)}, Eigen::VectorXd::LinSpaced(n, 0, 1));
  ASSERT_TRUE(cubic);
  EXPECT_LT(max_distance(*cubic, p), 0.01);
}

TEST(PlainCurve, NearestPointsLieOnTheCurveAtARightAngle) {
  std::vector<PlainCurve> curves(5);
  curves[0].p = {Vector3d(0, 0, 0), Vector3d(9, 1, 0)};
  curves[1].kind = StrokeKind::kArc;
  curves[1].p = {Vector3d(0, 0, 0), Vector3d(4, 6, 0), Vector3d(8, 0, 0)};
  curves[2].kind = StrokeKind::kCircle;
  curves[2].p = {Vector3d(1, 0, 0), Vector3d(0, 3, 4)};
  curves[3].kind = StrokeKind::kEllipse;
  curves[3].p = {Vector3d(1, 0, 0), Vector3d(6, 0, 0), Vector3d(0, 4, 0)};
  curves[4].kind = StrokeKind::kBezier;
  curves[4].p = {Vector3d(0, 0, 0), Vector3d(2, 6, 0), Vector3d(7, 6, 3), Vector3d(9, 0, 0)};
  for (const PlainCurve& c : curves) {
    const CurveSamples samples = sample_curve(c), fine = sample_curve(c, 2000);
    for (const Vector3d& q : {Vector3d(3, 2, 1), Vector3d(5, 5, 0), Vector3d(-4, 1, 1)}) {
      const Closest got = closest_point(c, samples, q);
      const double best = (fine.position.colwise() - q).colwise().norm().minCoeff();
      EXPECT_NEAR(got.distance, best, 2e-3) << kind_name(c.kind);
      EXPECT_LE(got.distance, best + 1e-6) << kind_name(c.kind);
    }
  }
}

}  // namespace
}  // namespace sketchsplat

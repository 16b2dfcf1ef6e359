// SPDX-License-Identifier: MIT
#include "sketches/curve/curve.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "sketches/curve/conic.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

Vector3d point_at(const Sketch& s, int stroke, double t) {
  Vector3d p, d;
  evaluate_stroke(s, stroke, t, &p, &d);
  return p;
}

Sketch one_stroke(StrokeKind kind, const std::vector<Vector3d>& c) {
  Sketch s;
  if (is_closed(kind)) {
    s.add_stroke(kind, -1, -1, c);
  } else {
    const int a = s.add_node(c.front()), b = s.add_node(c.back());
    s.add_stroke(kind, a, b, {c.begin() + 1, c.end() - 1});
  }
  return s;
}

// Arc about the origin in the plane of x and y, of this angle from the x axis.
Sketch unit_arc(double angle) {
  const auto on = [](double a) { return Vector3d(std::cos(a), std::sin(a), 0); };
  return one_stroke(StrokeKind::kArc, {on(0), on(angle / 2), on(angle)});
}

TEST(Arc, RunsOnItsCircleAtConstantSpeed) {
  for (double degrees : {1e-3, 1.0, 90.0, 180.0, 270.0, 359.0}) {
    const double angle = degrees * M_PI / 180;
    const Sketch s = unit_arc(angle);
    for (double t : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0}) {
      const Vector3d expected(std::cos(angle * t), std::sin(angle * t), 0);
      EXPECT_LT((point_at(s, 0, t) - expected).norm(), 1e-9) << degrees << " deg at " << t;
      Vector3d p, d;
      evaluate_stroke(s, 0, t, &p, &d);
      EXPECT_NEAR(d.norm(), angle, 1e-7 * angle) << degrees << " deg at " << t;
    }
    EXPECT_NEAR(stroke_length(s, 0), angle, 1e-7 * angle) << degrees << " deg";
  }
}

TEST(Arc, PassesThroughAnApexThatIsNotInTheMiddle) {
  // Only what of the apex is square to the chord counts: a slide along the chord changes nothing.
  const Sketch s = one_stroke(StrokeKind::kArc, {{-1, 0, 0}, {0, 0, 0.5}, {1, 0, 0}});
  const Sketch slid = one_stroke(StrokeKind::kArc, {{-1, 0, 0}, {0.7, 0, 0.5}, {1, 0, 0}});
  for (double t : {0.2, 0.5, 0.9})
    EXPECT_LT((point_at(s, 0, t) - point_at(slid, 0, t)).norm(), 1e-15);
  EXPECT_LT((point_at(s, 0, 0.5) - Vector3d(0, 0, 0.5)).norm(), 1e-15);
}

TEST(Arc, BecomesALineWithoutAJump) {
  double last = 1;
  for (double sagitta : {1e-3, 1e-5, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 0.0}) {
    const Sketch s = one_stroke(StrokeKind::kArc, {{0, 0, 0}, {0.5, sagitta, 0}, {1, 0, 0}});
    const Vector3d middle = point_at(s, 0, 0.5), quarter = point_at(s, 0, 0.25);
    EXPECT_NEAR(middle.y(), sagitta, 1e-15) << sagitta;
    EXPECT_NEAR(quarter.y(), 0.75 * sagitta, 1e-15 + sagitta * sagitta) << sagitta;
    EXPECT_NEAR(quarter.x(), 0.25, 1e-12 + sagitta * sagitta) << sagitta;
    EXPECT_LE(stroke_length(s, 0), last + 1e-15 + 4 * last * last);
    EXPECT_NEAR(stroke_length(s, 0), 1 + 8.0 / 3 * sagitta * sagitta, 1e-10) << sagitta;
    last = stroke_length(s, 0);
  }
}

TEST(Circle, KeepsItsRadiusAndPlaneAndTurnsAboutItsAxis) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Vector3d centre = random.point(), axis = random.point();
    const Sketch s = one_stroke(StrokeKind::kCircle, {centre, axis});
    for (double t : {0.0, 0.3, 0.77}) {
      Vector3d p, d;
      evaluate_stroke(s, 0, t, &p, &d);
      EXPECT_NEAR((p - centre).norm(), axis.norm(), 1e-14);
      EXPECT_NEAR((p - centre).dot(axis), 0, 1e-14);
      EXPECT_LT(((p - centre).cross(d) - 2 * M_PI * axis.norm() * axis).norm(), 1e-12);
    }
  }
}

TEST(Circle, DoesNotLeapWhenTheAxisOfAPartTurnsALittle) {
  for (const Vector3d& axis :
       {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(1, 1, 0),
        Vector3d(0, 1, -1), Vector3d(1, 0, 1), Vector3d(1, 1, 1), Vector3d(-1, 1, 1)})
    for (int k = 0; k < 3; ++k)
      for (double sign : {-1.0, 1.0}) {
        const Vector3d turned = axis + sign * 1e-6 * Vector3d::Unit(k);
        const Sketch a = one_stroke(StrokeKind::kCircle, {{0, 0, 0}, axis});
        const Sketch b = one_stroke(StrokeKind::kCircle, {{0, 0, 0}, turned});
        EXPECT_LT((point_at(a, 0, 0.1) - point_at(b, 0, 0.1)).norm(), 1e-5) << axis.transpose();
      }
}

TEST(Ellipse, MeetsItsConjugateSemiAxes) {
  const Vector3d c(1, 2, 3), u(0.5, 0.1, 0), v(0.2, 0.7, -0.3);
  const Sketch s = one_stroke(StrokeKind::kEllipse, {c, u, v});
  EXPECT_LT((point_at(s, 0, 0) - c - u).norm(), 1e-15);
  EXPECT_LT((point_at(s, 0, 0.25) - c - v).norm(), 1e-15);
  EXPECT_LT((point_at(s, 0, 0.5) - c + u).norm(), 1e-15);
}

TEST(Ellipse, HasPrincipalAxesThatDrawTheSameCurve) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const Vector3d u = random.point(), v = random.point();
    const EllipseAxes axes = principal_axes(u, v);
    EXPECT_NEAR(axes.major.dot(axes.minor), 0, 1e-14);
    EXPECT_GE(axes.major.norm(), axes.minor.norm() - 1e-15);
    EXPECT_LT((axes.major.cross(axes.minor) - u.cross(v)).norm(), 1e-14);
    for (double a : {0.3, 2.0, 5.0}) {  // a point of the curve in the frame of the axes
      const Vector3d p = std::cos(a) * u + std::sin(a) * v;
      const double x = p.dot(axes.major) / axes.major.squaredNorm();
      const double y = p.dot(axes.minor) / axes.minor.squaredNorm();
      EXPECT_NEAR(x * x + y * y, 1, 1e-9);
    }
  }
}

TEST(Bezier, MeetsDeCasteljau) {
  const Vector3d p[4] = {{0, 0, 0}, {1, 2, 0.5}, {2, -1, 1}, {3, 1, 0}};
  const Sketch s = one_stroke(StrokeKind::kBezier, {p[0], p[1], p[2], p[3]});
  for (double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    Vector3d q[4] = {p[0], p[1], p[2], p[3]};
    for (int round = 3; round > 0; --round)
      for (int i = 0; i < round; ++i) q[i] = (1 - t) * q[i] + t * q[i + 1];
    EXPECT_LT((point_at(s, 0, t) - q[0]).norm(), 1e-15);
  }
}

TEST(Derivative, AgreesWithCentralDifferencesForAllKinds) {
  Random random;
  const Sketch s = moved(all_kinds(), 2.0, random.rotation(), random.point());
  const double h = 1e-6;
  for (int i = 0; i < s.size(); ++i)
    for (double t : {0.05, 0.31, 0.5, 0.93}) {
      Vector3d p, d;
      evaluate_stroke(s, i, t, &p, &d);
      const Vector3d numeric = (point_at(s, i, t + h) - point_at(s, i, t - h)) / (2 * h);
      EXPECT_LT((d - numeric).norm(), 1e-7 * (1 + d.norm())) << kind_name(s.strokes[i].kind);
    }
}

TEST(Jets, CarryTheSameValuesAndTheDerivativesByTheControlPoints) {
  using J = ceres::Jet<double, 12>;
  const Sketch s = all_kinds();
  for (int i = 0; i < s.size(); ++i) {
    const StrokeKind kind = s.strokes[i].kind;
    const ControlPoints c = control_points(s, i);
    Vec3<J> control[4], position, derivative;
    for (int k = 0; k < c.count; ++k)
      for (int x = 0; x < 3; ++x) control[k][x] = J(c.p[k][x], 3 * k + x);
    evaluate_curve<J>(kind, control, 0.37, &position, &derivative);
    for (int k = 0; k < c.count; ++k)
      for (int x = 0; x < 3; ++x) {
        const double h = 1e-6;
        Vector3d p[2], d[2];
        for (int side = 0; side < 2; ++side) {
          ControlPoints shifted = c;
          shifted.p[k][x] += side ? h : -h;
          evaluate_curve<double>(kind, shifted.p.data(), 0.37, &p[side], &d[side]);
        }
        for (int y = 0; y < 3; ++y) {
          EXPECT_NEAR(position[y].v[3 * k + x], (p[1][y] - p[0][y]) / (2 * h), 1e-7);
          EXPECT_NEAR(derivative[y].v[3 * k + x], (d[1][y] - d[0][y]) / (2 * h), 1e-6);
        }
      }
  }
}

TEST(Length, AgreesWithClosedForms) {
  EXPECT_DOUBLE_EQ(stroke_length(one_stroke(StrokeKind::kLine, {{0, 0, 0}, {3, 4, 0}}), 0), 5);
  EXPECT_NEAR(stroke_length(one_stroke(StrokeKind::kCircle, {{1, 1, 1}, {0, 0, 2}}), 0), 4 * M_PI,
              1e-13);
  // A parabola y = x^2 on [0, 1] as a cubic: sqrt(5) / 2 + asinh(2) / 4.
  const Sketch parabola = one_stroke(
      StrokeKind::kBezier, {{0, 0, 0}, {1.0 / 3, 0, 0}, {2.0 / 3, 1.0 / 3, 0}, {1, 1, 0}});
  EXPECT_NEAR(stroke_length(parabola, 0), std::sqrt(5) / 2 + std::asinh(2.0) / 4, 1e-12);
  // Semi-axes 2 and 1: 8 E(m = 3/4).
  const Sketch ellipse = one_stroke(StrokeKind::kEllipse, {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  EXPECT_NEAR(stroke_length(ellipse, 0), 8 * std::comp_ellint_2(std::sqrt(0.75)), 1e-9);
  const Sketch thin = one_stroke(StrokeKind::kEllipse, {{0, 0, 0}, {1, 0, 0}, {0, 0.01, 0}});
  EXPECT_NEAR(stroke_length(thin, 0), 4 * std::comp_ellint_2(std::sqrt(1 - 1e-4)), 1e-9);
}

TEST(ArcLengthParameters, DivideEveryKindEvenly) {
  const Sketch s = all_kinds();
  const std::vector<double> fractions = {0.0, 0.1, 0.25, 0.5, 0.9, 1.0};
  for (int i = 0; i < s.size(); ++i) {
    const std::vector<double> t = arc_length_parameters(s, i, fractions);
    ASSERT_EQ(t.size(), fractions.size());
    EXPECT_EQ(t.front(), 0);
    EXPECT_EQ(t.back(), 1);
    for (size_t k = 1; k < t.size(); ++k) {
      double length = 0;  // a polyline fine enough for 1e-6
      const int n = 2000;
      for (int j = 0; j < n; ++j)
        length += (point_at(s, i, t[k] * (j + 1) / n) - point_at(s, i, t[k] * j / n)).norm();
      EXPECT_NEAR(length / stroke_length(s, i), fractions[k], 2e-6) << kind_name(s.strokes[i].kind);
    }
  }
}

TEST(SampleStroke, KeepsTheSpacingAndBothEnds) {
  const Sketch s = all_kinds();
  for (int i = 0; i < s.size(); ++i) {
    const double spacing = 0.013;
    const Eigen::Matrix3Xd points = sample_stroke(s, i, spacing);
    EXPECT_EQ(points.cols(), int(std::ceil(stroke_length(s, i) / spacing)) + 1);
    EXPECT_LT((points.col(0) - point_at(s, i, 0)).norm(), 1e-15);
    EXPECT_LT((points.rightCols(1) - point_at(s, i, 1)).norm(), 1e-15);
    for (int k = 1; k < points.cols(); ++k)
      EXPECT_LE((points.col(k) - points.col(k - 1)).norm(), spacing * (1 + 1e-6));
  }
  EXPECT_EQ(sample_stroke(s, 0, 1e9).cols(), 2);
}

TEST(DegenerateCurves, StayFinite) {
  const Vector3d o(1, 2, 3);
  const std::vector<Sketch> cases = {
      one_stroke(StrokeKind::kLine, {o, o}),
      one_stroke(StrokeKind::kArc, {o, o, o}),
      one_stroke(StrokeKind::kArc, {o, Vector3d(2, 2, 3), o}),                  // no chord
      one_stroke(StrokeKind::kArc, {o, Vector3d(2, 2, 3), Vector3d(3, 2, 3)}),  // straight
      one_stroke(StrokeKind::kCircle, {o, {0, 0, 0}}),
      one_stroke(StrokeKind::kEllipse, {o, {0, 0, 0}, {0, 0, 0}}),
      one_stroke(StrokeKind::kEllipse, {o, {1, 0, 0}, {2, 0, 0}}),
      one_stroke(StrokeKind::kEllipticArc, {o, o, o, o}),
      one_stroke(StrokeKind::kEllipticArc, {o, Vector3d(2, 2, 3), o, o}),          // no chord
      one_stroke(StrokeKind::kEllipticArc, {o, Vector3d(2, 2, 3), o, {3, 2, 3}}),  // straight
      one_stroke(StrokeKind::kEllipticArc,
                 {o, {2, 3, 3}, {2, 9, 3}, {3, 2, 3}}),  // quarter far off
      one_stroke(StrokeKind::kBezier, {o, o, o, o}),
      one_stroke(StrokeKind::kBezier, {o, o, {2, 2, 3}, {2, 2, 3}}),                 // coincident
      one_stroke(StrokeKind::kBezier, {o, {4, 2, 3}, {0, 2, 3}, {2, 2, 3}}),         // collinear
      one_stroke(StrokeKind::kBezier, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}})  // a cusp
  };
  for (size_t c = 0; c < cases.size(); ++c) {
    EXPECT_TRUE(std::isfinite(stroke_length(cases[c], 0))) << c;
    double before = 0;
    for (double t : arc_length_parameters(cases[c], 0, {0, 0.1, 0.3, 0.5, 0.7, 1})) {
      EXPECT_GE(t, before) << c;
      EXPECT_LE(t, 1) << c;
      before = t;
      Vector3d p, d;
      evaluate_stroke(cases[c], 0, t, &p, &d);
      EXPECT_TRUE(p.allFinite() && d.allFinite()) << c;
    }
    EXPECT_TRUE(sample_stroke(cases[c], 0, 0.1).allFinite()) << c;
  }
}

TEST(DegenerateCurves, DivideACuspEvenlyAllTheSame) {
  const Sketch s = one_stroke(StrokeKind::kBezier, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}});
  const std::vector<double> t = arc_length_parameters(s, 0, {0.25, 0.5, 0.75});
  EXPECT_NEAR(t[1], 0.5, 1e-6);
  EXPECT_NEAR(t[0] + t[2], 1, 1e-9);
  // With w = 1 - 2 t the speed is 3 |w| sqrt(w^2 + 1).
  EXPECT_NEAR(stroke_length(s, 0), 2 * std::sqrt(2.0) - 1, 1e-9);
}

}  // namespace
}  // namespace sketchsplat

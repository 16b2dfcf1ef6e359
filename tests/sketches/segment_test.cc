// SPDX-License-Identifier: MIT
#include "sketches/fit/segment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
constexpr double kUnit = 0.01;  // points are about two units apart

// A run of points with tangents, as lifted edgels are: noise, and signs of tangents by chance.
struct Points {
  Matrix3Xd points, tangents;

  int size() const { return int(points.cols()); }
  void add(const Vector3d& p, const Vector3d& t) {
    points.conservativeResize(3, size() + 1);
    tangents.conservativeResize(3, points.cols());
    const int i = size() - 1;
    points.col(i) =
        p + 0.1 * kUnit * Vector3d(std::sin(7. * i), std::sin(5. * i + 1), std::sin(3. * i + 2));
    tangents.col(i) = (i % 3 == 1 ? -1 : 1) * t.normalized();
  }
  // Points of p(t), t from `from` to `to`, both included.
  void add_curve(const std::function<Vector3d(double)>& p, double from, double to, int count) {
    for (int i = 0; i < count; ++i) {
      const double t = from + (to - from) * i / (count - 1), h = 1e-5 * (to - from);
      add(p(t), p(t + h) - p(t - h));
    }
  }
  Sketch segmented(bool closed = false) const {
    Sketch s;
    segment_chain(points, tangents, closed, kUnit, {}, &s);
    return s;
  }
  // Share of the points that lie within a unit of the strokes.
  double covered(const Sketch& s) const {
    int near = 0;
    for (int i = 0; i < size(); ++i) {
      double best = 1e300;
      for (int k = 0; k < s.size(); ++k)
        best = std::min(best, (sample_stroke(s, k, 0.2 * kUnit).colwise() - points.col(i))
                                  .colwise()
                                  .norm()
                                  .minCoeff());
      near += best < kUnit;
    }
    return double(near) / size();
  }
};

Vector3d on_circle(double deg) {
  const double a = deg * M_PI / 180;
  return Vector3d(0.3, 0.2, 0.1) + 0.4 * std::cos(a) * Vector3d(0.8, 0, 0.6) +
         0.4 * std::sin(a) * Vector3d::UnitY();
}

int count_of(const Sketch& s, StrokeKind kind) {
  int n = 0;
  for (const Stroke& stroke : s.strokes) n += stroke.kind == kind;
  return n;
}

TEST(SegmentChain, AStraightRunIsOneLine) {
  Points run;
  run.add_curve([](double t) { return Vector3d(t, 0.3 * t, -0.2 * t); }, 0, 1, 50);
  const Sketch s = run.segmented();
  ASSERT_EQ(s.size(), 1);
  EXPECT_EQ(s.strokes[0].kind, StrokeKind::kLine);
  EXPECT_NEAR(stroke_length(s, 0), std::sqrt(1.13), kUnit);
  EXPECT_TRUE(validate(s).empty());
}

TEST(SegmentChain, AnLShapeIsCutAtItsCornerIntoTwoLines) {
  Points run;
  run.add_curve([](double t) { return Vector3d(t, 0, 0); }, 0, 0.5, 25);
  run.add_curve([](double t) { return Vector3d(0.5, t, 0.1 * t); }, 0.02, 0.4, 20);
  const Sketch s = run.segmented();
  ASSERT_EQ(s.size(), 2);
  EXPECT_EQ(count_of(s, StrokeKind::kLine), 2);
  EXPECT_LT((s.nodes.col(s.strokes[0].end) - Vector3d(0.5, 0, 0)).norm(), 2 * kUnit);
  EXPECT_LT((s.nodes.col(s.strokes[1].begin) - Vector3d(0.5, 0.02, 0)).norm(), 2 * kUnit);
}

TEST(SegmentChain, AClosedSquareIsFourLinesWhereverTheRunBegins) {
  Points run;
  const Vector3d corner[] = {{0, 0, 0}, {0.4, 0, 0}, {0.4, 0.4, 0}, {0, 0.4, 0}};
  for (int k = 0; k < 5; ++k) {  // from the middle of a side
    const Vector3d a = corner[k % 4], b = corner[(k + 1) % 4];
    run.add_curve([&](double t) { return Vector3d(a + t * (b - a)); }, k == 0 ? 0.5 : 0.03,
                  k == 4 ? 0.47 : 0.97, k == 0 || k == 4 ? 9 : 18);
  }
  const Sketch s = run.segmented(true);
  EXPECT_EQ(s.size(), 4);
  EXPECT_EQ(count_of(s, StrokeKind::kLine), 4);
}

TEST(SegmentChain, AClosedCircleIsOneCircle) {
  Points run;
  run.add_curve(on_circle, 20, 375, 100);
  const Sketch s = run.segmented(true);
  ASSERT_EQ(s.size(), 1);
  ASSERT_EQ(s.strokes[0].kind, StrokeKind::kCircle);
  EXPECT_NEAR(s.handles.col(s.strokes[0].handle + 1).norm(), 0.4, 0.1 * kUnit);
  EXPECT_LT((s.handles.col(s.strokes[0].handle) - Vector3d(0.3, 0.2, 0.1)).norm(), 0.1 * kUnit);
}

TEST(SegmentChain, AnOpenRunAroundMostOfACircleIsACircleOrAnArcAndNeverNothing) {
  for (double to : {200., 270., 320., 340., 350., 355., 359.}) {
    Points run;
    run.add_curve(on_circle, 0, to, 100);
    const Sketch s = run.segmented();
    ASSERT_EQ(s.size(), 1) << to;
    EXPECT_TRUE(s.strokes[0].kind == StrokeKind::kCircle || s.strokes[0].kind == StrokeKind::kArc);
    EXPECT_EQ(run.covered(s), 1) << to;
    const double turned = is_closed(s.strokes[0].kind) ? 360 : to;
    EXPECT_NEAR(stroke_length(s, 0), 0.4 * turned * M_PI / 180, 2 * kUnit) << to;
    EXPECT_TRUE(to > 330 || turned == to) << to;
  }
}

TEST(SegmentChain, AShortArcIsAnArcWithItsRadius) {
  Points run;
  run.add_curve(on_circle, 10, 100, 35);
  const Sketch s = run.segmented();
  ASSERT_EQ(s.size(), 1);
  ASSERT_EQ(s.strokes[0].kind, StrokeKind::kArc);
  const ControlPoints c = control_points(s, 0);
  EXPECT_NEAR(arc_frame<double>(c.p[0], c.p[1], c.p[2]).radius, 0.4, kUnit);
}

TEST(SegmentChain, AnSCurveIsOneCubicOrTwoArcsNotManyPieces) {
  Points run;
  run.add_curve(
      [](double t) {
        const double s = 1 - t;
        return Vector3d(t, 3 * s * s * t * 0.5 - 3 * s * t * t * 0.5, 0.1 * t * t);
      },
      0, 1, 60);
  const Sketch s = run.segmented();
  EXPECT_GE(s.size(), 1);
  EXPECT_LE(s.size(), 2);
  EXPECT_EQ(count_of(s, StrokeKind::kLine), 0);
  EXPECT_EQ(run.covered(s), 1);
}

TEST(SegmentChain, ALineThatGoesOnAsATangentArcIsTwoPieces) {
  Points run;
  run.add_curve([](double t) { return Vector3d(t, 0, 0); }, 0, 0.6, 30);
  run.add_curve(
      [](double a) { return Vector3d(0.6 + 0.25 * std::sin(a), 0.25 - 0.25 * std::cos(a), 0); },
      0.08, 2.2, 28);
  const Sketch s = run.segmented();
  ASSERT_EQ(s.size(), 2);
  EXPECT_EQ(s.strokes[0].kind, StrokeKind::kLine);
  EXPECT_EQ(s.strokes[1].kind, StrokeKind::kArc);
  EXPECT_GE(run.covered(s), 0.97);
}

TEST(SegmentChain, ResultScalesWithTheUnit) {
  Points run;
  run.add_curve([](double t) { return Vector3d(t, 0, 0); }, 0, 0.5, 25);
  run.add_curve([](double t) { return Vector3d(0.5, t, 0); }, 0.02, 0.4, 20);
  const Sketch expected = run.segmented();
  for (double f : {1e-3, 1e3}) {
    Sketch s;
    segment_chain(f * run.points, run.tangents, false, f * kUnit, {}, &s);
    ASSERT_EQ(s.size(), expected.size());
    EXPECT_LT((s.nodes / f - expected.nodes).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(SegmentChain, AppendsToWhatIsThere) {
  Points run;
  run.add_curve([](double t) { return Vector3d(t, 0, 0); }, 0, 1, 50);
  Sketch s = run.segmented();
  segment_chain(run.points, run.tangents, false, kUnit, {}, &s);
  ASSERT_EQ(s.size(), 2);
  EXPECT_EQ(s.nodes.cols(), 4) << "nodes of its own";
  EXPECT_EQ(s.evidence.size(), 2u);
}

TEST(SegmentChain, TooFewPointsAndPointsInOnePlaceGiveNothing) {
  for (int n : {0, 1, 2}) {
    Points run;
    for (int i = 0; i < n; ++i) run.add(Vector3d(0.1 * i, 0, 0), Vector3d::UnitX());
    if (n == 0) run.points.resize(3, 0), run.tangents.resize(3, 0);
    EXPECT_EQ(run.segmented().size(), 0) << n;
    EXPECT_EQ(run.segmented(true).size(), 0) << n;
  }
  Sketch s;
  const Matrix3Xd place = Vector3d(1, 2, 3).replicate(1, 20);
  segment_chain(place, Vector3d(1, 0, 0).replicate(1, 20), false, kUnit, {}, &s);
  segment_chain(place, Vector3d(1, 0, 0).replicate(1, 20), true, kUnit, {}, &s);
  EXPECT_EQ(s.size(), 0);
}

TEST(SegmentChain, WhateverComesInWhatComesOutIsFinite) {
  Points run;  // a cloud, not a curve
  for (int i = 0; i < 40; ++i)
    run.add(Vector3d(std::sin(12.9 * i), std::sin(78.2 * i), std::sin(37.7 * i)),
            Vector3d(std::sin(3. * i), std::cos(3. * i), 0.5));
  for (bool closed : {false, true}) {
    const Sketch s = run.segmented(closed);
    EXPECT_TRUE(validate(s).empty());
  }
  run.points.col(7).setConstant(std::nan(""));
  run.tangents.col(9).setZero();
  const Sketch s = run.segmented();
  for (int i = 0; i < s.nodes.size(); ++i) EXPECT_TRUE(std::isfinite(s.nodes.data()[i]));
  for (int i = 0; i < s.handles.size(); ++i) EXPECT_TRUE(std::isfinite(s.handles.data()[i]));
}

TEST(SegmentChain, ASlotIsTwoLinesAndTwoArcsWhereverTheRunBegins) {
  const double r = 0.1, half = 0.2;
  const double round = M_PI * r, straight = 2 * half, around = 2 * (round + straight);
  const auto slot = [&](double s) {
    s = std::fmod(s, around);
    const double side = s < around / 2 ? 1 : -1;
    s = std::fmod(s, around / 2);
    if (s < straight) return Vector3d(side * (half - s), side * r, 0);
    const double a = (s - straight) / r;
    return Vector3d(side * (-half - r * std::sin(a)), side * r * std::cos(a), 0);
  };
  for (double start : {0.0, 0.1, 0.45, 0.6}) {
    Points run;
    run.add_curve(slot, start, start + 0.985 * around, 70);
    const Sketch s = run.segmented(true);
    EXPECT_EQ(count_of(s, StrokeKind::kArc), 2) << start;
    EXPECT_EQ(count_of(s, StrokeKind::kLine), 2) << start;
  }
}

TEST(CutRun, SmallRoundsOfALongOutlineAreRoundNotCubics) {
  // Half-lengths of a rectangle's sides between its rounds, of radius r.
  const double r = 0.09, a = 0.4, b = 0.31, quarter = M_PI * r / 2;
  const double around = 4 * (a + b + quarter);
  const auto outline = [&](double s) -> Vector3d {
    s = std::fmod(s, around);
    const double side = s < around / 2 ? 1 : -1;
    s = std::fmod(s, around / 2);
    if (s < 2 * a) return side * Vector3d(a - s, b + r, 0);
    s -= 2 * a;
    if (s < quarter) return side * Vector3d(-a - r * std::sin(s / r), b + r * std::cos(s / r), 0);
    s -= quarter;
    if (s < 2 * b) return side * Vector3d(-a - r, b - s, 0);
    s -= 2 * b;
    return side * Vector3d(-a - r * std::cos(s / r), -b - r * std::sin(s / r), 0);
  };
  for (double start : {0.0, 0.13, 0.37}) {
    Points run;
    run.add_curve(outline, start, start + 0.995 * around, 120);
    int round = 0, cubics = 0, lines = 0;
    for (const RunPiece& p : cut_run(run.points, run.tangents, true, 0.1 * kUnit, kUnit, {})) {
      const StrokeKind kind = p.fit.kind;
      round += kind == StrokeKind::kArc || kind == StrokeKind::kEllipticArc;
      cubics += kind == StrokeKind::kBezier, lines += kind == StrokeKind::kLine;
    }
    EXPECT_EQ(round, 4) << start;
    EXPECT_EQ(cubics, 0) << start;
    EXPECT_NEAR(lines, 4, 1) << start;  // one may be cut where the run is opened
  }
}

TEST(CutRun, WithoutConicsARoundRunIsCubics) {
  Points p;
  p.add_curve(on_circle, 0, 300, 60);
  SegmentOptions options;
  options.conics = false;
  for (const RunPiece& piece : cut_run(p.points, p.tangents, false, 0.2 * kUnit, kUnit, options))
    EXPECT_EQ(piece.fit.kind, StrokeKind::kBezier);
}

TEST(CutRun, AHigherPriceNeverBuysMoreCurves) {
  Points run;
  run.add_curve([](double t) { return Vector3d(t, 0.15 * std::sin(7 * t), 0.1 * t * t); }, 0, 1,
                60);
  size_t before = 1000;
  for (double price : {0.5, 2.0, 8.0, 50.0, 1e4}) {
    SegmentOptions options;
    options.price = price;
    const auto pieces = cut_run(run.points, run.tangents, false, 0.15 * kUnit, kUnit, options);
    EXPECT_LE(pieces.size(), before) << price;
    before = pieces.size();
  }
  EXPECT_EQ(before, 1u);
}

// Where two cylinders of 1 and 0.8 units meet at right angles.
Vector3d saddle(double a) {
  const double y = 0.8 * std::cos(a), z = 0.8 * std::sin(a);
  return {std::sqrt(1 - y * y), y, z};
}

TEST(CutRun, ASmoothClosedCurveIsCubicsNotArcsThatMeetInCorners) {
  Points run;
  run.add_curve(saddle, 0, 2 * M_PI * 119 / 120, 120);
  const std::vector<RunPiece> pieces =
      cut_run(run.points, run.tangents, true, 0.3 * kUnit, kUnit, {});
  EXPECT_LE(pieces.size(), 5u);
  for (const RunPiece& piece : pieces) EXPECT_EQ(piece.fit.kind, StrokeKind::kBezier);
}

TEST(CutRun, ALobedOutlineIsOneSplineNotOvalsAndLines) {
  for (int lobes : {3, 4}) {
    Points run;
    const int n = 240;
    run.add_curve(
        [lobes](double a) {
          const double r = 0.5 + 0.07 * std::cos(lobes * a);
          return Vector3d(r * std::cos(a), r * std::sin(a), 0);
        },
        0, 2 * M_PI * (n - 1) / n, n);
    const std::vector<RunPiece> pieces =
        cut_run(run.points, run.tangents, true, 0.2 * kUnit, kUnit, {});
    EXPECT_LE(int(pieces.size()), 3 * lobes);
    const auto is_cubic = [](const RunPiece& p) { return p.fit.kind == StrokeKind::kBezier; };
    EXPECT_GE(std::count_if(pieces.begin(), pieces.end(), is_cubic), int(pieces.size()) - 1);
  }
}

TEST(JointCost, OnlyWhatGoesTogetherOnPartsIsFree) {
  const SegmentOptions o;
  using Kind = StrokeKind;
  EXPECT_EQ(joint_cost(Kind::kLine, Kind::kArc, o), 0);
  EXPECT_EQ(joint_cost(Kind::kArc, Kind::kArc, o), 0);
  EXPECT_LT(joint_cost(Kind::kBezier, Kind::kBezier, o), 0);
  for (const auto& [x, y] :
       {std::pair(Kind::kLine, Kind::kBezier), std::pair(Kind::kBezier, Kind::kEllipticArc),
        std::pair(Kind::kEllipticArc, Kind::kLine)}) {
    EXPECT_GT(joint_cost(x, y, o), 0);
    EXPECT_EQ(joint_cost(x, y, o), joint_cost(y, x, o));
  }
}

TEST(CutRun, ACubicAfterACubicCostsLess) {
  Points run;
  run.add_curve(saddle, 0, 2 * M_PI * 119 / 120, 120);
  const SegmentOptions options;
  int cheaper = 0;
  for (const RunPiece& piece :
       cut_run(run.points, run.tangents, true, 0.15 * kUnit, kUnit, options)) {
    const double alone =
        description_length(piece.fit.distance, 0.15 * kUnit, piece.fit.kind, options);
    EXPECT_TRUE(std::abs(piece.cost - alone) < 1e-9 ||
                std::abs(piece.cost - alone -
                         joint_cost(StrokeKind::kBezier, StrokeKind::kBezier, options)) < 1e-9);
    cheaper += piece.cost < alone - 1e-9;
  }
  EXPECT_GE(cheaper, 2);
}

TEST(CutRun, PiecesFollowOneAnotherAndCoverTheRun) {
  Points run;
  run.add_curve([](double t) { return Vector3d(t, 0, 0); }, 0, 0.5, 30);
  run.add_curve(
      [](double t) { return Vector3d(0.5 + 0.2 * std::sin(t), 0.2 - 0.2 * std::cos(t), 0); }, 0.1,
      2, 20);
  const auto pieces = cut_run(run.points, run.tangents, false, 0.15 * kUnit, kUnit, {});
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].first, 0);
  EXPECT_EQ(pieces[1].first, pieces[0].last - 1);
  EXPECT_EQ(pieces[1].last, run.size());
  EXPECT_NEAR(pieces[1].first, 30, 4);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// Numbers of tiny cases that can be told by heart.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "eval/metrics/duplicates.h"
#include "eval/metrics/evaluate.h"
#include "eval/metrics/junctions.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/parameters.h"

namespace sketchsplat {
namespace {

Eigen::Matrix3Xd segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3Xd p(3, 2);
  p << a, b;
  return p;
}

Eigen::Matrix3Xd arc(double radius, double from_deg, double to_deg) {
  Eigen::Matrix3Xd p(3, 181);
  for (int i = 0; i <= 180; ++i) {
    const double a = (from_deg + (to_deg - from_deg) * i / 180) * M_PI / 180;
    p.col(i) << radius * std::cos(a), radius * std::sin(a), 0;
  }
  return p;
}

// A square in the plane z = 0; with `half_seen` the side along y = 1 is seen as far as x = 0.4.
GroundTruth square(bool half_seen = false) {
  GroundTruth truth;
  truth.path = "square";
  const Eigen::Vector3d corner[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int k = 0; k < 4; ++k) {
    GroundTruth::Curve curve{"line", segment(corner[k], corner[(k + 1) % 4]), true, false};
    if (half_seen) {
      curve.polyline = resample(curve.polyline, 0.01);
      for (int i = 0; i < curve.polyline.cols(); ++i) {
        const bool hidden = k == 2 && curve.polyline(0, i) > 0.4;
        curve.visible_views.push_back(hidden ? 1 : 2);
      }
    }
    truth.curves.push_back(curve);
  }
  return truth;
}

Prediction sides(std::initializer_list<int> which) {
  const GroundTruth truth = square();
  Prediction prediction;
  for (int k : which) {
    const Eigen::Matrix3Xd& p = truth.curves[size_t(k)].polyline;
    prediction.lines.emplace_back(p);
  }
  return prediction;
}

TEST(Compare, APerfectSquareHasNoFault) {
  const Evaluation e = evaluate(sides({0, 1, 2, 3}), square());
  const Structure& s = e.structure;
  EXPECT_EQ(s.precision, 100);
  EXPECT_EQ(s.recall, 100);
  EXPECT_EQ(s.right_type_share, 100);
  EXPECT_EQ(s.junctions.matched, 4);
  EXPECT_EQ(s.junctions.f, 100);
  EXPECT_EQ(s.duplicated, 0);
  EXPECT_NEAR(s.length_error, 0, 1e-9);
  EXPECT_EQ(s.parameters, 12) << "four corners";
  EXPECT_EQ(s.true_parameters, 12);
  EXPECT_EQ(s.parameters_per_true, 1);
  EXPECT_TRUE(e.worst_edges.empty());
  EXPECT_TRUE(e.worst_strokes.empty());
  EXPECT_FALSE(e.has_visibility);
  EXPECT_TRUE(std::isnan(s.recall_visible));
}

TEST(Compare, ADuplicatedSideCountsTwice) {
  const Structure s = evaluate(sides({0, 1, 2, 3, 0}), square()).structure;
  EXPECT_EQ(s.precision, 80);
  EXPECT_EQ(s.recall, 100);
  EXPECT_NEAR(s.duplicated, 40, 1e-9) << "both of the two, of five";
  EXPECT_NEAR(s.length_error, 25, 1e-9);
  EXPECT_EQ(s.strokes_per_edge, 1.25);
  EXPECT_EQ(s.parameters, 12) << "five lines over four nodes";
}

TEST(Compare, AMissingSideTakesItsCornersAway) {
  const Evaluation e = evaluate(sides({0, 1, 3}), square());
  const Structure& s = e.structure;
  EXPECT_EQ(s.precision, 100);
  EXPECT_EQ(s.recall, 75);
  EXPECT_EQ(s.junctions.predicted, 2);
  EXPECT_EQ(s.junctions.precision, 100);
  EXPECT_EQ(s.junctions.recall, 50);
  EXPECT_NEAR(s.junctions.f, 200 / 3.0, 1e-9);
  EXPECT_NEAR(s.length_error, -25, 1e-9);
  ASSERT_EQ(e.worst_edges.size(), 1u);
  EXPECT_EQ(e.worst_edges[0].name, "2");
  EXPECT_NEAR(e.worst_edges[0].share, 1, 0.2) << "its ends lie on the others";
  EXPECT_NEAR(e.worst_edges[0].worst, 0.5, 1e-9);
  EXPECT_NEAR(e.fine.to_prediction.worst, 0.5, 1e-9);
}

TEST(Compare, SidesThatDoNotMeetMakeNoJunction) {
  Prediction prediction = sides({0, 1, 2, 3});
  prediction.lines[0].col(1) -= Eigen::Vector3d(0.003, 0, 0);
  const Junctions j = evaluate(prediction, square()).structure.junctions;
  EXPECT_EQ(j.predicted, 3);
  EXPECT_EQ(j.recall, 75);
}

TEST(Compare, ACubicForALineIsTheWrongType) {
  Prediction prediction = sides({0, 1, 2});
  prediction.curves.emplace_back();
  prediction.curves[0] << 0, 0, 0, 0, 1, 2 / 3.0, 1 / 3.0, 0, 0, 0, 0, 0;
  const Structure s = evaluate(prediction, square()).structure;
  EXPECT_EQ(s.matched, 4);
  EXPECT_EQ(s.right_type, 3);
  EXPECT_EQ(s.right_type_share, 75);
  EXPECT_EQ(s.parameters, 12 + 6) << "two handles";
  EXPECT_EQ(s.parameters_per_true, 1.5);
}

TEST(Compare, WhatNobodySeesNeedNotBeFound) {
  const Evaluation e = evaluate(sides({0, 1, 3}), square(true));
  EXPECT_TRUE(e.has_visibility);
  EXPECT_EQ(e.structure.visible_edges, 3) << "40 % of a side are not half of it";
  EXPECT_EQ(e.structure.recall_visible, 100);
  EXPECT_EQ(e.structure.f_visible, 100);
  EXPECT_EQ(e.structure.recall, 75);
  // Seen: three sides and 0.405 of the fourth (as far as the middle of two points), of which the
  // 0.005 beside the corner are found.
  EXPECT_NEAR(e.fine.levels[0].recall_visible, 100 * 3.005 / 3.405, 0.05);
  EXPECT_NEAR(e.fine.levels[0].recall, 100 * 3.01 / 4, 0.1);
  EXPECT_GT(e.fine.levels[0].f_visible, e.fine.levels[0].f);
  EXPECT_EQ(e.published.levels[0].recall_visible > e.published.levels[0].recall, true);
  EXPECT_EQ(e.structure.junctions.truth_visible, 4) << "the other side shows the far corner";
}

TEST(Compare, OrderDirectionAndPlaceDoNotMatter) {
  const Structure plain = evaluate(sides({0, 1, 3, 0}), square(true)).structure;
  Prediction turned = sides({3, 0, 0, 1});
  for (auto& line : turned.lines) line.col(0).swap(line.col(1));
  const Eigen::Matrix3d r =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto move = [&](auto points) {
    return ((r * points * 40).colwise() + Eigen::Vector3d(5, -7, 2)).eval();
  };
  for (auto& line : turned.lines) line = move(line);
  GroundTruth truth = square(true);
  for (auto& curve : truth.curves) curve.polyline = move(curve.polyline);
  truth.extent = 40;
  truth.center = move(Eigen::Matrix3Xd(Eigen::Vector3d(0.5, 0.5, 0)));
  const Structure s = evaluate(turned, truth).structure;
  EXPECT_EQ(s.pairs.size(), plain.pairs.size());
  EXPECT_EQ(s.f, plain.f);
  EXPECT_EQ(s.f_visible, plain.f_visible);
  EXPECT_EQ(s.right_type, plain.right_type);
  EXPECT_EQ(s.junctions.f, plain.junctions.f);
  EXPECT_NEAR(s.duplicated, plain.duplicated, 0.1);
  EXPECT_NEAR(s.length_error, plain.length_error, 1e-9);
  EXPECT_EQ(s.parameters, plain.parameters);
}

TEST(Duplicates, AreBesideNotAheadNorAcross) {
  const auto a = segment({0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(duplicated_share({a, segment({1, 0, 0}, {2, 0, 0})}), 0) << "goes on";
  EXPECT_NEAR(duplicated_share({a, segment({0.5, -1, 0}, {0.5, 1, 0})}), 0, 1e-9) << "crosses";
  EXPECT_NEAR(duplicated_share({a, segment({0, 0.006, 0}, {1, 0.006, 0})}), 0, 1e-9);
  EXPECT_NEAR(duplicated_share({a, segment({0.75, 0.004, 0}, {0.25, 0.004, 0})}), 100 * 2 / 3.0,
              0.2);
  EXPECT_TRUE(std::isnan(duplicated_share({})));
}

TEST(Junctions, NeedTwoCurves) {
  const TrueEdge circle = {"circle", arc(0.3, 0, 360)}, half = {"circle", arc(0.3, 0, 180)},
                 chord = {"line", segment({-0.3, 0, 0}, {0.3, 0, 0})},
                 tee = {"line", segment({0, 0, 0}, {0, 0, 1})};
  EXPECT_EQ(match_junctions({}, {circle}).truth, 0) << "a closed curve meets itself only";
  EXPECT_TRUE(std::isnan(match_junctions({circle}, {circle}).f)) << "no junction to be found";
  EXPECT_EQ(match_junctions({}, {half, chord}).truth, 2);
  EXPECT_EQ(match_junctions({}, {chord, tee}).truth, 0) << "on the middle of another";
  EXPECT_EQ(match_junctions({}, {half, chord}).precision, 0);
  EXPECT_TRUE(std::isnan(match_junctions({half, chord}, {circle}).recall));
}

TEST(Parameters, AreDegreesOfFreedomLessWhatIsShared) {
  const auto count = [](const TrueEdge& edge) { return count_true_parameters({edge}); };
  EXPECT_EQ(count({"line", segment({0, 0, 0}, {1, 0, 0})}), 6);
  EXPECT_EQ(count({"circle", arc(0.3, 0, 360)}), 6);
  EXPECT_EQ(count({"circle", arc(0.3, 0, 90)}), 8);
  EXPECT_EQ(count({"bspline", arc(0.3, 0, 60)}), 12) << "one cubic";
  EXPECT_EQ(count({"bspline", arc(0.3, 0, 270)}), 12 + 9) << "two, sharing an end";
  EXPECT_EQ(count({"ellipse", arc(0.3, 0, 360)}), 8);
  EXPECT_EQ(count_true_parameters(
                {{"circle", arc(0.3, 0, 180)}, {"line", segment({-0.3, 0, 0}, {0.3, 0, 0})}}),
            8 + 6 - 2 * 3);
  EXPECT_EQ(kind_of_edge({"ellipse", arc(0.3, 0, 180)}), "elliptic_arc");
  EXPECT_EQ(count({"ellipse", arc(0.3, 0, 180)}), 10);
}

}  // namespace
}  // namespace sketchsplat

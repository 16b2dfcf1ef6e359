// SPDX-License-Identifier: MIT
#include "eval/metrics/evaluate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "eval/metrics/report.h"

namespace sketchsplat {
namespace {

// The twelve edges of a cube: world = unit * side + origin.
GroundTruth cube(double side = 1, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) {
  GroundTruth truth;
  truth.path = "cube";
  truth.extent = side;
  truth.center = origin + Eigen::Vector3d::Constant(side / 2);
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      Eigen::Vector3d a = Eigen::Vector3d::Zero();
      a[(axis + 1) % 3] = corner & 1;
      a[(axis + 2) % 3] = corner >> 1;
      Eigen::Matrix3Xd line(3, 2);
      line << a, a + Eigen::Vector3d::Unit(axis);
      truth.curves.push_back({"line", (line * side).colwise() + origin, true, false});
    }
  }
  return truth;
}

Prediction lines_of(const GroundTruth& truth, const Eigen::Vector3d& shift) {
  Prediction prediction;
  for (const auto& curve : truth.curves) {
    prediction.lines.emplace_back();
    prediction.lines.back() << curve.polyline.col(0) + shift, curve.polyline.col(1) + shift;
  }
  return prediction;
}

double f_at(const Score& score, double threshold) {
  for (const Level& level : score.levels) {
    if (level.threshold == threshold) return level.f;
  }
  ADD_FAILURE() << "no level " << threshold;
  return -1;
}

// A shift that no edge of the cube can hide: as far from every line as it says.
Eigen::Vector3d shift_of(double distance) {
  return Eigen::Vector3d::Constant(distance / std::sqrt(2.0));
}

TEST(Evaluate, TruthAgainstItselfIsPerfect) {
  const Evaluation e = evaluate(lines_of(cube(), {0, 0, 0}), cube());
  EXPECT_EQ(e.lines, 12);
  EXPECT_NEAR(e.published.accuracy, 0.000125, 1e-5) << "a quarter of the spacing of the truth";
  EXPECT_NEAR(e.published.completeness, 0.00125, 1e-4)
      << "a quarter of the spacing of the prediction";
  for (double t : {0.020, 0.010, 0.005}) EXPECT_NEAR(f_at(e.published, t), 100, 1e-4);
  for (double t : {0.005, 0.002, 0.001}) EXPECT_NEAR(f_at(e.fine, t), 100, 1e-4);
  EXPECT_EQ(e.structure.matched, 12);
  EXPECT_NEAR(e.structure.f, 100, 1e-12);
}

TEST(Evaluate, ThresholdsSeparateShifts) {
  EXPECT_NEAR(f_at(evaluate(lines_of(cube(), shift_of(0.004)), cube()).fine, 0.005), 100, 0.5)
      << "all but the ends, which moved out along their lines";
  EXPECT_LT(f_at(evaluate(lines_of(cube(), shift_of(0.0051)), cube()).fine, 0.005), 1);
  EXPECT_NEAR(f_at(evaluate(lines_of(cube(), shift_of(0.0051)), cube()).published, 0.010), 100,
              0.5);
  EXPECT_LT(f_at(evaluate(lines_of(cube(), shift_of(0.0021)), cube()).fine, 0.002), 5);
}

TEST(Evaluate, IsTheSameInAnyUnitsAndPlace) {
  const Evaluation unit = evaluate(lines_of(cube(), shift_of(0.003)), cube());
  for (double side : {1e-3, 1e3}) {
    const GroundTruth truth = cube(side, {7 * side, -3 * side, side});
    const Evaluation e = evaluate(lines_of(truth, shift_of(0.003) * side), truth);
    EXPECT_NEAR(e.published.accuracy, unit.published.accuracy, 1e-5);
    // Rounding may change the number of pieces of a line by one.
    EXPECT_NEAR(e.fine.completeness, unit.fine.completeness, 1e-5);
    EXPECT_NEAR(f_at(e.fine, 0.002), f_at(unit.fine, 0.002), 0.1);
    EXPECT_EQ(e.structure.matched, 12);
  }
}

TEST(Evaluate, OfAnEmptyPredictionIsZero) {
  for (Protocol protocol : {Protocol::kSketchSplat, Protocol::kEmap, Protocol::kCurveGaussian}) {
    EvaluateOptions options;
    options.protocol = protocol;
    const Evaluation e = evaluate({}, cube(), options);
    EXPECT_EQ(e.published.samples, 0);
    EXPECT_TRUE(std::isnan(e.published.accuracy));
    EXPECT_EQ(f_at(e.published, 0.020), 0);
    EXPECT_EQ(f_at(e.fine, 0.005), 0);
    EXPECT_EQ(e.structure.f, 0);
    EXPECT_TRUE(nlohmann::json::parse(to_json(e))["acc"].is_null());
  }
}

TEST(Evaluate, CountsASpuriousEdgeAgainstPrecisionOnly) {
  Prediction prediction = lines_of(cube(), {0, 0, 0});
  prediction.lines.push_back(prediction.lines[0]);
  prediction.lines.back().colwise() += Eigen::Vector3d(0, 0.4, 0.4);
  const Evaluation e = evaluate(prediction, cube());
  EXPECT_NEAR(e.fine.levels[0].precision, 100 * 12 / 13.0, 0.1);
  EXPECT_NEAR(e.fine.levels[0].recall, 100, 1e-9);
  EXPECT_NEAR(e.structure.f, 100 * 24 / 25.0, 1e-9);
}

TEST(Evaluate, VoxelsOfTheOtherProtocolsThinThePrediction) {
  EvaluateOptions options;
  const Prediction prediction = lines_of(cube(), {0, 0, 0});
  const int all = evaluate(prediction, cube()).published.samples;
  options.protocol = Protocol::kCurveGaussian;
  const int thin = evaluate(prediction, cube(), options).published.samples;
  options.protocol = Protocol::kEmap;
  const int thinner = evaluate(prediction, cube(), options).published.samples;
  EXPECT_NEAR(all, 12 * 199.5, 12);
  EXPECT_LT(thin, all);
  EXPECT_NEAR(thinner, 12 * 128, 12 * 3) << "voxels of 1/128";
}

TEST(Evaluate, SmoothCurvesDoNotCount) {
  GroundTruth truth = cube();
  truth.curves[0].sharp = false;
  const Evaluation e = evaluate(lines_of(truth, {0, 0, 0}), truth);
  EXPECT_EQ(e.structure.edges, 11);
  EXPECT_NEAR(e.fine.levels[0].precision, 100 * 11 / 12.0, 1);
}

TEST(Evaluate, TakesPointsAndSamplesWithoutCurves) {
  GroundTruth truth;
  truth.samples = Eigen::Matrix3Xd::Zero(3, 2);
  truth.samples(0, 1) = 1;
  Prediction prediction;
  prediction.points_only = true;
  prediction.points = truth.samples;
  const Evaluation e = evaluate(prediction, truth);
  EXPECT_FALSE(e.has_curves);
  EXPECT_FALSE(e.has_strokes);
  EXPECT_NEAR(f_at(e.fine, 0.001), 100, 1e-4);
  EXPECT_TRUE(nlohmann::json::parse(to_json(e))["structure"].is_null());
  EXPECT_NE(to_table(e).find("-"), std::string::npos);
}

TEST(Evaluate, RefusesATruthOfNothing) { EXPECT_THROW(evaluate({}, GroundTruth()), InputError); }

TEST(ParseProtocol, KnowsTheThreeByName) {
  Protocol protocol = Protocol::kSketchSplat;
  for (Protocol p : {Protocol::kSketchSplat, Protocol::kEmap, Protocol::kCurveGaussian}) {
    EXPECT_TRUE(parse_protocol(protocol_name(p), &protocol));
    EXPECT_EQ(protocol, p);
  }
  EXPECT_FALSE(parse_protocol("nef", &protocol));
}

TEST(Report, RowStandsUnderItsHeadings) {
  const std::string table = to_table(evaluate(lines_of(cube(), {0, 0, 0}), cube()), "a long name");
  const size_t line = table.find('\n');
  EXPECT_EQ(table.size(), 2 * (line + 1));
  EXPECT_NE(table.find("scene   Acc"), std::string::npos);
  for (const char* head : {"F5 ", "F10 ", "F2fine", "strF"}) {
    const size_t end = table.find(head) + std::string(head).find_last_not_of(' ');
    ASSERT_LT(end, line) << head;
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(table[line + 1 + end]))) << head;
  }
}

TEST(Report, JsonHoldsEveryNumber) {
  const auto j =
      nlohmann::json::parse(to_json(evaluate(lines_of(cube(), shift_of(0.003)), cube())));
  EXPECT_EQ(j["protocol"], "sketchsplat");
  EXPECT_NEAR(double(j["chamfer"]), double(j["acc"]) + double(j["comp"]), 1e-12);
  for (const char* key : {"P20", "R20", "F20", "F10", "P5", "R5", "F5", "F2", "F1"}) {
    EXPECT_TRUE(j.contains(key)) << key;
  }
  EXPECT_NEAR(double(j["fine"]["acc"]), 3, 0.1) << "thousandths";
  EXPECT_EQ(j["structure"]["edges"], 12);
  EXPECT_EQ(double(j["structure"]["strokes_per_edge"]), 1);
}

}  // namespace
}  // namespace sketchsplat

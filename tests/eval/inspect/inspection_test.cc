// SPDX-License-Identifier: MIT
#include "eval/inspect/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "eval/inspect/inspection_files.h"
#include "eval/inspect/lot.h"
#include "tests/eval/inspect/plate.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
using testing::HasSubstr;

InspectOptions within(double tolerance) {
  InspectOptions o;
  o.tolerance = tolerance;
  return o;
}

Nominal nominal_plate() { return make_nominal(plate(), "plate"); }

TEST(Inspect, WhatIsAsItShouldBeIsIn) {
  const Inspection i =
      inspect(nominal_plate(), moved(with_sigma(plate(), 0.005), elsewhere()), 0, within(0.1));
  EXPECT_EQ(i.verdict, Judgement::kIn);
  EXPECT_EQ(count_verdicts(i, Judgement::kIn).edges, 18);
  for (const EdgeCheck& e : i.edges) {
    EXPECT_LT(e.largest, 1e-5);
    EXPECT_GT(e.within.low, 0.95);
    EXPECT_GT(e.known, 0.95);
  }
}

// One hole is 0.3 off, the radius of another 2 %.
TEST(Inspect, AMovedHoleAndAWrongRadiusAreOutAndNothingElse) {
  Sketch part = with_sigma(plate(), 0.01);
  for (const int s : {12, 13}) part.handles.col(part.strokes[s].handle) += Vector3d(0.18, 0.24, 0);
  for (const int s : {16, 17}) part.handles.col(part.strokes[s].handle + 1) *= 1.02;
  const Inspection i = inspect(nominal_plate(), moved(part, elsewhere()), 0, within(0.1));
  EXPECT_EQ(i.verdict, Judgement::kOut);
  for (size_t e = 0; e < i.edges.size(); ++e) {
    const bool wrong = e == 12 || e == 13 || e == 16 || e == 17;
    EXPECT_EQ(i.edges[e].verdict, wrong ? Judgement::kOut : Judgement::kIn) << e;
    if (wrong) {
      EXPECT_LT(i.edges[e].within.high, 0.05) << e;
    }
  }
  for (const DimensionResult& d : i.dimensions) {
    const auto& f = d.check.dimension.features;
    const auto of = [&](std::initializer_list<int> edges) {
      return std::any_of(f.begin(), f.end(), [&](const FeatureRef& r) {
        return r.kind == FeatureKind::kCircle &&
               std::find(edges.begin(), edges.end(), r.index) != edges.end();
      });
    };
    const bool radius = d.check.dimension.kind == DimensionKind::kDiameter && of({16, 17});
    const bool place = d.check.dimension.kind == DimensionKind::kCentreDistance && of({12, 13});
    EXPECT_EQ(d.verdict, radius || place ? Judgement::kOut : Judgement::kIn)
        << d.check.dimension.name;
  }
}

TEST(Inspect, WhatIsNotKnownWellEnoughIsUndecided) {
  InspectOptions alone = within(0.1);
  alone.learn_prior = false;
  const Inspection i = inspect(nominal_plate(), with_sigma(plate(), 0.1), 0, alone);
  EXPECT_EQ(i.verdict, Judgement::kUndecided);
  EXPECT_EQ(count_verdicts(i, Judgement::kOut).edges, 0);
  EXPECT_LT(i.edges[0].known, 0.95);
}

// On the plate's top, from slopes: a sine of this height by so many cubics.
Sketch with_wave(int pieces, double height) {
  Sketch s = plate();
  constexpr double kBegin = 20, kLength = 60, kTurn = 2 * M_PI / 30;
  const double step = kLength / pieces;
  const auto at = [&](double x) {
    return Vector3d(x, 35 + height * std::sin(kTurn * (x - kBegin)), 10);
  };
  const auto slope = [&](double x) {
    return Vector3d(1, height * kTurn * std::cos(kTurn * (x - kBegin)), 0);
  };
  int last = s.add_node(at(kBegin));
  for (int k = 0; k < pieces; ++k) {
    const double from = kBegin + k * step, to = from + step;
    const int next = s.add_node(at(to));
    s.add_stroke(StrokeKind::kBezier, last, next,
                 {at(from) + step / 3 * slope(from), at(to) - step / 3 * slope(to)});
    last = next;
  }
  return s;
}

// What coarse cubics differ in is their own; what as many differ in is the part's.
TEST(Inspect, FewerCubicsThanNominalOnesSayNothingOfWaves) {
  const Sketch measured = with_sigma(with_wave(8, 3), 0.004);
  const EdgeCheck coarse =
      inspect(make_nominal(with_wave(24, 3), "fine"), measured, 0, within(0.015)).edges.back();
  EXPECT_GT(coarse.largest, 0.015);
  EXPECT_GT(coarse.within.likely, 0.5);
  const EdgeCheck other =
      inspect(make_nominal(with_wave(8, 3.2), "higher"), measured, 0, within(0.015)).edges.back();
  EXPECT_EQ(other.verdict, Judgement::kOut);
}

TEST(Inspect, AMissingEdgeIsUndecidedAndOneThatCannotBeSeenIsNotJudged) {
  std::vector<bool> keep(size_t(plate().size()), true);
  keep[0] = keep[17] = false;
  const Visibility visibility = [](const Similarity&,
                                   const std::vector<std::vector<EdgePlace>>& places) {
    std::vector<std::vector<int>> out;
    for (const auto& edge : places) out.emplace_back(edge.size(), 10);
    for (int& views : out[17]) views = 0;
    return out;
  };
  const Inspection i = inspect(nominal_plate(), keep_strokes(with_sigma(plate(), 0.005), keep), 0,
                               within(0.1), visibility);
  EXPECT_EQ(i.edges[0].verdict, Judgement::kUndecided);
  EXPECT_EQ(i.edges[17].verdict, Judgement::kNotJudged);
  EXPECT_EQ(i.verdict, Judgement::kUndecided);
}

TEST(Inspect, ADirectionThatNobodyMeasuredIsNotIn) {
  Sketch part = with_sigma(plate(), 0.005);
  part.evidence[0].determined = 2;
  const Inspection i = inspect(nominal_plate(), part, 0, within(0.1));
  EXPECT_TRUE(i.edges[0].open);
  EXPECT_EQ(i.edges[0].within.low, 0);
  EXPECT_EQ(i.edges[0].verdict, Judgement::kUndecided);
}

TEST(Inspect, WithoutAScaleOnlyShapesAreJudged) {
  InspectOptions o = within(0.1);
  o.align.fit_scale = true;
  const Inspection i = inspect(nominal_plate(), moved(with_sigma(plate(), 0.005), {0.37}), 0, o);
  EXPECT_THAT(i.warnings[0], HasSubstr("has no scale"));
  for (const DimensionResult& d : i.dimensions)
    EXPECT_EQ(d.verdict, is_angle(d.check.dimension.kind) ? Judgement::kIn : Judgement::kNotJudged);
}

TEST(Inspect, AnUncertainScaleMakesLongDistancesUncertain) {
  InspectOptions o = within(0.1);
  o.sigma.scale_percent = 0.2;
  o.learn_prior = false;
  const Inspection i = inspect(nominal_plate(), with_sigma(plate(), 0.002), 0, o);
  for (const DimensionResult& d : i.dimensions) {
    if (d.check.dimension.kind != DimensionKind::kPlaneDistance) continue;
    EXPECT_NEAR(d.check.systematic, 0.002 * d.check.value, 1e-9);
    EXPECT_EQ(d.verdict, d.check.value > 50 ? Judgement::kUndecided : Judgement::kIn);
  }
}

TEST(Inspect, AScaleThatCamerasLeaveOpenIsMeasuredByTheEdges) {
  InspectOptions o = within(0.1);
  o.align.scale_sigma = 0.005;
  const Inspection i = inspect(nominal_plate(), moved(with_sigma(plate(), 0.002), {1.004}), 0, o);
  EXPECT_NEAR(i.alignment.pose.scale, 1 / 1.004, 1e-5);
  EXPECT_LT(i.alignment.scale_sigma, 1e-4);
  EXPECT_THAT(i.warnings, testing::Contains(HasSubstr("cameras leave the scale open")));
  for (const DimensionResult& d : i.dimensions) EXPECT_EQ(d.verdict, Judgement::kIn);
  o.align.scale_sigma = 0.0005;  // surely it is not the scale
  const Sketch larger = moved(with_sigma(plate(), 0.002), {1.008});
  EXPECT_EQ(inspect(nominal_plate(), larger, 0, o).verdict, Judgement::kOut);
}

TEST(Inspect, TolerancesFollowTheTable) {
  InspectOptions o;
  o.iso = Iso2768::kMedium;
  const Inspection i = inspect(nominal_plate(), with_sigma(plate(), 0.005), 0, o);
  EXPECT_EQ(i.edges[0].tolerance, 0.3);
  for (const DimensionResult& d : i.dimensions) {
    if (d.check.dimension.kind == DimensionKind::kDiameter) {
      EXPECT_EQ(d.tolerance, 0.2);
    }
    if (d.check.dimension.kind == DimensionKind::kPlaneAngle) {
      EXPECT_EQ(d.tolerance, d.check.dimension.leg > 50 ? 20 / 60.0 : 1) << d.check.dimension.leg;
    }
  }
}

TEST(InspectFiles, SayTheSameInEveryFormat) {
  const Nominal nominal = nominal_plate();
  Sketch part = with_sigma(plate(), 0.01);
  part.add_stroke(StrokeKind::kCircle, -1, -1, {{50, 30, 10}, {0, 0, 3}});
  const InspectOptions options = within(0.1);
  const Inspection i = inspect(nominal, part, 0, options);
  const auto json =
      nlohmann::json::parse(inspection_json(i, nominal, options, {"out", "plate", "mm", 1, "0"}));
  ASSERT_EQ(json["edges"].size(), 18u);
  EXPECT_EQ(json["edges"][12]["kind"], "circle");
  EXPECT_NEAR(json["edges"][12]["probability"].get<double>(), i.edges[12].within.likely, 1e-8);
  EXPECT_EQ(json["edges"][0]["largest_quantiles"].size(), json["quantile_shares"].size());
  EXPECT_EQ(json["extras"].size(), 1u);
  EXPECT_EQ(json["summary"]["edges"]["in"], count_verdicts(i, Judgement::kIn).edges);
  const std::string csv = inspection_csv(i, nominal);
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  EXPECT_EQ(lines, 1 + 18 + long(i.dimensions.size()) + 1);
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 16) << line;
}

TEST(Lot, CapabilityAndTrendAreThoseOfTheTextbook) {
  const Nominal nominal = nominal_plate();
  std::vector<LotPart> parts;
  Inspection first;
  // The bore grows by 0.01 a part: its diameter by 0.02.
  for (int k = 0; k < 5; ++k) {
    Sketch part = with_sigma(plate(), 0.002);
    for (const int s : {16, 17}) {
      auto axis = part.handles.col(part.strokes[s].handle + 1);
      axis *= (9 + 0.01 * k) / 9;
    }
    Inspection i = inspect(nominal, part, 0, within(0.1));
    parts.push_back(lot_part("part" + std::to_string(k), i));
    if (k == 0) first = i;
  }
  const std::vector<LotRow> rows = lot_rows(parts, first, nominal);
  const auto bore = std::find_if(rows.begin(), rows.end(),
                                 [](const LotRow& r) { return r.name == "diameter E17"; });
  ASSERT_NE(bore, rows.end());
  EXPECT_EQ(bore->parts, 5);
  EXPECT_NEAR(bore->mean, 18.04, 1e-9);
  const double s = 0.02 * std::sqrt(2.5);
  EXPECT_NEAR(bore->deviation, s, 1e-9);
  EXPECT_NEAR(bore->cp, 0.1 / (3 * s), 1e-6);
  EXPECT_NEAR(bore->cpk, (0.1 - 0.04) / (3 * s), 1e-6);
  EXPECT_NEAR(bore->trend, 0.02, 1e-9);
  EXPECT_EQ(std::accumulate(bore->histogram.begin(), bore->histogram.end(), 0), 5);
  EXPECT_NEAR(bore->histogram_low, 17.9, 1e-9);
  const auto json = nlohmann::json::parse(lot_json(parts, rows, "plate", "mm"));
  EXPECT_EQ(json["parts"].size(), 5u);
  EXPECT_EQ(json["rows"].size(), rows.size());
}

}  // namespace
}  // namespace sketchsplat

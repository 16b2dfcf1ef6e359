// SPDX-License-Identifier: MIT
#include "eval/solids/solid_dimensions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>

#include "datasets/types/dense.h"
#include "eval/solids/solid_tables.h"
#include "sketches/curve/curve.h"
#include "tests/eval/inspect/plate.h"
#include "tests/topology/solids.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

Solid known(Solid solid, double sigma) {
  solid.edges = test::with_sigma(solid.edges, sigma);
  return solid;
}

std::vector<SolidDimension> dimensions_of(const Solid& solid) {
  return find_solid_dimensions(solid, SurfaceErrors(solid, {}));
}

std::vector<double> values_of(const Solid& solid, SolidDimensionKind kind) {
  std::vector<double> out;
  for (const SolidDimension& d : dimensions_of(solid))
    if (d.kind == kind) out.push_back(std::round(1e9 * d.value) / 1e9);
  std::sort(out.begin(), out.end());
  return out;
}

// Corners of a prism over a triangle with right angle and equal legs.
std::vector<int> corners(double leg, double height, SolidMaker* m) {
  std::vector<int> n;
  for (const double z : {0.0, height})
    for (const Vector3d& p : {Vector3d(0, 0, z), Vector3d(leg, 0, z), Vector3d(0, leg, z)})
      n.push_back(m->node(p));
  return n;
}

// A prism with legs of length 1, 2 high.
Solid wedge() {
  SolidMaker m;
  const std::vector<int> n = corners(1, 2, &m);
  m.face(SolidMaker::plane({0, 0, 0}, {0, 0, -1}), false, {m.polygon({n[0], n[2], n[1]})});
  m.face(SolidMaker::plane({0, 0, 2}, {0, 0, 1}), false, {m.polygon({n[3], n[4], n[5]})});
  m.face(SolidMaker::plane({0, 0, 0}, {0, -1, 0}), false, {m.polygon({n[0], n[1], n[4], n[3]})});
  // Its normal looks into the material.
  m.face(SolidMaker::plane({1, 0, 0}, {-1, -1, 0}), true, {m.polygon({n[1], n[2], n[5], n[4]})});
  m.face(SolidMaker::plane({0, 0, 0}, {-1, 0, 0}), false, {m.polygon({n[2], n[0], n[3], n[5]})});
  return m.solid;
}

TEST(SolidDimensions, AreThoseOfADrawing) {
  using Kind = SolidDimensionKind;
  const Solid plate = plate_with_hole(0.5);
  EXPECT_THAT(values_of(plate, Kind::kDiameter), ElementsAre(0.5));
  EXPECT_THAT(values_of(plate, Kind::kPlaneDistance), ElementsAre(0.5, 1, 2));
  EXPECT_THAT(values_of(plate, Kind::kAxisToPlane), ElementsAre(0.5, 0.6));
  EXPECT_EQ(dimensions_of(plate).size(), 6u) << "square corners go without saying";
  EXPECT_THAT(values_of(plate_with_hole(0.2), Kind::kPlaneDistance),
              ElementsAre(0.2, 0.3, 0.5, 1, 2));
  EXPECT_THAT(values_of(half_cylinder(), Kind::kDiameter), ElementsAre(2)) << "half of one";
  EXPECT_THAT(values_of(elbow(), Kind::kRingDiameter), ElementsAre(4));
  EXPECT_THAT(values_of(elbow(), Kind::kTubeRadius), ElementsAre(0.5));
  EXPECT_THAT(values_of(sphere_solid(), Kind::kDiameter), ElementsAre(1));
  EXPECT_THAT(values_of(cone_solid(0.5), Kind::kConeAngle),
              ElementsAre(DoubleNear(2 * std::atan(0.5) * 180 / M_PI, 1e-8)));
  EXPECT_THAT(values_of(wedge(), Kind::kPlaneAngle), ElementsAre(45, 45));
}

TEST(SolidDimensions, RoundsOfLessThanHalfATurnHaveARadius) {
  SolidMaker m;  // a quarter of a disk of radius 2, 1 high
  const std::vector<int> n = corners(2, 1, &m);
  const double at = std::sqrt(2.0);
  const int low = m.arc(n[1], n[2], {at, at, 0}), high = m.arc(n[4], n[5], {at, at, 1});
  const int right = m.line(n[1], n[4]), left = m.line(n[2], n[5]);
  m.face(SolidMaker::cylinder({0, 0, 0}, Vector3d::UnitZ(), 2), false,
         {{{low, true}, {left, true}, {high, false}, {right, false}}});
  EXPECT_THAT(values_of(m.solid, SolidDimensionKind::kRadius), ElementsAre(2));
  EXPECT_THAT(values_of(m.solid, SolidDimensionKind::kDiameter), ElementsAre());
}

// The plate as one frame with six offsets and a cylinder, through places of its curves: what all
// its surfaces are if their axes are held square.
struct PlateFit {
  struct Place {
    int surface;
    Vector3d p;
    double root_weight;
  };
  const Solid& solid;
  std::vector<Place> places;

  VectorXd residuals(const VectorXd& x) const {
    const Eigen::Matrix3d r = rotation_about(x.head<3>());
    VectorXd out(Eigen::Index(places.size()));
    for (size_t i = 0; i < places.size(); ++i) {
      const Surface& s = solid.surfaces[places[i].surface];
      const Vector3d q = r.transpose() * places[i].p - s.origin;
      out[Eigen::Index(i)] = places[i].root_weight *
                             (s.kind == SurfaceKind::kPlane
                                  ? q.dot(s.axis) - x[3 + places[i].surface]
                                  : std::hypot(q.x() - x[9], q.y() - x[10]) - s.radius - x[11]);
    }
    return out;
  }
  VectorXd fit() const {
    VectorXd x = VectorXd::Zero(12);
    for (int round = 0; round < 4; ++round) {
      const VectorXd r = residuals(x);
      Eigen::MatrixXd j(r.size(), 12);
      for (int k = 0; k < 12; ++k)
        j.col(k) = (residuals(x + 1e-6 * VectorXd::Unit(12, k)) - r) / 1e-6;
      x -= least_squares(j, r);
    }
    return x;
  }
};

// Places of the curves of each surface; strokes as in the solid.
std::vector<PlateFit::Place> places_of(const Solid& solid, const Sketch& strokes) {
  std::set<std::pair<int, int>> pairs;
  for (const SolidFace& face : solid.faces)
    for (const Loop& loop : face.loops)
      for (const LoopStroke& s : loop) pairs.insert({face.surface, s.stroke});
  std::vector<PlateFit::Place> out;
  for (const auto& [surface, stroke] : pairs)
    for (int i = 0; i < 9; ++i) {
      Vector3d p, d;
      evaluate_stroke(strokes, stroke, (i + 0.5) / 9, &p, &d);
      out.push_back({surface, p, std::sqrt(stroke_length(solid.edges, stroke) / 9)});
    }
  return out;
}

TEST(SolidDimensions, SigmasForetellHowLeastSquaresScatterUnderNoise) {
  constexpr double kSigma = 1e-3;
  constexpr int kDraws = 400;
  const Solid plate = known(plate_with_hole(0.5), kSigma);
  std::mt19937 random(3);
  Eigen::MatrixXd drawn(12, kDraws);
  for (int i = 0; i < kDraws; ++i)
    drawn.col(i) =
        PlateFit{plate, places_of(plate, test::noisy(plate.edges, kSigma, &random))}.fit();
  // Faces 0 to 5: below, above, y = 0, x = 2, y = 1, x = 0.
  const auto scatter = [&](const VectorXd& of) {
    const VectorXd values = (of.transpose() * drawn).transpose();
    return std::sqrt((values.array() - values.mean()).square().sum() / (kDraws - 1));
  };
  const auto unit = [](int k) { return VectorXd::Unit(12, k); };
  int checked = 0;
  for (const SolidDimension& d : dimensions_of(plate)) {
    VectorXd of;
    if (d.kind == SolidDimensionKind::kDiameter)
      of = 2 * unit(11);
    else if (d.kind == SolidDimensionKind::kPlaneDistance)
      of = unit(3 + d.surfaces[0]) + unit(3 + d.surfaces[1]);
    else if (d.surfaces[1] == 2)
      of = unit(10) + unit(3 + 2);
    else
      of = unit(9) + unit(3 + 5);
    EXPECT_NEAR(d.sigma / scatter(of), 1, 0.12) << solid_dimension_name(d.kind) << d.value;
    ++checked;
  }
  EXPECT_EQ(checked, 6);
}

TEST(SolidDimensions, WhatNoCurveTellsOfIsNotKnown) {
  Solid plate = known(plate_with_hole(0.2), 1e-3);
  const auto sigma_of_depth = [&] {
    for (const SolidDimension& d : dimensions_of(plate))
      if (std::abs(d.value - 0.2) < 1e-9) return d.sigma;
    return -1.0;
  };
  EXPECT_GT(sigma_of_depth(), 0);
  plate.inferred[1] = true;  // the rim of the floor
  EXPECT_TRUE(std::isnan(sigma_of_depth()));
  for (const SolidDimension& d : dimensions_of(plate))
    EXPECT_EQ(std::isnan(d.sigma), std::abs(d.value - 0.2) < 1e-9 || std::abs(d.value - 0.3) < 1e-9)
        << d.value;
}

TEST(SolidTables, AreInTheUnitAndHoldWhatScaleDoesNotKnow) {
  Solid plate = known(plate_with_hole(0.5), 1e-3);
  for (int s = 0; s < plate.edges.size(); ++s) plate.edges.evidence[s].views = {s, 40};
  const auto surfaces = [&](double sigma_of_scale) {
    return nlohmann::json::parse(
        solid_tables(plate, std::vector<double>(7, 2), {}, {"mm", 100, sigma_of_scale})
            .surfaces_json);
  };
  const nlohmann::json exact = surfaces(0), hole = exact[6];
  ASSERT_EQ(exact.size(), 7u);
  EXPECT_EQ(hole["face"], "cylinder_6");
  EXPECT_EQ(hole["radius"], 25);
  EXPECT_EQ(hole["area"], 2e4);
  EXPECT_EQ(hole["origin"], nlohmann::json({60.0, 50.0, 25.0})) << "the middle of its rims";
  EXPECT_EQ(hole["views"], 3) << "each counts once";
  EXPECT_GT(hole["radius_sigma"], 0.01);
  EXPECT_LT(hole["radius_sigma"], 0.1);
  EXPECT_GT(hole["position_sigma"], 0.01);
  EXPECT_FALSE(exact[0].contains("radius"));
  EXPECT_EQ(exact[0]["axis"][2], -1) << "looks out";
  EXPECT_NEAR(double(surfaces(0.01)[6]["radius_sigma"]),
              std::hypot(double(hole["radius_sigma"]), 0.25), 1e-6);
}

TEST(SolidTables, SayTheSameAsCsvAndAsJson) {
  const SolidTables tables =
      solid_tables(known(plate_with_hole(0.5), 1e-3), {1, 2, 3, 4, 5, 6, 7}, {}, {});
  std::istringstream lines(tables.surfaces_csv);
  std::string head, first;
  std::getline(lines, head), std::getline(lines, first);
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(first.begin(), first.end(), ','));
  EXPECT_THAT(first, HasSubstr("plane_0,0,plane,world,1,,,,,,,0,0,-1,"));
  EXPECT_THAT(tables.dimensions_csv, HasSubstr("\naxis to plane,0.6,"));
  const auto rows = nlohmann::json::parse(tables.dimensions_json);
  EXPECT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0]["faces"][0], "cylinder_6");
  EXPECT_EQ(rows[0]["value"], 0.5);
}

}  // namespace
}  // namespace sketchsplat

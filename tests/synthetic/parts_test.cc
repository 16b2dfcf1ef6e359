// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "datasets/synthetic/cad/truth.h"
#include "datasets/types/errors.h"
#include "sketches/curve/tangent_joint.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

Truth truth_of(const std::string& part, std::uint64_t seed, const PartValues& values = {}) {
  const Brep brep = make_part(part, seed, values);
  return sharp_edges(brep, unit_frame(brep, part), 1.0);
}

double length(const TruthCurve& curve) {
  const Eigen::Index n = curve.points.cols() - 1;
  return (curve.points.rightCols(n) - curve.points.leftCols(n)).colwise().norm().sum();
}

std::map<std::string, int> kinds(const Truth& truth) {
  std::map<std::string, int> count;
  for (const TruthCurve& curve : truth.curves) ++count[curve.type];
  return count;
}

TEST(PartTable, ThereAreMoreThanThirtyPartsOfDifferentNames) {
  const std::vector<std::string> names = part_names();
  EXPECT_GE(names.size(), 30u);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(PartTable, WhatIsDrawnLiesWithinWhatIsAllowed) {
  for (const PartSpec& spec : part_specs())
    for (const PartParameter& p : spec.parameters) {
      EXPECT_LE(p.least, p.low) << spec.name << " " << p.name;
      EXPECT_LE(p.low, p.high) << spec.name << " " << p.name;
      EXPECT_LE(p.high, p.most) << spec.name << " " << p.name;
      for (std::uint64_t seed : {1, 2, 3}) {
        const double value = draw(spec, seed, {})[p.name.c_str()];
        EXPECT_GE(value, p.low) << spec.name << " " << p.name;
        EXPECT_LE(value, p.high) << spec.name << " " << p.name;
      }
    }
}

TEST(PartTable, WhatBenchmarksTurnIsThereInSeveralParts) {
  std::map<std::string, std::vector<PartParameter>> found;
  for (const PartSpec& spec : part_specs())
    for (const PartParameter& p : spec.parameters) found[p.name].push_back(p);
  for (const char* name : {"gap", "wall", "fillet", "round", "crease"}) {
    EXPECT_GE(found[name].size(), 2u) << name;
    for (const PartParameter& p : found[name]) {
      EXPECT_EQ(p.least, found[name][0].least) << name;
      EXPECT_EQ(p.most, found[name][0].most) << name;
      EXPECT_EQ(p.unit, found[name][0].unit) << name;
    }
  }
}

// All dimensions at once at either end, and those that users may set further than seeds go one by
// one: a part keeps its edges.
TEST(Parts, EveryDimensionCanBeWhatItsRangeAllows) {
  for (const PartSpec& spec : part_specs()) {
    std::vector<PartValues> variants(3);
    for (const PartParameter& p : spec.parameters) {
      if (p.least < p.low) variants.push_back({{p.name, p.least}});
      if (p.most > p.high) variants.push_back({{p.name, p.most}});
      variants[1].push_back({p.name, p.least});
      variants[2].push_back({p.name, p.most});
    }
    const bool counts = std::any_of(spec.parameters.begin(), spec.parameters.end(),
                                    [](const PartParameter& p) { return p.unit == "count"; });
    const size_t edges = truth_of(spec.name, 1).curves.size();
    for (const PartValues& values : variants) {
      const std::string what = spec.name + (values.size() == 1 ? " " + values[0].first : "");
      const Truth truth = truth_of(spec.name, 1, values);
      EXPECT_TRUE(validate(truth.sketch).empty()) << what;
      EXPECT_TRUE(counts || truth.curves.size() == edges) << what;
    }
  }
}

TEST(Parts, WhatSeedsDrawHasNoEdgeTooShortToMatter) {
  for (const std::string& name : part_names())
    for (std::uint64_t seed : {11, 12}) {
      const Truth truth = truth_of(name, seed);
      EXPECT_TRUE(validate(truth.sketch).empty()) << name << " " << seed;
      for (const TruthCurve& curve : truth.curves) {
        EXPECT_GT(length(curve), 0.01) << name << " " << seed;
        EXPECT_GT(curve.dihedral_deg, 10) << name << " " << seed;
      }
    }
}

// So arcs that nearly go on from lines or arcs are taken to do so (kTangentLogOdds).
TEST(Parts, JointsOfArcsAreTangentOrTurnByMuch) {
  size_t tangent = 0;
  for (const std::string& name : part_names()) {
    const Sketch truth = truth_of(name, 1).sketch;
    const size_t exact = find_tangent_joints(truth, 0.1 * M_PI / 180).size();
    EXPECT_EQ(find_tangent_joints(truth, 20 * M_PI / 180).size(), exact) << name;
    tangent += exact;
  }
  EXPECT_GT(tangent, 100u);
  RecordProperty("tangent", std::to_string(tangent));
  std::printf("%zu joints of arcs are tangent, and none turns by 0.1 to 20 degrees\n", tangent);
}

TEST(Parts, GapIsTheDistanceOfTheRibsInLongestSides) {
  for (double gap : {0.002, 0.05, 0.2}) {
    const Truth truth = truth_of("rib-plate", 4, {{"gap", gap}});
    double nearest = 1;
    for (int i = 0; i < truth.sketch.nodes.cols(); ++i)
      nearest = std::min(nearest, std::abs(truth.sketch.nodes(1, i)));
    EXPECT_NEAR(2 * nearest, gap, 1e-9);
  }
}

TEST(Parts, WallIsTheThicknessOfTheTray) {
  const Truth truth = truth_of("tray", 4, {{"wall", 0.01}});
  double inner = 0;
  for (int i = 0; i < truth.sketch.nodes.cols(); ++i)
    if (truth.sketch.nodes(0, i) < 0.5 - 1e-6) inner = std::max(inner, truth.sketch.nodes(0, i));
  EXPECT_NEAR(0.5 - inner, 0.01, 1e-9);
}

TEST(Parts, CreaseIsTheAngleOfTheRidge) {
  for (const char* part : {"ridge-block", "pleat-block", "crease-disc"})
    for (double crease : {3.0, 20.0, 90.0}) {
      const Truth truth = truth_of(part, 4, {{"crease", crease}});
      const bool found = std::any_of(
          truth.curves.begin(), truth.curves.end(),
          [&](const TruthCurve& c) { return std::abs(c.dihedral_deg - crease) < 1e-6; });
      EXPECT_TRUE(found) << part << " " << crease;
    }
}

TEST(Parts, RidgesAndValleysOfPleatsTurnAlike) {
  const Truth truth = truth_of("pleat-block", 4, {{"crease", 15}, {"pleats", 3}});
  EXPECT_EQ(5, std::count_if(truth.curves.begin(), truth.curves.end(), [](const TruthCurve& c) {
              return std::abs(c.dihedral_deg - 15) < 1e-6;
            }));
}

TEST(Parts, FilletIsTheRadiusOfTheArcs) {
  for (const char* part : {"fillet-block", "fillet-step"})
    for (double radius : {0.001, 0.1}) {
      const Truth truth = truth_of(part, 4, {{"fillet", radius}});
      int arcs = 0;
      for (const TruthCurve& curve : truth.curves) {
        if (curve.type != "Circle") continue;
        ++arcs;
        EXPECT_NEAR(length(curve), radius * M_PI / 2, 0.01 * radius) << part;
      }
      EXPECT_EQ(arcs, part == std::string("fillet-block") ? 4 : 2);
    }
}

// Machined faces bound the bracket and the flange: whatever was cast has no edge.
TEST(Parts, RoundedEdgesAreNoEdges) {
  using Kinds = std::map<std::string, int>;
  EXPECT_EQ(kinds(truth_of("cast-bracket", 1)), (Kinds{{"Line", 4}, {"Circle", 8}}));
  EXPECT_EQ(kinds(truth_of("blend-step", 1)), (Kinds{{"Line", 15}, {"Circle", 6}}));
  EXPECT_EQ(kinds(truth_of("cast-flange", 1, {{"holes", 4}})), (Kinds{{"Circle", 11}}));
}

TEST(Parts, ATaperEndsInARoundOfItsRadiusAndBeginsWhereTheEdgeIsSharp) {
  const Truth truth = truth_of("taper-block", 3, {{"round", 0.06}, {"sharp", 0.4}});
  EXPECT_EQ(kinds(truth), (std::map<std::string, int>{{"Line", 12}, {"Circle", 2}}));
  int sharp = 0;
  for (const TruthCurve& c : truth.curves) {
    if (c.type == "Circle") {
      EXPECT_NEAR(length(c), 0.06 * M_PI / 2, 1e-4);
    }
    sharp += std::abs(length(c) - 0.4) < 1e-6;
  }
  EXPECT_EQ(sharp, 2);
}

TEST(Parts, SettingOneDimensionLeavesTheOthersAsTheSeedDrewThem) {
  const Eigen::Matrix3Xd a = truth_of("l-bracket", 5).sketch.nodes;
  const Eigen::Matrix3Xd b = truth_of("l-bracket", 5, {{"thickness", 7}}).sketch.nodes;
  ASSERT_EQ(a.cols(), b.cols());
  const Vector3d size_a = a.rowwise().maxCoeff() - a.rowwise().minCoeff();
  const Vector3d size_b = b.rowwise().maxCoeff() - b.rowwise().minCoeff();
  EXPECT_LT((size_a - size_b).norm(), 1e-12);
  EXPECT_GT((a - b).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Parts, WrongValuesAreToldWhatThereIs) {
  for (const PartValues& values :
       {PartValues{{"gape", 0.1}}, PartValues{{"gap", 0.3}}, PartValues{{"gap", std::nan("")}}}) {
    const std::string words = wrong_values(*find_part("rib-plate"), values);
    EXPECT_THAT(words, testing::HasSubstr("gap (0.002 to 0.2 of longest side)"));
    EXPECT_THAT(words, testing::HasSubstr("wall"));
    EXPECT_THROW(make_part("rib-plate", 1, values), InputError);
  }
  EXPECT_NE(wrong_values(*find_part("flange"), {{"holes", 4.5}}), "");
  EXPECT_EQ(wrong_values(*find_part("flange"), {{"holes", 4}}), "");
}

TEST(Parts, EdgesAreOfTheKindsThatTheirMakingGives) {
  using Kinds = std::map<std::string, int>;
  EXPECT_EQ(kinds(truth_of("oblique-hole", 1)), (Kinds{{"Line", 12}, {"Ellipse", 2}}));
  // The cylinder's seam cuts one of the arcs.
  EXPECT_EQ(kinds(truth_of("ridge-cylinder", 1)),
            (Kinds{{"Circle", 1}, {"Ellipse", 3}, {"Line", 1}}));
  EXPECT_EQ(kinds(truth_of("ellipse-plate", 1)), (Kinds{{"Line", 8}, {"Ellipse", 4}}));
  EXPECT_EQ(kinds(truth_of("cross-drilled", 1)), (Kinds{{"Circle", 3}, {"BSpline", 2}}));
  EXPECT_EQ(kinds(truth_of("spline-plate", 1)), (Kinds{{"Circle", 2}, {"BSpline", 2}}));
  // The loft stores its arcs as B-splines.
  EXPECT_EQ(kinds(truth_of("loft-grip", 1)), (Kinds{{"Circle", 10}, {"BSpline", 4}}));
  // Torus between cylinders, and sphere after cylinder: no edge between them.
  EXPECT_EQ(kinds(truth_of("elbow", 1)), (Kinds{{"Circle", 6}}));
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "sketches/solve/family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "sketches/curve/curve.h"
#include "sketches/solve/similarity.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// A block with a bore along z: its lines share eight nodes.
struct Block {
  double length, width, height, radius, x;
};

Sketch make_block(const Block& b) {
  Sketch s;
  for (int k = 0; k < 8; ++k)
    s.add_node({k & 1 ? b.length : 0, k & 2 ? b.width : 0, k & 4 ? b.height : 0});
  for (int k = 0; k < 8; ++k)
    for (const int step : {1, 2, 4})
      if (!(k & step)) s.add_stroke(StrokeKind::kLine, k, k + step, {});
  for (const double z : {0.0, b.height})
    s.add_stroke(StrokeKind::kCircle, -1, -1, {{b.x, b.width / 2, z}, {0, 0, b.radius}});
  return s;
}

// The same edges in another order, some backwards, circles with the other normal.
Sketch shuffled(const Sketch& sketch, unsigned seed, std::vector<int>* order) {
  std::mt19937 random(seed);
  order->resize(sketch.size());
  for (int s = 0; s < sketch.size(); ++s) (*order)[s] = s;
  std::shuffle(order->begin(), order->end(), random);
  Sketch out;
  for (const int s : *order) {
    const ControlPoints c = control_points(sketch, s);
    if (sketch.strokes[s].kind == StrokeKind::kCircle)
      out.add_stroke(StrokeKind::kCircle, -1, -1, {c.p[0], -c.p[1]});
    else if (random() % 2)
      out.add_stroke(StrokeKind::kLine, out.add_node(c.p[1]), out.add_node(c.p[0]), {});
    else
      out.add_stroke(StrokeKind::kLine, out.add_node(c.p[0]), out.add_node(c.p[1]), {});
  }
  return out;
}

std::vector<Block> blocks() {
  return {{1, 0.6, 0.3, 0.1, 0.4},
          {1, 0.7, 0.25, 0.14, 0.5},
          {1, 0.5, 0.4, 0.12, 0.55},
          {1, 0.65, 0.35, 0.09, 0.45}};
}

TEST(Family, StrokesOfSiblingsAreFoundWhateverTheirOrderDirectionSizeAndPlace) {
  const Sketch first = make_block(blocks()[0]);
  for (unsigned k = 1; k < blocks().size(); ++k) {
    std::vector<int> order;
    const Similarity pose{3, Eigen::Matrix3d::Identity(), {5, -2, 1}};
    const Sketch other = moved(shuffled(make_block(blocks()[k]), k, &order), pose);
    const std::vector<StrokeMatch> matches = match_siblings(first, other);
    for (int s = 0; s < first.size(); ++s) {
      ASSERT_GE(matches[s].other, 0) << s;
      EXPECT_EQ(order[matches[s].other], s);
    }
  }
}

TEST(Family, CoordinatesThatPartsShareAreOneNumber) {
  std::vector<Sketch> siblings;
  for (const Block& b : blocks()) siblings.push_back(make_block(b));
  const Family family = learn_family(siblings);
  // Two faces along each axis, the place of the bore, half the width, and the bore's axis.
  EXPECT_EQ(family.mean.size(), 6 + 2 + 3);
  EXPECT_EQ(family.numbers.cols(), 4);
  EXPECT_EQ(family.modes.size(), 3);
  EXPECT_GE(family.modes[0], family.modes[2]);
  EXPECT_TRUE(validate(family.with(family.mean)).empty());
  const Sketch same = family.with(family.numbers.col(2));
  const double scale = same.nodes(0, 1) - same.nodes(0, 0);
  EXPECT_NEAR((same.nodes(1, 2) - same.nodes(1, 0)) / scale, 0.5, 1e-9);
  EXPECT_NEAR((same.nodes(2, 4) - same.nodes(2, 0)) / scale, 0.4, 1e-9);
  EXPECT_NEAR(stroke_length(same, 12) / scale, 2 * M_PI * 0.12, 1e-6);
}

TEST(Family, CirclesAboutOneAxisHaveOneRadiusWhicheverWayTheirNormalsPoint) {
  std::vector<Sketch> siblings;
  for (const Block& b : blocks()) {
    siblings.push_back(make_block(b));
    siblings.back().handles.rightCols(1) *= -1;
  }
  const Family family = learn_family(siblings);
  EXPECT_EQ(family.mean.size(), 6 + 2 + 3);
  const Sketch same = family.with(family.numbers.col(2));
  EXPECT_NEAR(stroke_length(same, 12), stroke_length(same, 13), 1e-9);
}

TEST(Family, WhatASiblingLacksMovesAsItsNeighboursDoAndIsLessProbable) {
  std::vector<Sketch> siblings;
  for (const Block& b : blocks()) siblings.push_back(make_block(b));
  std::vector<bool> keep(siblings[1].size(), true);
  keep[12] = keep[0] = false;
  siblings[1] = keep_strokes(siblings[1], keep);
  const Family family = learn_family(siblings);
  ASSERT_EQ(family.graph.size(), 14);
  EXPECT_EQ(family.had_by[12], 3);
  EXPECT_EQ(family.had_by[13], 4);
  EXPECT_GT(family.log_odds(13), family.log_odds(12));
  EXPECT_GT(family.log_odds(12), 0);
  EXPECT_TRUE(family.numbers.allFinite());
  EXPECT_TRUE(validate(family.with(family.mean)).empty());
}

TEST(Family, OneSiblingIsAFamilyOfWhichNothingButItsShapeIsKnown) {
  const Family family = learn_family({make_block(blocks()[0])});
  EXPECT_EQ(family.modes.size(), 0);
  EXPECT_TRUE(family.with(family.mean).nodes.isApprox(make_block(blocks()[0]).nodes));
  EXPECT_TRUE((family.covariance.diagonal().array() > 0).all());
}

}  // namespace
}  // namespace sketchsplat

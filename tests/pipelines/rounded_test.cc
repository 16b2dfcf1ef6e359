// SPDX-License-Identifier: MIT
#include "pipelines/survey/rounded.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/types/errors.h"
#include "pipelines/method/finish.h"
#include "pipelines/options/options.h"
#include "tests/pipelines/rounded_cube.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

// The sketch, with a third of the rounded edge alone.
Sketch with_a_piece(const RoundedCube& s) {
  Sketch piece = s.sketch;
  const Stroke& stroke = piece.strokes[s.rounded];
  piece.nodes.col(stroke.end) =
      (2 * piece.nodes.col(stroke.begin) + piece.nodes.col(stroke.end)) / 3;
  return piece;
}

TEST(RoundedStrokes, WhatGrewFromAPieceIsJudgedWithAllItsLength) {
  const RoundedCube s(6, 1.3f), sharp(0);
  const Sketch piece = with_a_piece(s), sharp_piece = with_a_piece(sharp);
  std::vector<bool> expected(s.sketch.size());
  EXPECT_EQ(rounded_strokes(sharp.sketch, {sharp_piece, sharp_piece}, sharp.world, {}), expected);
  EXPECT_EQ(rounded_strokes(s.sketch, {piece, s.sketch}, s.world, {}), expected)
      << "what was judged with others that bear it out stays";
  expected[s.rounded] = true;
  EXPECT_EQ(rounded_strokes(s.sketch, {piece, piece}, s.world, {}), expected);
}

TEST(RoundedStrokes, WhatWasChosenGoesIfItSurelyIsOneAsItIsNow) {
  const RoundedCube s(6, 1.3f), sharp(0);
  const std::vector<bool> round =
      rounded_strokes(s.sketch, {s.sketch, s.sketch}, s.world, SelectOptions());
  EXPECT_EQ(std::count(round.begin(), round.end(), true), 1);
  EXPECT_TRUE(round[s.rounded]);
  // Odds by which it is not sure.
  SelectOptions options;
  options.round_odds = std::exp(1 - s.nats());
  EXPECT_FALSE(rounded_strokes(s.sketch, {s.sketch, s.sketch}, s.world, options)[s.rounded]);
  EXPECT_TRUE(rounded_strokes(s.sketch, {{}, {}}, s.world, options)[s.rounded]);
}

// The cube with its strokes judged, as a reconstruction has it at last.
FinishedSketch finished_of(const RoundedCube& s) {
  FinishedSketch out;
  out.sketch = s.sketch;
  judge_strokes(s.world, {}, {}, &out);
  return out;
}

TEST(RoundedStrokes, AreLeftOutAndCountedApartFromUnsureOnes) {
  const RoundedCube s(6, 1.3f);
  FinishedSketch finished = finished_of(s);
  finished.sketch.evidence[s.rounded == 0 ? 1 : 0].confidence = 0.2;
  ReconstructOptions options;
  options.min_confidence = 0.3;
  const std::vector<int> now = leave_out_doubtful({{}, {}}, s.world, options, &finished);
  EXPECT_EQ(finished.sketch.size(), 10);
  EXPECT_EQ(finished.features.size(), 10u);
  EXPECT_EQ(finished.rounded, 1);
  EXPECT_EQ(finished.unsure, 1);
  EXPECT_EQ(now[s.rounded], -1);
  EXPECT_EQ(*std::max_element(now.begin(), now.end()), 9);
}

TEST(RoundedStrokes, WhereAllAreUnsureTheMessageSaysSo) {
  const RoundedCube s(0);
  FinishedSketch finished = finished_of(s);
  ReconstructOptions options;
  options.min_confidence = 1.1;
  try {
    leave_out_doubtful({s.sketch, s.sketch}, s.world, options, &finished);
    FAIL() << "nothing is left";
  } catch (const TooLittleError& e) {
    EXPECT_NE(std::string(e.what()).find("12 less probable"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "tests/topology/build_sketch.h"

namespace sketchsplat {
namespace {

StrokeKind kind_after(const Sketch& s) {
  const PassResult r = simplify_kinds(s, one_pixel());
  expect_sound(r, s);
  EXPECT_EQ(r.sketch.size(), 1);
  return r.sketch.strokes.at(0).kind;
}

TEST(SimplifyKinds, ACubicNearItsChordBecomesALine) {
  Sketch flat, bent;
  add_bezier(&flat, {0, 0, 0}, {30, 0.6, 0}, {60, 0.6, 0}, {90, 0, 0});  // rises 0.45
  add_bezier(&bent, {0, 0, 0}, {30, 0.8, 0}, {60, 0.8, 0}, {90, 0, 0});  // rises 0.6
  EXPECT_EQ(kind_after(flat), StrokeKind::kLine);
  EXPECT_EQ(kind_after(bent), StrokeKind::kArc);
}

TEST(SimplifyKinds, ACubicThatRunsToAndFroOnItsChordIsNoLine) {
  Sketch s;
  add_bezier(&s, {0, 0, 0}, {150, 0, 0}, {-60, 0, 0}, {90, 0, 0});
  EXPECT_EQ(kind_after(s), StrokeKind::kBezier);
}

TEST(SimplifyKinds, AFlatArcBecomesALine) {
  Sketch s;
  add_arc(&s, {0, 0, 0}, 1000, 0, 3);  // sagitta 0.34
  EXPECT_EQ(kind_after(s), StrokeKind::kLine);
}

TEST(SimplifyKinds, ACubicOnACircleBecomesItsArcAndAnSDoesNot) {
  Sketch s, wave;
  const double k = 100 * 4 / 3. * std::tan(M_PI / 8);  // quarter circle
  add_bezier(&s, {100, 0, 0}, {100, k, 0}, {k, 100, 0}, {0, 100, 0});
  const PassResult r = simplify_kinds(s, one_pixel());
  ASSERT_EQ(r.sketch.strokes[0].kind, StrokeKind::kArc);
  EXPECT_NEAR(stroke_length(r.sketch, 0), 50 * M_PI, 0.1);
  add_bezier(&wave, {0, 0, 0}, {30, 30, 0}, {60, -30, 0}, {90, 0, 0});
  EXPECT_EQ(kind_after(wave), StrokeKind::kBezier);
}

TEST(SimplifyKinds, AnArcWithFreeEndsAndASmallGapBecomesACircle) {
  Sketch s;
  add_arc(&s, {0, 0, 0}, 30, 0, 350);  // gap 5.2 px
  EXPECT_EQ(kind_after(s), StrokeKind::kCircle);
  Sketch keyed;
  add_arc(&keyed, {0, 0, 0}, 30, 0, 350);
  keyed.add_stroke(StrokeKind::kLine, 0, keyed.add_node({40, 0, 0}), {});
  EXPECT_EQ(simplify_kinds(keyed, one_pixel()).changes, 0);
}

TEST(SimplifyKinds, AnEllipseWithEqualAxesBecomesACircle) {
  for (double b : {30.6, 32.0}) {
    Sketch s;
    s.add_stroke(StrokeKind::kEllipse, -1, -1,
                 {Vector3d(1, 2, 3), Vector3d(30, 0, 0), Vector3d(0, 0, b)});
    EXPECT_EQ(kind_after(s), b < 31 ? StrokeKind::kCircle : StrokeKind::kEllipse);
  }
}

TEST(SimplifyKinds, AnEllipseByConjugateAxesIsJudgedByItsPrincipalOnes) {
  // Conjugate half axes of equal length, but 60 deg apart: no circle.
  Sketch s;
  s.add_stroke(StrokeKind::kEllipse, -1, -1,
               {Vector3d(0, 0, 0), Vector3d(30, 0, 0), Vector3d(15, 26, 0)});
  EXPECT_EQ(kind_after(s), StrokeKind::kEllipse);
}

TEST(SimplifyKinds, EndsStayWhereTheyAre) {
  Sketch s;
  add_bezier(&s, {0, 0, 0}, {30, 0.3, 0}, {60, 0.3, 0}, {90, 0, 0});
  const PassResult r = simplify_kinds(s, one_pixel());
  EXPECT_EQ(r.sketch.nodes, s.nodes);
}

}  // namespace
}  // namespace sketchsplat

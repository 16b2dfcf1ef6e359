// SPDX-License-Identifier: MIT
#include "sketches/graph/sketch.h"

#include <gmock/gmock.h>

#include <limits>

#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(Validate, HasNothingToSayAboutASoundSketch) {
  EXPECT_THAT(validate(all_kinds()), IsEmpty());
  EXPECT_THAT(validate(Sketch()), IsEmpty());
}

TEST(ControlPoints, ThoseOfASketchMakeItAgainAndStrokesMeetHalfWay) {
  const Sketch before = five_kinds();
  std::vector<ControlPoints> controls;
  for (int s = 0; s < before.size(); ++s) controls.push_back(control_points(before, s));
  const Sketch same = with_control_points(before, controls);
  EXPECT_TRUE(same.nodes.isApprox(before.nodes));
  EXPECT_TRUE(same.handles.isApprox(before.handles));
  Sketch corner;
  for (const double x : {0.0, 1.0, 2.0}) corner.add_node({x, 0, 0});
  corner.add_stroke(StrokeKind::kLine, 0, 1, {});
  corner.add_stroke(StrokeKind::kLine, 1, 2, {});
  controls = {control_points(corner, 0), control_points(corner, 1)};
  controls[0].p[1].y() = 1;
  EXPECT_TRUE(
      with_control_points(corner, controls).nodes.col(1).isApprox(Eigen::Vector3d(1, 0.5, 0)));
}

TEST(AppendStrokes, KeepsBothSketchesAsTheyWere) {
  Sketch both = five_kinds();
  const Sketch more = all_kinds();
  append_strokes(more, &both);
  append_strokes(Sketch(), &both);
  EXPECT_THAT(validate(both), IsEmpty());
  ASSERT_EQ(both.size(), five_kinds().size() + more.size());
  for (int i = 0; i < both.size(); ++i) {
    const int own = i < five_kinds().size() ? i : i - five_kinds().size();
    const ControlPoints found = control_points(both, i);
    const ControlPoints expected = control_points(own == i ? five_kinds() : more, own);
    ASSERT_EQ(found.count, expected.count);
    for (int k = 0; k < found.count; ++k) EXPECT_EQ(found.p[k], expected.p[k]);
  }
}

TEST(Validate, FindsWhatIsNotFinite) {
  Sketch s = five_kinds();
  s.nodes(1, 2) = kNan;
  EXPECT_THAT(validate(s), Contains("a node is not finite"));
  s = five_kinds();
  s.handles(0, 0) = kInf;
  EXPECT_THAT(validate(s), Contains("a handle is not finite"));
}

TEST(Validate, FindsEvidenceOfAnotherSizeOrRange) {
  Sketch s = five_kinds();
  s.evidence.pop_back();
  EXPECT_THAT(validate(s), ElementsAre("evidence has 5 entries for 6 strokes"));
  s = five_kinds();
  s.evidence[2].opacity = 1.5;
  EXPECT_THAT(validate(s), ElementsAre("stroke 2: has an opacity outside [0, 1]"));
  for (auto breaks :
       {+[](Evidence* e) { e->opacity = kNan; }, +[](Evidence* e) { e->sigma = kInf; },
        +[](Evidence* e) { e->rms_px = -1; }, +[](Evidence* e) { e->support_views = -1; }}) {
    s = five_kinds();
    breaks(&s.evidence[3]);
    EXPECT_THAT(validate(s), ElementsAre(HasSubstr("stroke 3: ")));
  }
}

TEST(Validate, FindsIndicesOutOfRange) {
  for (int bad : {-1, 4, 1000}) {
    Sketch s = five_kinds();
    s.strokes[0].begin = bad;
    EXPECT_THAT(validate(s), Contains("stroke 0: node index out of range"));
    s = five_kinds();
    s.strokes[3].end = bad;
    EXPECT_THAT(validate(s), Contains("stroke 3: node index out of range"));
  }
  for (int bad : {-1, 7, 1000}) {
    Sketch s = five_kinds();
    s.strokes[5].handle = bad;
    EXPECT_THAT(validate(s), Contains("stroke 5: handle index out of range"));
  }
}

TEST(Validate, FindsSharedHandles) {
  Sketch s = five_kinds();
  s.strokes[2].handle = s.strokes[1].handle;
  EXPECT_THAT(validate(s), Contains("stroke 2: shares a handle with another stroke"));
}

TEST(Validate, FindsUnusedColumns) {
  Sketch s = five_kinds();
  s.add_node({5, 5, 5});
  EXPECT_THAT(validate(s), ElementsAre("node 4 belongs to no stroke"));
  s = five_kinds();
  s.handles.conservativeResize(3, 9);
  s.handles.col(8).setZero();
  EXPECT_THAT(validate(s), ElementsAre("handle 8 belongs to no stroke"));
}

TEST(Validate, FindsClosedCurvesWithEnds) {
  Sketch s = five_kinds();
  s.strokes[4].begin = 0;
  EXPECT_THAT(validate(s), ElementsAre("stroke 4: a closed curve has end nodes"));
}

TEST(Validate, FindsStrokesWithoutExtent) {
  Sketch s = five_kinds();
  s.nodes.col(1) = s.nodes.col(0);
  EXPECT_THAT(validate(s), ElementsAre("stroke 0: has zero length"));
  s = five_kinds();
  s.handles.col(s.strokes[4].handle + 1).setZero();
  EXPECT_THAT(validate(s), ElementsAre("stroke 4: has no extent"));
  s = five_kinds();  // u and v of the ellipse in one line
  s.handles.col(s.strokes[5].handle + 2) = -3.7 * s.handles.col(s.strokes[5].handle + 1);
  EXPECT_THAT(validate(s), ElementsAre("stroke 5: has no extent"));
  s = five_kinds();
  s.strokes[1].end = s.strokes[1].begin;
  EXPECT_THAT(validate(s), ElementsAre("stroke 1: has zero length"));
}

TEST(Validate, AcceptsAClosedCubicButNotAPoint) {
  Sketch s;
  const int n = s.add_node({1, 2, 3});
  s.add_stroke(StrokeKind::kBezier, n, n, {{2, 2, 3}, {1, 3, 3}});
  EXPECT_THAT(validate(s), IsEmpty());
  s.handles.colwise() = Eigen::Vector3d(1, 2, 3);
  EXPECT_THAT(validate(s), ElementsAre("stroke 0: has zero length"));
}

TEST(Validate, AcceptsAnySizeOfAPart) {
  for (double scale : {1e-12, 1e-3, 1e3, 1e12})
    EXPECT_THAT(validate(moved(all_kinds(), scale, Random().rotation(), {0, 0, 0})), IsEmpty());
}

TEST(KeepStrokes, DropsWhatNobodyUsesAndKeepsTheRestBitForBit) {
  const Sketch s = five_kinds();
  const Sketch kept = keep_strokes(s, {false, true, true, false, false, true});
  EXPECT_THAT(validate(kept), IsEmpty());
  ASSERT_EQ(kept.size(), 3);
  EXPECT_EQ(kept.nodes.cols(), 3);
  EXPECT_EQ(kept.handles.cols(), 6);
  EXPECT_EQ(kept.strokes[0].end, kept.strokes[1].begin) << "the junction is shared still";
  const int origin[] = {1, 2, 5};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(kept.strokes[i].kind, s.strokes[origin[i]].kind);
    EXPECT_EQ(kept.evidence[i].support_views, s.evidence[origin[i]].support_views);
    const ControlPoints now = control_points(kept, i), before = control_points(s, origin[i]);
    for (int k = 0; k < now.count; ++k) EXPECT_EQ(now.p[k], before.p[k]);
  }
}

TEST(KeepStrokes, KeepsAllOrNothing) {
  const Sketch all = keep_strokes(five_kinds(), std::vector<bool>(6, true));
  EXPECT_EQ(all.nodes, five_kinds().nodes);
  EXPECT_EQ(all.handles, five_kinds().handles);
  const Sketch none = keep_strokes(five_kinds(), std::vector<bool>(6, false));
  EXPECT_EQ(none.size() + none.nodes.cols() + none.handles.cols(), 0);
  EXPECT_EQ(keep_strokes(Sketch(), {}).size(), 0);
}

TEST(NodeDegrees, CountEndsAndNothingOfClosedStrokes) {
  Sketch s;
  s.nodes = Eigen::Matrix3Xd::Random(3, 4);
  s.add_stroke(StrokeKind::kLine, 0, 1, {});
  s.add_stroke(StrokeKind::kLine, 1, 2, {});
  s.add_stroke(StrokeKind::kBezier, 1, 1, {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()});
  EXPECT_EQ(node_degrees(s), (std::vector<int>{1, 4, 1, 0}));
}

TEST(KindNames, ReadBackAndRefuseOthers) {
  for (int i = 0; i < 5; ++i) {
    StrokeKind kind;
    ASSERT_TRUE(parse_kind(kind_name(StrokeKind(i)), &kind));
    EXPECT_EQ(kind, StrokeKind(i));
  }
  StrokeKind kind = StrokeKind::kArc;
  EXPECT_FALSE(parse_kind("Line", &kind));
  EXPECT_FALSE(parse_kind("", &kind));
  EXPECT_EQ(kind, StrokeKind::kArc);
}

}  // namespace
}  // namespace sketchsplat

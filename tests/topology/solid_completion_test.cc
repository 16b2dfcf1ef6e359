// SPDX-License-Identifier: MIT
// Solids of which images show too little, or something twice.
#include <algorithm>
#include <cmath>

#include "gmock/gmock.h"
#include "sketches/curve/curve.h"
#include "tests/topology/found_solid.h"
#include "tests/topology/solids.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A box of 4 x 3 x 2.
SolidMaker box() {
  SolidMaker m;
  m.frame(2, 1.5, 0, 2);
  return m;
}

// It with a pocket of 2 x 1 x 1 in its top: strokes 0 to 11 are the box, then the rim (4), the
// floor (4) and the corners (4) of the pocket.
Sketch pocket() {
  SolidMaker m = box();
  m.frame(1, 0.5, 2, 1);
  return m.solid.edges;
}

TEST(SolidCompletion, AFloorIsACopyOfTheRimAtTheDepthThatOneEdgeOrTwoCornersTell) {
  EXPECT_NEAR(volume_of(pocket()), 24 - 2, 1e-9);
  for (const int corner : {20, 21, 22}) {  // the rim and two lines down from it
    std::vector<int> missing = {16, 17, 18, 19};
    for (const int s : {20, 21, 22, 23})
      if (s != corner && s != corner + 1) missing.push_back(s);
    EXPECT_NEAR(volume_of(without(pocket(), missing)), 24 - 2, 1e-9);
    missing.push_back(corner);
    EXPECT_FALSE(find_solid(without(pocket(), missing)).solid) << "one may go on unseen";
  }
  // The rim and one edge of the floor.
  EXPECT_NEAR(volume_of(without(pocket(), {17, 18, 19, 20, 21, 22, 23})), 24 - 2, 1e-9);
}

TEST(SolidCompletion, APocketOfUnknownDepthIsRefused) {
  const SolidSearch search = find_solid(without(pocket(), {16, 17, 18, 19, 20, 21, 22, 23}));
  EXPECT_FALSE(search.solid);
  EXPECT_THAT(search.why, HasSubstr("4 of 16 curves"));
}

TEST(SolidCompletion, TwoOutlinesAloneAreJoinedAtTheirCorners) {
  EXPECT_NEAR(volume_of(without(pocket(), {8, 9, 10, 11})), 24 - 2, 1e-9);
}

TEST(SolidCompletion, LinesThatEndShortlyBeforeAPlaneEndInIt) {
  for (const bool foot_is_seen : {true, false}) {
    SolidMaker m = box();
    if (foot_is_seen) m.rectangle(1, 0.5, {0, 0, 2});
    const std::vector<int> top = m.rectangle(1, 0.5, {0, 0, 3});
    for (size_t i = 0; i < 4; ++i)
      m.line(m.node(m.solid.edges.nodes.col(top[i]) - Eigen::Vector3d(0, 0, 0.988)), top[i]);
    EXPECT_NEAR(volume_of(m.solid.edges), 24 + 2, 1e-6);
  }
}

// Where a line runs into an arc is known to the root of what both are known to.
TEST(SolidCompletion, JointsOfLinesAndArcsMaySlideAlongThem) {
  for (const double slide : {0.0, 0.02, 0.035}) {
    SolidMaker m;
    for (const double z : {0.0, 2.0}) {
      const double r = 1, s = z > 0 ? slide : -slide;
      const int a = m.node({-3 + r, -2, z}), b = m.node({3 - r - s, -2, z}),
                c = m.node({3, -2 + r, z}), d = m.node({3, 2, z}), e = m.node({-3, 2, z}),
                f = m.node({-3, -2 + r, z});
      const double k = r * (1 - std::sqrt(0.5));
      m.line(a, b);
      m.arc(b, c, {3 - k, -2 + k, z});
      m.line(c, d);
      m.line(d, e);
      m.line(e, f);
      m.arc(f, a, {-3 + k, -2 + k, z});
    }
    EXPECT_NEAR(volume_of(m.solid.edges), 2 * (24 - 2 * (1 - M_PI / 4)), 0.02) << slide;
  }
}

TEST(SolidCompletion, AnEdgeSeenTwiceIsOneEdge) {
  SolidMaker m = box();
  m.line(m.node({-1.5, 1.51, 1.99}), m.node({1, 1.505, 2.01}));
  const SolidSearch search = find_solid(m.solid.edges);
  EXPECT_NEAR(check_of(search).volume, 24, 1e-9);
  EXPECT_EQ(search.twice, 1);
  EXPECT_THAT(search.doubtful, IsEmpty());
}

// The floor of a round-cornered pocket, of which arcs are seen that end too early or too late.
TEST(SolidCompletion, PiecesOfAFloorThatEndWrongAreItsCopySeenTwice) {
  for (const double turn : {1.35, 1.57, 1.75}) {
    SolidMaker m = box();
    const double r = 0.4, x = 1.2, y = 0.7;
    std::vector<int> rim;
    for (int corner = 0; corner < 4; ++corner) {
      const double sx = corner == 0 || corner == 3 ? 1 : -1, sy = corner < 2 ? 1 : -1;
      const Vector3d centre(sx * (x - r), sy * (y - r), 2), down(0, 0, -1);
      const auto at = [&](double a) {
        const double angle = corner * M_PI / 2 + a;
        return Vector3d(centre + r * Vector3d(std::cos(angle), std::sin(angle), 0));
      };
      rim.push_back(m.node(at(0))), rim.push_back(m.node(at(M_PI / 2)));
      m.arc(rim[rim.size() - 2], rim.back(), at(M_PI / 4));
      if (corner % 2 == 0)
        m.arc(m.node(at(0) + down), m.node(at(turn) + down), at(turn / 2) + down);
    }
    for (size_t i = 1; i < 8; i += 2) m.line(rim[i], rim[(i + 1) % 8]);
    EXPECT_NEAR(volume_of(m.solid.edges), 24 - (4 * x * y - (4 - M_PI) * r * r), 0.01) << turn;
  }
}

TEST(SolidCompletion, AThinWallAsksForAFineTolerance) {
  SolidMaker m;
  m.frame(2, 1.5, 0, 0.08);
  SolidOptions options;
  options.tolerance = 4e-3;
  EXPECT_NEAR(check_of(find_solid(m.solid.edges, options)).volume, 0.96, 1e-9);
}

// The plate of half a side's thickness, its hole's upper rim from `first` to `last` [rad] in two
// arcs, which meet, leave a gap or run past one another.
Sketch plate_with_open_rim(double first, double middle_end, double middle_begin, double last) {
  const Sketch plate = plate_with_hole(0.5).edges;
  int upper = -1;
  for (int s = 0; s < plate.size(); ++s)
    if (plate.strokes[s].kind == StrokeKind::kCircle &&
        (upper < 0 || control_points(plate, s).p[0].z() > control_points(plate, upper).p[0].z()))
      upper = s;
  const ControlPoints rim = control_points(plate, upper);
  Sketch out = without(plate, {upper});
  const double radius = rim.p[1].norm();
  const auto at = [&](double angle) {
    return Vector3d(rim.p[0] + radius * Vector3d(std::cos(angle), std::sin(angle), 0));
  };
  for (const auto& [a, b] : {std::pair(first, middle_end), {middle_begin, last}}) {
    const int begin = out.add_node(at(a)), end = out.add_node(at(b));
    out.add_stroke(StrokeKind::kArc, begin, end, {at((a + b) / 2)});
  }
  return out;
}

TEST(SolidCompletion, ArcsOfOneCircleGoOnFromOneToTheOther) {
  const double volume = volume_of(plate_with_hole(0.5).edges);
  EXPECT_NEAR(volume_of(plate_with_open_rim(0, 2, 3, 5.5)), volume, 1e-6) << "gaps";
  EXPECT_NEAR(volume_of(plate_with_open_rim(0, 3.2, 3, 6.4)), volume, 1e-6) << "overlaps";
}

// A pipe of radius 1 along x and a branch of radius 0.6 along z: cubics follow where they meet.
Sketch tee() {
  SolidMaker m;
  m.circle({-2, 0, 0}, Vector3d::UnitX(), 1);
  m.circle({2, 0, 0}, Vector3d::UnitX(), 1);
  m.circle({0, 0, 2}, Vector3d::UnitZ(), 0.6);
  const auto place = [](double a) {
    const double x = 0.6 * std::cos(a), y = 0.6 * std::sin(a);
    return Vector3d(x, y, std::sqrt(1 - y * y));
  };
  const auto slope = [&](double a) { return Vector3d((place(a + 1e-6) - place(a - 1e-6)) / 2e-6); };
  constexpr int kPieces = 8;
  const double turn = 2 * M_PI / kPieces;
  std::vector<int> nodes;
  for (int k = 0; k < kPieces; ++k) nodes.push_back(m.node(place(k * turn)));
  for (int k = 0; k < kPieces; ++k) {
    const double a = k * turn, b = a + turn;
    m.add(StrokeKind::kBezier, nodes[size_t(k)], nodes[size_t(k + 1) % kPieces],
          {place(a) + slope(a) * turn / 3, place(b) - slope(b) * turn / 3});
  }
  return m.solid.edges;
}

TEST(SolidCompletion, CurvesThatOnlyFollowAnEdgeDoNotBendItsSurfaces) {
  const SolidSearch search = find_solid(tee());
  ASSERT_TRUE(search.solid) << search.why;
  double branch = 0;  // above the pipe
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double y = -0.6 + 1.2 * (i + 0.5) / kSteps;
    branch += 2 * std::sqrt(0.36 - y * y) * (2 - std::sqrt(1 - y * y)) * 1.2 / kSteps;
  }
  EXPECT_NEAR(check_of(search).volume, 4 * M_PI + branch, 1e-3);
  std::vector<double> radii;
  for (const Surface& s : search.solid->surfaces)
    if (s.kind == SurfaceKind::kCylinder) radii.push_back(s.radius);
  std::sort(radii.begin(), radii.end());
  ASSERT_EQ(radii.size(), 2u);
  EXPECT_NEAR(radii[0], 0.6, 1e-3);
  EXPECT_NEAR(radii[1], 1, 1e-3);
}

}  // namespace
}  // namespace sketchsplat

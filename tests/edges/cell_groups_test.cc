// SPDX-License-Identifier: MIT
// Places that touch, and the polygon around them.
#include "edges/views/cell_groups.h"

#include <gtest/gtest.h>

#include "edges/views/convex_hull.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(CellGroups, PlacesInCellsThatTouchAreOne) {
  int count = 0;
  const std::vector<int> group = groups_of(
      {{0.5, 0.5, 0.5}, {5.5, 0.5, 0.5}, {1.5, 1.5, 1.5}, {-0.5, 0.5, 0.5}, {5.5, 0.5, 2.6}}, 1,
      &count);
  EXPECT_EQ(count, 3);
  EXPECT_EQ(group[0], group[2]) << "over a corner";
  EXPECT_EQ(group[0], group[3]) << "on both sides of zero";
  EXPECT_NE(group[0], group[1]);
  EXPECT_NE(group[1], group[4]) << "a cell between them";
}

TEST(CellGroups, NoPlacesAreNoGroups) {
  int count = -1;
  EXPECT_TRUE(groups_of({}, 1, &count).empty());
  EXPECT_EQ(count, 0);
}

TEST(ConvexHull, HoldsItsPlacesAndWhatLiesBetweenThem) {
  const std::vector<Vector2d> corners = {{0, 0}, {4, 0}, {0, 4}, {1, 1}};
  const std::vector<Vector2d> hull = convex_hull(corners);
  EXPECT_EQ(hull.size(), 3u) << "one lies inside";
  EXPECT_TRUE(is_inside(hull, {1.9, 1.9}));
  EXPECT_FALSE(is_inside(hull, {2.1, 2.1}));
  EXPECT_TRUE(is_inside(convex_hull(widened(corners, 0.5)), {2.1, 2.1}));
  EXPECT_FALSE(is_inside(convex_hull({}), {0, 0}));
}

}  // namespace
}  // namespace sketchsplat

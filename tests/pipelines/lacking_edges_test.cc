// SPDX-License-Identifier: MIT
#include "pipelines/method/lacking_edges.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"
#include "tests/topology/solids.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

// Knows nothing, or takes everything for print.
class Oracle : public Detector {
 public:
  explicit Oracle(EdgeKind kind) : kind_(kind) {}
  EdgelMap detect(const Scene&, const View&) const override { return {}; }
  std::vector<EdgeKind> judge(const CurvePoints& curves) const override {
    return std::vector<EdgeKind>(size_t(curves.position.cols()), kind_);
  }

 private:
  EdgeKind kind_;
};

Solid cube() { return box_solid({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}); }

EdgeWorld world_of(const std::vector<Polyline>& curves, bool masks = true) {
  EdgeWorld world = ideal_world(ring_of_views(24, kMiddle, 3), curves);
  for (EdgelMap& map : world.maps)
    if (masks) map.mask = Image<uint8_t>(map.width, map.height, 1);
  return world;
}

std::vector<Polyline> cube_with_rim() {
  std::vector<Polyline> curves = cube_edges({0.2, 0.2, 0.2}, 0.6);
  curves.push_back(circle({0.5, 0.5, 0.8}, 0.05 * Vector3d::UnitX(), 0.05 * Vector3d::UnitY()));
  return curves;
}

LackingEdges lacking(const EdgeWorld& world, EdgeKind kind = EdgeKind::kUnknown) {
  return lacking_edges(cube(), world, Oracle(kind), {});
}

TEST(LackingEdges, ACubeLacksNone) {
  const LackingEdges none = lacking(world_of(cube_edges({0.2, 0.2, 0.2}, 0.6)));
  EXPECT_EQ(none.points, 0);
  EXPECT_EQ(none.share, 0);
}

TEST(LackingEdges, TheRimOfASmallHoleIsLacking) {
  const LackingEdges rim = lacking(world_of(cube_with_rim()));
  EXPECT_GT(rim.points, 8);
  EXPECT_GT(rim.share, 0.02);
  EXPECT_LT(rim.share, 0.1);
}

TEST(LackingEdges, OutlinesPrintAndScenesWithoutMasksTellNothing) {
  EdgeWorld world = world_of(cube_with_rim());
  EXPECT_EQ(lacking(world, EdgeKind::kPrint).points, 0);
  EXPECT_GT(lacking(world, EdgeKind::kShape).points, 8);
  EXPECT_EQ(lacking(world_of(cube_with_rim(), false)).points, 0);
  for (EdgelMap& map : world.maps)
    for (Edgel& e : map.edgels) e.outline = true;
  EXPECT_EQ(lacking(world).points, 0);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "topology/solid/adjust.h"

#include <gtest/gtest.h>

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// The rim of a drop through one node, and a face that it bounds.
TEST(Adjust, MovesALoopThroughOneNodeToItsPlane) {
  Solid solid;
  const int tip = solid.edges.add_node({0, 0, 0.01});
  solid.edges.add_stroke(StrokeKind::kBezier, tip, tip, {{2, 1, -0.02}, {2, -1, 0.03}});
  solid.surfaces.resize(1);
  solid.faces = {{0, false, {{{0, true}}}}};
  adjust(&solid);
  EXPECT_LT(solid.gap, 1e-6);
  EXPECT_LT((solid.edges.nodes.col(0) - Vector3d(0, 0, 0)).norm(), 0.03);
  EXPECT_LT((solid.edges.handles.col(0) - Vector3d(2, 1, 0)).norm(), 0.03);
}

// A slanted cut ends in the base: there its rim meets the other one.
TEST(Adjust, MovesRimsOfAnExtrusionThatMeet) {
  Solid solid;
  const int tip = solid.edges.add_node({0, 0, 0});
  const int low = solid.edges.add_node({2, 0, 0}), high = solid.edges.add_node({2.02, 0, 1});
  solid.edges.add_stroke(StrokeKind::kBezier, tip, low, {{0.5, 1, 0}, {1.5, 1, 0}});
  solid.edges.add_stroke(StrokeKind::kBezier, tip, high, {{0.5, 1.01, 0.2}, {1.5, 1, 0.8}});
  solid.edges.add_stroke(StrokeKind::kLine, low, high, {});
  Surface swept;
  swept.kind = SurfaceKind::kExtrusion;
  swept.profile_kind = StrokeKind::kBezier;
  solid.surfaces = {swept};
  solid.faces = {{0, false, {{{0, true}, {2, true}, {1, false}}}}};
  adjust(&solid);
  const Vector3d off = solid.edges.nodes.col(high) - solid.edges.nodes.col(low);
  EXPECT_LT(off.normalized().cross(solid.surfaces[0].axis).norm(), 1e-4);
}

}  // namespace
}  // namespace sketchsplat

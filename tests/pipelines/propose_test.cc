// SPDX-License-Identifier: MIT
#include "pipelines/survey/propose.h"

#include <gtest/gtest.h>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;

const Vector3d kLow(0, 0, 0), kHigh(1, 0.7, 0.5), kMiddle(0.5, 0.35, 0.25);

// Corner k of the box: a bit an axis.
Vector3d corner(int k) {
  Vector3d p = kLow;
  for (int axis = 0; axis < 3; ++axis)
    if (k >> axis & 1) p[axis] = kHigh[axis];
  return p;
}

// The box without the edges for which `missing(a, b)` holds, a < b.
template <typename Missing>
Sketch box(const Missing& missing) {
  Sketch s;
  std::vector<int> node(8, -1);
  for (int a = 0; a < 8; ++a)
    for (int axis = 0; axis < 3; ++axis) {
      const int b = a | 1 << axis;
      if (b == a || missing(a, b)) continue;
      for (int k : {a, b})
        if (node[k] < 0) node[k] = s.add_node(corner(k));
      s.add_stroke(StrokeKind::kLine, node[a], node[b], {});
    }
  return s;
}

bool meets_box(const Vector3d& from, const Vector3d& way) {
  double near = -1e300, far = 1e300;
  for (int k = 0; k < 3; ++k) {
    const double a = (kLow[k] - from[k]) / way[k], b = (kHigh[k] - from[k]) / way[k];
    near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
  }
  return near < far;
}

// Views with masks of the box; only those that look from where `back` points.
EdgeWorld world_of(const Vector3d& back, double least_cosine, bool masks = true) {
  std::vector<View> views;
  std::vector<EdgelMap> maps;
  for (View v : ring_of_views(60, kMiddle, 5)) {
    const Vector3d side = (v.center_in_world() - kMiddle).normalized();
    if (side.dot(back.normalized()) < least_cosine) continue;
    v.camera = {100, 100, 180, 180, 49.5, 49.5};
    EdgelMap map = ideal_edgels(v, polylines_of(box([](int, int) { return false; })));
    if (masks) {
      map.mask = Image<uint8_t>(100, 100, 0);
      for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
          const Vector3d ray((x - 49.5) / 180, (y - 49.5) / 180, 1);
          map.mask.at(x, y) = meets_box(v.center_in_world(),
                                        v.cam_from_world.rotation.transpose() * ray);
        }
    }
    views.push_back(v);
    maps.push_back(map);
  }
  return make_edge_world(views, maps);
}

bool is_edge_of_box(const Sketch& s, int stroke) {
  const Vector3d a = s.nodes.col(s.strokes[stroke].begin), b = s.nodes.col(s.strokes[stroke].end);
  int same = 0;
  for (int k = 0; k < 3; ++k) same += std::abs(a[k] - b[k]) < 1e-9;
  bool corners = same == 2;
  for (const Vector3d& p : {a, b}) {
    double nearest = 1e300;
    for (int k = 0; k < 8; ++k) nearest = std::min(nearest, (corner(k) - p).norm());
    corners &= nearest < 1e-9;
  }
  return corners;
}

TEST(Propose, TheCornerThatNoViewSeesAndItsThreeEdges) {
  const Sketch s = box([](int a, int b) { return a == 0 || b == 0; });
  const Sketch p = propose_edges(s, world_of({1, 1, 1}, 0.75));
  ASSERT_EQ(p.size(), 3);
  EXPECT_EQ(p.nodes.cols(), 4);
  EXPECT_TRUE(validate(p).empty());
  for (int i = 0; i < p.size(); ++i) {
    EXPECT_TRUE(is_edge_of_box(p, i)) << i;
    EXPECT_LE(p.evidence[i].confidence, 0.3);
    EXPECT_EQ(p.evidence[i].support_views, 0);
  }
}

TEST(Propose, TheFourthSideBetweenCornersThatAreThere) {
  const Sketch s = box([](int a, int b) { return a == 0 && b == 1; });
  const Sketch p = propose_edges(s, world_of({0, 1, 1}, 0.6));
  ASSERT_EQ(p.size(), 1);
  EXPECT_TRUE(is_edge_of_box(p, 0));
  EXPECT_EQ(p.evidence[0].confidence, 0.3) << "two faces want it";
}

TEST(Propose, NothingWhereAViewWouldHaveSeenIt) {
  const EdgeWorld everywhere = world_of({0, 0, 1}, -2);
  EXPECT_EQ(propose_edges(box([](int a, int b) { return a == 0 && b == 1; }), everywhere).size(),
            0);
  EXPECT_EQ(propose_edges(box([](int a, int b) { return a == 0 || b == 0; }), everywhere).size(),
            0);
}

TEST(Propose, NothingWhereNothingIsMissing) {
  EXPECT_EQ(propose_edges(box([](int, int) { return false; }), world_of({1, 1, 1}, 0.75)).size(),
            0);
}

TEST(Propose, NothingWithoutMasks) {
  const Sketch s = box([](int a, int b) { return a == 0 || b == 0; });
  EXPECT_EQ(propose_edges(s, world_of({1, 1, 1}, 0.75, false)).size(), 0);
  EXPECT_EQ(propose_edges(Sketch(), world_of({1, 1, 1}, 0.75)).size(), 0);
}

// Three sides of a trapezium imply nothing that can be told.
TEST(Propose, NothingOfFacesThatAreNoParallelograms) {
  Sketch s = box([](int a, int b) { return a == 0 && b == 1; });
  for (int n = 0; n < s.nodes.cols(); ++n)
    if (s.nodes.col(n) == corner(0)) s.nodes.col(n) += Vector3d(0.2, 0, 0);
  EXPECT_EQ(propose_edges(s, world_of({0, 1, 1}, 0.6)).size(), 0);
}

}  // namespace
}  // namespace sketchsplat

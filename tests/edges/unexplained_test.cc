// SPDX-License-Identifier: MIT
#include "edges/views/unexplained.h"

#include <gtest/gtest.h>

#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kPixel = 3.0 / 500;

CurvePoints samples_of(const Vector3d& a, const Vector3d& b) {
  return line_samples(a, b, int((b - a).norm() / kPixel) + 1);
}

TEST(AppendRuns, KeepsMarkedRunsWithinChainsThatAreLongEnough) {
  EdgelMap from, to;
  from.edgels.resize(9);
  for (int i = 0; i < 9; ++i) from.edgels[i].x = float(i);
  from.chain = {0, 5, 9};
  // Two of the first chain, one alone, then a run that the end of the chain cuts in two.
  const std::vector<int> kept = append_runs(from, {1, 1, 0, 1, 1, 1, 1, 0, 1}, 2, &to);
  EXPECT_EQ(kept, (std::vector<int>{0, 1, 3, 4, 5, 6}));
  EXPECT_EQ(to.chain, (std::vector<int>{0, 2, 4, 6}));
  EXPECT_EQ(to.edgels[4].x, 5);
  EXPECT_TRUE(append_runs(from, std::vector<char>(9, 0), 0, &to).empty());
  EXPECT_EQ(to.num_chains(), 3);
}

TEST(Unexplained, LeavesTheEdgeThatNoCurveRunsAlong) {
  const Vector3d a(0.2, 0.3, 0.2), b(0.8, 0.3, 0.3), c(0.3, 0.7, 0.8), d(0.7, 0.6, 0.7);
  const EdgeWorld w = ideal_world(ring_of_views(12, kMiddle, 3), {segment(a, b), segment(c, d)});
  EdgelFlags explained = no_edgels(w);
  explain(w, samples_of(a, b), {}, &explained);
  const EdgeWorld rest = unexplained(w, explained, 8);
  ASSERT_EQ(rest.maps.size(), w.maps.size());
  EXPECT_EQ(rest.footprint, w.footprint);
  for (size_t v = 0; v < rest.maps.size(); ++v) {
    const EdgelMap& map = rest.maps[v];
    ASSERT_GT(map.edgels.size(), 20u);
    ASSERT_EQ(rest.plane_normal[v].cols(), Eigen::Index(map.edgels.size()));
    double depth;
    const Eigen::Vector2d p = w.views[v].project(c, &depth), q = w.views[v].project(d, &depth);
    const Eigen::Vector2d along = (q - p).normalized();
    for (size_t k = 0; k < map.edgels.size(); ++k) {
      const Eigen::Vector2d x = Eigen::Vector2d(map.edgels[k].x, map.edgels[k].y) - p;
      EXPECT_LT(std::abs(x.x() * along.y() - x.y() * along.x()), 0.1);
      const Vector3d n = rest.plane_normal[v].col(k).cast<double>();
      EXPECT_LT(std::abs(n.dot(c - w.views[v].center_in_world())), 0.01) << "is this edgel's";
      EXPECT_GE(map.nearest_at(map.edgels[k].x, map.edgels[k].y), 0);
    }
  }
}

TEST(Unexplained, AnEdgeThatACurveCrossesStaysButForShortRests) {
  const Vector3d a(0.2, 0.5, 0.5), b(0.8, 0.5, 0.5);
  const EdgeWorld w = ideal_world(ring_of_views(12, kMiddle, 3), {segment(a, b)});
  EdgelFlags explained = no_edgels(w);
  explain(w, samples_of({0.5, 0.5, 0.2}, {0.5, 0.5, 0.8}), {}, &explained);
  for (size_t v = 0; v < w.maps.size(); ++v) {
    double depth;
    const Eigen::Vector2d along =
        (w.views[v].project(b, &depth) - w.views[v].project(a, &depth)).normalized();
    const Eigen::Vector2d across =
        (w.views[v].project({0.5, 0.5, 0.8}, &depth) - w.views[v].project({0.5, 0.5, 0.2}, &depth))
            .normalized();
    if (std::abs(along.dot(across)) > 0.7) continue;
    for (char flag : explained[v]) EXPECT_FALSE(flag);
  }
  const EdgeWorld none = unexplained(w, explained, 100000);
  for (const EdgelMap& map : none.maps) EXPECT_TRUE(map.edgels.empty());
}

}  // namespace
}  // namespace sketchsplat

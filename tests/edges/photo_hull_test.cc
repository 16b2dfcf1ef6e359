// SPDX-License-Identifier: MIT
#include "edges/photo_hull.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/strokes.h"
#include "tests/support/wireframe.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
const Eigen::AlignedBox3d kBox(Vector3d(0.15, 0.15, 0.15), Vector3d(0.85, 0.85, 0.85));

// A solid cube from 0.2 to 0.8; `grey` by the number of the view.
template <typename Grey>
std::vector<TrainingView> cube_views(const Grey& grey) {
  std::vector<TrainingView> views;
  for (const View& view : ring_of_views(30, kMiddle, 3)) {
    TrainingView t;
    t.view = smaller(view, 100);
    const Image<uint8_t> mask = convex_mask(t.view, cube_corners({0.2, 0.2, 0.2}, 0.6));
    t.alpha = Image<float>(mask.width, mask.height);
    std::copy(mask.data.begin(), mask.data.end(), t.alpha.data.begin());
    for (Image<float>& c : t.color) {
      c = t.alpha;
      for (float& v : c.data) v *= float(grey(int(views.size())));
    }
    views.push_back(t);
  }
  return views;
}

PhotoHullOptions small_options() {
  PhotoHullOptions options;
  options.cells = 32;
  return options;
}

// Samples above z in the middle of the cube's upper face.
int in_the_mouth(const SurfaceSamples& s, double z) {
  int n = 0;
  for (int i = 0; i < s.position.cols(); ++i)
    n += (s.position.col(i) - kMiddle).head<2>().norm() < 0.08 && s.position(2, i) > z;
  return n;
}

TEST(PhotoHull, LinesOfSightOpenAPitThatNoMaskShows) {
  const std::vector<TrainingView> views = cube_views([](int) { return 0.5; });
  const PhotoHullOptions options = small_options();
  std::vector<SightLine> lines;
  for (int k = 0; k < 4000; ++k) {
    const double r = 0.15 * std::sqrt(k / 4000.0), a = 2.4 * k;
    const Vector3d floor(0.5 + r * std::cos(a), 0.5 + r * std::sin(a), 0.4);
    lines.push_back({Vector3d(floor.x(), floor.y(), 3.5), floor});
  }
  const SurfaceSamples closed = photo_hull_surface(views, kBox, 1000, options);
  const SurfaceSamples open = photo_hull_surface(views, kBox, 1000, options, lines);
  EXPECT_GT(in_the_mouth(closed, 0.6), 3);
  EXPECT_EQ(in_the_mouth(open, 0.6), 0);
  EXPECT_GT(in_the_mouth(open, 0.3), 2) << "the floor";
}

TEST(PhotoHull, AFewWrongLinesOfSightDrillNoHole) {
  const std::vector<TrainingView> views = cube_views([](int) { return 0.5; });
  std::vector<SightLine> lines;
  for (int k = 0; k < 12; ++k)
    lines.push_back({Vector3d(0.5 + 0.01 * k, 0.5, 3.5), Vector3d(0.5 + 0.01 * k, 0.5, 0.3)});
  const SurfaceSamples s = photo_hull_surface(views, kBox, 1000, small_options(), lines);
  EXPECT_GT(in_the_mouth(s, 0.6), 3);
}

// No two views agree on what shines.
TEST(PhotoHull, KeepsTheVisualHullWhereCarvingWouldLayMasksBare) {
  const auto shiny = [](int view) { return 0.1 + 0.8 * std::fmod(0.618 * view, 1.0); };
  const SurfaceSamples s = photo_hull_surface(cube_views(shiny), kBox, 1000, small_options());
  EXPECT_EQ(s.carved, 0);
  EXPECT_GT(s.position.cols(), 400);
}

TEST(SightLines, ComeFromCamerasBesideTheOneThatFoundThePoint) {
  const EdgeWorld world =
      ideal_world(ring_of_views(20, kMiddle, 3), cube_edges({0.1, 0.1, 0.1}, 0.8));
  LiftOptions lift;
  lift.stride_px = 20;
  const std::vector<EdgePoint> points = lift_edges(world, lift);
  ASSERT_GT(points.size(), 10u);
  SightOptions narrow, wide;
  narrow.beside_deg = 25, wide.beside_deg = 180;
  const std::vector<SightLine> few = sight_lines(world, points, narrow);
  EXPECT_GE(few.size(), points.size() / 2);  // of the own camera at least, but where edges cross
  EXPECT_LT(few.size(), sight_lines(world, points, wide).size() / 2);
  for (const EdgePoint& p : points)
    for (const SightLine& line : few) {
      if (line.point != p.position) continue;
      const Vector3d own = world.views[p.view].center_in_world() - p.position;
      const Vector3d eye = line.eye - p.position;
      EXPECT_GE(own.normalized().dot(eye.normalized()), std::cos(25.001 * M_PI / 180));
    }
}

}  // namespace
}  // namespace sketchsplat

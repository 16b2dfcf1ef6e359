// SPDX-License-Identifier: MIT
#include "edges/surfels/start/photo_hull.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/edges/sure_edges_of.h"
#include "tests/support/strokes.h"

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

// Of a pit that no mask shows, seen from above.
SureEdges pit() {
  std::vector<Vector3d> eyes;
  for (int k = 0; k < 10; ++k) eyes.push_back({0.5 + 0.05 * k, 0.7 - 0.04 * k, 3.5});
  return sure_edges_of(box_edges({0.35, 0.35, 0.4}, {0.65, 0.65, 0.8}), 0.01, eyes);
}

TEST(PhotoHull, LinesOfSightOpenAPitThatNoMaskShows) {
  const std::vector<TrainingView> views = cube_views([](int) { return 0.5; });
  const PhotoHullOptions options = small_options();
  const SurfaceSamples closed = photo_hull_surface(views, kBox, 1000, options);
  const SurfaceSamples open = photo_hull_surface(views, kBox, 1000, options, pit());
  EXPECT_GT(in_the_mouth(closed, 0.6), 3);
  EXPECT_EQ(in_the_mouth(open, 0.41), 0);
  EXPECT_GT(in_the_mouth(open, 0.39), 2) << "the floor, exactly";
  EXPECT_EQ(open.planes, 6);
  EXPECT_EQ(closed.emptied, 0);
}

TEST(PhotoHull, LinesOfSightAreNotLookedAtWhereTheirShareIsZero) {
  const std::vector<TrainingView> views = cube_views([](int) { return 0.5; });
  PhotoHullOptions options = small_options();
  options.sights = 0;
  EXPECT_GT(in_the_mouth(photo_hull_surface(views, kBox, 1000, options, pit()), 0.6), 3);
}

TEST(PhotoHull, LinesOfSightThatWouldLayMasksBareCountForNothing) {
  const std::vector<TrainingView> views = cube_views([](int) { return 0.5; });
  SureEdges all = pit();  // as if one saw through the cube, everywhere between two planes of it
  for (double x = 0.36; x < 0.65; x += 0.005)
    for (double y = 0.2; y < 0.8; y += 0.01) {
      all.lines.push_back({Vector3d(x, y, 3.5), Vector3d(x, y, 0.1)});
      all.lines.push_back({Vector3d(x, 3.5, y), Vector3d(x, 0.1, y)});
    }
  const SurfaceSamples s = photo_hull_surface(views, kBox, 1000, small_options(), all);
  EXPECT_GT(in_the_mouth(s, 0.6), 3);
  EXPECT_EQ(s.emptied, 0);
}

TEST(PhotoHull, AnotherSeedDrawsOtherPointsOfTheSameSurface) {
  const std::vector<TrainingView> views = cube_views([](int) { return 0.5; });
  PhotoHullOptions options = small_options();
  const SurfaceSamples first = photo_hull_surface(views, kBox, 1000, options);
  EXPECT_EQ(photo_hull_surface(views, kBox, 1000, options).position, first.position);
  options.seed = 1;
  const SurfaceSamples other = photo_hull_surface(views, kBox, 1000, options);
  EXPECT_NE(other.position.col(0), first.position.col(0));
  EXPECT_NEAR(double(other.position.cols()), double(first.position.cols()), 100);
}

// No two views agree on what shines.
TEST(PhotoHull, KeepsTheVisualHullWhereCarvingWouldLayMasksBare) {
  const auto shiny = [](int view) { return 0.1 + 0.8 * std::fmod(0.618 * view, 1.0); };
  const SurfaceSamples s = photo_hull_surface(cube_views(shiny), kBox, 1000, small_options());
  EXPECT_EQ(s.carved, 0);
  EXPECT_GT(s.position.cols(), 400);
}

}  // namespace
}  // namespace sketchsplat

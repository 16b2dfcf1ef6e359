// SPDX-License-Identifier: MIT
#include "pipelines/survey/contour_lines.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);
constexpr double kRadius = 0.3, kLow = 0.2, kHigh = 0.8;

Vector3d on_side(double angle, double z) {
  return {0.5 + kRadius * std::cos(angle), 0.5 + kRadius * std::sin(angle), z};
}
Polyline side(double angle) { return {on_side(angle, kLow), on_side(angle, kHigh)}; }
Polyline rim(double z) {
  return circle({0.5, 0.5, z}, kRadius * Vector3d::UnitX(), kRadius * Vector3d::UnitY());
}

// Where a view sees the contour of the cylinder, on either side; NaN from above.
std::array<double, 2> contours_of(const View& view) {
  const Vector3d c = view.center_in_world() - kMiddle;
  const double at = std::atan2(c.y(), c.x()), off = std::acos(kRadius / std::hypot(c.x(), c.y()));
  return {at - off, at + off};
}

Image<uint8_t> mask_of(const View& view) {
  Image<uint8_t> mask(400, 400, 0);
  const Vector3d c = view.center_in_world();
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const Vector3d d =
          view.cam_from_world.rotation.transpose() * view.camera.ray(Eigen::Vector2d(x, y));
      const Vector3d to = kMiddle - c;
      const double t = (d.x() * to.x() + d.y() * to.y()) / (d.x() * d.x() + d.y() * d.y());
      const Vector3d p = c + t * d;
      if (std::hypot(p.x() - 0.5, p.y() - 0.5) < kRadius && p.z() > kLow && p.z() < kHigh)
        mask.at(x, y) = 255;
    }
  return mask;
}

// Views around a cylinder with its rims and contours, and with a mark on its side, if asked, that
// every so many views show of those which face it.
EdgeWorld cylinder(double mark, int every = 1) {
  const std::vector<View> views = ring_of_views(40, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (const View& v : views) {
    std::vector<Polyline> curves = {rim(kLow), rim(kHigh)};
    for (const double a : contours_of(v))
      if (!std::isnan(a)) curves.push_back(side(a));
    const Vector3d outwards(std::cos(mark), std::sin(mark), 0);
    if (!std::isnan(mark) && maps.size() % every == 0 &&
        outwards.dot(v.center_in_world() - on_side(mark, 0.5)) > 0)
      curves.push_back(side(mark));
    maps.push_back(ideal_edgels(v, curves));
    maps.back().mask = mask_of(v);
  }
  return make_edge_world(views, maps);
}

double nats_at(const EdgeWorld& world, const Polyline& line) {
  Sketch s;
  add_circle(&s, {0.5, 0.5, kLow}, {0, 0, kRadius});
  add_circle(&s, {0.5, 0.5, kHigh}, {0, 0, kRadius});
  add_line(&s, line[0], line[1]);
  MatchOptions match;
  match.exclusive = false;
  match.quadratics = false;
  match.reach_px = 1;
  return contour_nats(2, s, {true, true, true}, observe(s, world, match, 2), world);
}

TEST(ContourLines, TheSideOfACylinderThatOnlyGrazingViewsShowIsItsContour) {
  const EdgeWorld world = cylinder(NAN);
  const double at = contours_of(world.views[world.views.size() / 2])[0];
  EXPECT_GT(nats_at(world, side(at)), 3);
  const Vector3d end = on_side(at, 0.65), begin = on_side(at, 0.35);
  EXPECT_GT(nats_at(world, {begin, end}), 3) << "nor need it reach the rims";
}

TEST(ContourLines, AnEdgeOnItThatAllViewsShowWhichFaceItIsNone) {
  EXPECT_LT(nats_at(cylinder(1.0), side(1.0)), -5);
}

TEST(ContourLines, AFaintEdgeThatAThirdOfThemShowIsNoneThoughGrazingViewsShowSomethingThere) {
  EXPECT_LT(nats_at(cylinder(1.0, 3), side(1.0)), -1);
}

TEST(ContourLines, ALineThatTouchesNoCurveIsNoContour) {
  const EdgeWorld world = cylinder(NAN);
  EXPECT_EQ(nats_at(world, {{0.5, 0.5, kLow}, {0.5, 0.5, kHigh}}), -INFINITY);
}

}  // namespace
}  // namespace sketchsplat

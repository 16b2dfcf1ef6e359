// SPDX-License-Identifier: MIT
// Solids with faces that an ellipse or a cubic sweeps.
#include <algorithm>
#include <cmath>

#include "gmock/gmock.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "tests/topology/found_solid.h"
#include "tests/topology/solids.h"
#include "topology/solid/match_rims.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// A block 3 x 1 x 1 under a wave, which is one cubic at the front, and two at the back.
Sketch wave_edges(double noise = 0) {
  SolidMaker m;
  const Vector3d across(0, 1, 0), off(0, 0, noise);
  const ControlPoints wave{{Vector3d(0, 0, 1), {1, 0, 2}, {2, 0, 0.2}, {3, 0, 1}}, 4};
  int corner[2][4];
  for (const int back : {0, 1})
    for (int k = 0; k < 4; ++k)
      corner[back][k] = m.node(Vector3d(k % 3 == 0 ? 0 : 3, back, k < 2 ? 0 : 1));
  for (const int back : {0, 1})
    for (int k = 0; k < 4; ++k)
      if (k != 2) m.line(corner[back][k], corner[back][(k + 1) % 4]);
  for (int k = 0; k < 4; ++k) m.line(corner[0][k], corner[1][k]);
  m.add(StrokeKind::kBezier, corner[0][3], corner[0][2], {wave.p[1], wave.p[2]});
  const ControlPoints first = subcurve(StrokeKind::kBezier, wave, 0, 0.4),
                      second = subcurve(StrokeKind::kBezier, wave, 0.4, 1);
  const int middle = m.node(first.p[3] + across + off);
  m.add(StrokeKind::kBezier, middle, corner[1][3],
        {first.p[2] + across + off, first.p[1] + across});
  m.add(StrokeKind::kBezier, middle, corner[1][2],
        {second.p[1] + across - off, second.p[2] + across});
  return m.solid.edges;
}

// Area under the wave: the mean of the heights of its control points, for their even steps in x.
constexpr double kWaveVolume = 3 * (1 + 2 + 0.2 + 1) / 4.0;

// A plate of thickness 0.5 whose outline is an ellipse, with an elliptic hole.
Sketch ellipse_edges() {
  SolidMaker m;
  for (const double z : {0.0, 0.5}) {
    m.add(StrokeKind::kEllipse, -1, -1, {{0, 0, z}, {2, 0, 0}, {0, 1, 0}});
    m.add(StrokeKind::kEllipse, -1, -1, {{0.3, 0, z}, {0.4, 0.4, 0}, {-0.2, 0.2, 0}});
  }
  return m.solid.edges;
}

// A box 2 x 2 x 1 that goes on smoothly as half an ellipse; no image shows where it does, and the
// lower lines go on further, by so much of a turn of the ellipse [rad].
Sketch half_ellipse_edges(double further = 0) {
  SolidMaker m;
  int n[2][4];
  for (const int top : {0, 1}) {
    const double half = M_PI / 2 - (top ? 0 : further);
    const ControlPoints arc =
        elliptic_arc(Vector3d(2, 0, top), {1.5, 0, 0}, {0, 1, 0}, -half, half);
    n[top][0] = m.node({0, -1, double(top)}), n[top][1] = m.node(arc.p[0]);
    n[top][2] = m.node(arc.p[3]), n[top][3] = m.node({0, 1, double(top)});
    m.line(n[top][0], n[top][1]);
    m.line(n[top][2], n[top][3]);
    m.line(n[top][3], n[top][0]);
    m.add(StrokeKind::kEllipticArc, n[top][1], n[top][2], {arc.p[1], arc.p[2]});
  }
  m.line(n[0][0], n[1][0]);
  m.line(n[0][3], n[1][3]);
  return m.solid.edges;
}

// Volume of the solid that the strokes bound, with so many extruded surfaces.
double extruded_volume(const Sketch& sketch, int extrusions) {
  SolidOptions options;
  options.margin = 1;
  const SolidSearch search = find_solid(sketch, options);
  if (search.solid) {
    const std::vector<Surface>& all = search.solid->surfaces;
    EXPECT_LT(search.solid->gap, 1e-6);
    EXPECT_EQ(std::count_if(all.begin(), all.end(),
                            [](const Surface& s) { return s.kind == SurfaceKind::kExtrusion; }),
              extrusions);
  }
  return check_of(search).volume;
}

TEST(MatchRims, OneRimBecomesACopyOfTheOther) {
  const Sketch sketch = wave_edges(1e-3);
  const MatchedRims matched = match_rims(sketch, 3e-3);
  EXPECT_EQ(matched.sketch.size(), sketch.size() - 1);
  ASSERT_EQ(matched.surfaces.size(), 1u);
  EXPECT_THAT(matched.rulings, testing::IsEmpty()) << "lines join the ends";
  EXPECT_EQ(matched.now[11], matched.now[12]) << "both pieces are one now";
  const ControlPoints front = control_points(matched.sketch, matched.now[10][0]),
                      back = control_points(matched.sketch, matched.now[11][0]);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR((back.p[k] - front.p[k] - Vector3d(0, 1, 0)).norm(), 0, 1e-9);
}

TEST(MatchRims, WhatDiffersStays) {
  const Sketch sketch = wave_edges(0.05);
  EXPECT_THAT(match_rims(sketch, 3e-3).surfaces, testing::IsEmpty());
}

TEST(FindSolid, OutlinesOfCubicsAndEllipsesAreExtruded) {
  EXPECT_NEAR(extruded_volume(wave_edges(), 1), kWaveVolume, 5e-5);
  EXPECT_NEAR(extruded_volume(wave_edges(5e-4), 1), kWaveVolume, 2e-3);
  EXPECT_NEAR(extruded_volume(ellipse_edges(), 2), 0.5 * M_PI * (2 - 0.4 * 0.2 * 2), 5e-5);
}

TEST(FindSolid, HalfAnEllipseEndsInRulingsThatNoImageShows) {
  EXPECT_NEAR(extruded_volume(half_ellipse_edges(), 1), 4 + M_PI / 2 * 1.5, 5e-5);
  EXPECT_NEAR(extruded_volume(half_ellipse_edges(0.04), 1), 4 + M_PI / 2 * 1.5, 2e-3);
}

TEST(Surface, AnExtrusionIsLaidOutAlongItsProfile) {
  const Surface s{SurfaceKind::kExtrusion,
                  Vector3d::Zero(),
                  Vector3d::UnitZ(),
                  0,
                  0,
                  0,
                  StrokeKind::kBezier,
                  {{0, 0, 0}, {1, 1, 0}, {2, -0.8, 0}, {3, 0, 0}}};
  const Layout layout(s);
  for (const double u : {0.3, 1.2, 2.8}) {
    const Eigen::Vector2d flat(u, -0.7);
    EXPECT_NEAR((layout.flat(layout.point(flat)) - flat).norm(), 0, 1e-4);
    EXPECT_NEAR(surface_distance(s, layout.point(flat)), 0, 1e-4);
  }
  const Vector3d from(1, 5, 0), to(2, -5, 0.5);
  const Crossings at = crossings(layout, from, to);
  ASSERT_EQ(at.count, 1);
  EXPECT_NEAR(surface_distance(s, from + at.t[0] * (to - from)), 0, 1e-4);
  EXPECT_LT(surface_distance(s, from) * surface_distance(s, to), 0);
}

}  // namespace
}  // namespace sketchsplat

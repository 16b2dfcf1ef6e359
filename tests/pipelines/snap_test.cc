// SPDX-License-Identifier: MIT
#include "pipelines/adjust/snap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pipelines/adjust/polish.h"
#include "sketches/curve/conic.h"
#include "tests/support/noisy_world.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

constexpr int kSide = 1200;        // [px]
constexpr double kPerWorld = 100;  // [mm]: the box is 80 x 60 x 40 mm

// Two holes through the box, rims and all.
Sketch block(double radius, double other) {
  Sketch s = box();
  const Vector3d x = (s.nodes.col(1) - s.nodes.col(0)).normalized(),
                 z = (s.nodes.col(4) - s.nodes.col(0)).normalized();
  for (const double side : {-0.2, 0.2})
    for (const double level : {-0.2, 0.2})
      add_circle(&s, kMiddle + side * x + level * z, (side < 0 ? radius : other) * z);
  return s;
}

Snapped snapped(const Sketch& truth, unsigned seed, SnapScale scale = {kPerWorld, 0},
                StandardSystem system = StandardSystem::kIso) {
  const EdgeWorld world = noisy_world(truth, 8, seed, 1, kSide);
  Observation last;
  const Sketch free = polish(truth, world, {}, &last);
  const StrokeObservation seen = with_strokes(last, world, 1);
  const Regularized regular = regularize(free, seen, world.footprint, {});
  return snap_to_standards(regular, seen, world.footprint, scale, system, {});
}

std::vector<double> standards(const Snapped& s, LengthKind kind) {
  std::vector<double> out;
  for (const Snap& snap : s.snaps)
    if (snap.kind == kind) out.push_back(snap.standard);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Snap, StandardLengthsBecomeExactAndOthersStay) {
  const Sketch truth = block(0.10, 0.12134);
  const Snapped s = snapped(truth, 1);
  EXPECT_EQ(standards(s, LengthKind::kDiameter), std::vector<double>({20}));
  EXPECT_EQ(standards(s, LengthKind::kPlaneDistance), (std::vector<double>{40, 60, 80}));
  for (const int circle : {12, 13})
    EXPECT_NEAR(circle_parameters(s.sketch, circle).radius, 0.10, 1e-7);
  for (const int circle : {14, 15}) {
    const double radius = circle_parameters(s.sketch, circle).radius;
    EXPECT_NEAR(radius, 0.12134, 1e-3);
    EXPECT_GT(std::abs(radius - 0.12), 1e-4);
  }
  EXPECT_NEAR((s.sketch.nodes.col(1) - s.sketch.nodes.col(0)).norm(), 0.8, 1e-4);
  for (const Snap& snap : s.snaps) {
    EXPECT_GT(snap.nats, 0);
    EXPECT_LE(std::abs(snap.standard - snap.measured), 2 * snap.sigma);
    EXPECT_LE(snap.chi2, snap.chi2_most);
    EXPECT_LE(snap.moved_px, snap.noise_px);
    EXPECT_FALSE(snap.series.empty());
  }
}

TEST(Snap, ARadiusThatIsFarFromStandardOnesForItsSigmaStays) {
  double sigma = 0;
  for (const Snap& snap : snapped(block(0.10, 0.12134), 1).snaps)
    if (snap.kind == LengthKind::kDiameter) sigma = snap.sigma;
  ASSERT_GT(sigma, 0);
  const double off = 4 * sigma / 2 / kPerWorld;
  for (const double radius : {0.10 + off, 0.10 - off})
    EXPECT_TRUE(standards(snapped(block(radius, 0.12134), 1), LengthKind::kDiameter).empty());
}

TEST(Snap, NothingIsSnappedWhereTheScaleIsVague) {
  const Snapped s = snapped(block(0.10, 0.12134), 2, {kPerWorld, 0.05});
  EXPECT_TRUE(s.snaps.empty());
  EXPECT_GT(s.hypotheses, 4);
}

TEST(Snap, LengthsTogetherTellAScaleThatIsOff) {
  const double off = 1.0005;
  const Snapped s = snapped(block(0.10, 0.12134), 1, {kPerWorld * off, 5e-4});
  EXPECT_EQ(standards(s, LengthKind::kPlaneDistance), (std::vector<double>{40, 60, 80}));
  EXPECT_NEAR(s.scale, 1 / off, 1.5e-4);
  EXPECT_LT(s.scale_sigma, 2e-4);
  for (const Snap& snap : s.snaps) EXPECT_LE(snap.chi2, snap.chi2_most);
}

TEST(Snap, TheOrderOfStrokesDoesNotMatter) {
  const Sketch truth = block(0.10, 0.12134);
  Sketch other;
  other.nodes = truth.nodes;
  for (int i = truth.size() - 1; i >= 0; --i) {
    const Stroke& s = truth.strokes[i];
    std::vector<Vector3d> handles;
    for (int h = 0; h < num_handles(s.kind); ++h)
      handles.push_back(truth.handles.col(s.handle + h));
    other.add_stroke(s.kind, s.begin, s.end, handles);
  }
  // Of the same edgels, that is.
  const EdgeWorld world = noisy_world(truth, 8, 1, 1, kSide);
  const auto run = [&](const Sketch& sketch) {
    Observation last;
    const Sketch free = polish(sketch, world, {}, &last);
    const StrokeObservation seen = with_strokes(last, world, 1);
    return snap_to_standards(regularize(free, seen, world.footprint, {}), seen, world.footprint,
                             {kPerWorld, 0}, StandardSystem::kIso, {});
  };
  const Snapped a = run(truth), b = run(other);
  for (const LengthKind kind : {LengthKind::kDiameter, LengthKind::kPlaneDistance})
    EXPECT_EQ(standards(a, kind), standards(b, kind));
  EXPECT_EQ(a.hypotheses, b.hypotheses);
}

TEST(Snap, WithoutASystemNothingIsTouched) {
  const Sketch truth = block(0.10, 0.12134);
  const Snapped s = snapped(truth, 1, {kPerWorld, 0}, StandardSystem::kNone);
  EXPECT_TRUE(s.snaps.empty());
  EXPECT_EQ(s.hypotheses, 0);
}

}  // namespace
}  // namespace sketchsplat

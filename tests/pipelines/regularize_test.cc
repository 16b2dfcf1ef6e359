// SPDX-License-Identifier: MIT
#include "pipelines/adjust/regularize.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "pipelines/adjust/polish.h"
#include "pipelines/adjust/regularity_finder.h"
#include "sketches/curve/conic.h"
#include "sketches/graph/smooth_joint.h"
#include "tests/support/noisy_world.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
struct Pair {
  Sketch free;
  Regularized bound;
};
Pair both(const Sketch& truth, const EdgeWorld& world) {
  Pair p;
  Observation last;
  p.free = polish(truth, world, {}, &last);
  p.bound = regularize(p.free, with_strokes(last, world, 1), world.footprint, {});
  return p;
}

double angle_deg(const Sketch& s, int a, int b) {
  const double sine = stroke_direction(s, a).cross(stroke_direction(s, b)).norm();
  return std::asin(std::min(1.0, sine)) * 180 / M_PI;
}
double error_of(const Sketch& s, const Sketch& truth) {
  return std::sqrt((s.nodes - truth.nodes).colwise().squaredNorm().mean());
}
int count_of(const Regularized& r, RelationKind kind, size_t strokes) {
  int n = 0;
  for (const Regularity& k : r.kept) n += k.kind == kind && k.strokes.size() == strokes;
  return n;
}
bool together(const Regularized& r, RelationKind kind, int a, int b) {
  for (const Regularity& k : r.kept)
    if (k.kind == kind && std::count(k.strokes.begin(), k.strokes.end(), a) &&
        std::count(k.strokes.begin(), k.strokes.end(), b))
      return true;
  return false;
}

// Eigen would cut products of this size by threads, and with them the order of their sums.
TEST(Regularize, SumsDoNotFollowTheNumberOfThreads) {
  Sketch boxes;
  for (int k = 0; k < 6; ++k) {
    Sketch one = box();
    one.nodes = (0.15 * one.nodes).colwise() + 0.15 * Vector3d(k % 3 * 2, k / 3 * 2, k);
    append_strokes(one, &boxes);
  }
  const EdgeWorld world = noisy_world(boxes, 8, 3);
  const int before = omp_get_max_threads();
  std::vector<Eigen::Matrix3Xd> found;
  for (const int threads : {1, 3}) {
    omp_set_num_threads(threads);
    found.push_back(both(boxes, world).bound.sketch.nodes);
    EXPECT_EQ(Eigen::nbThreads(), 1);
  }
  omp_set_num_threads(before);
  EXPECT_EQ(found[0], found[1]);
}

TEST(Regularize, EdgesOfANoisyBoxBecomeParallelAndComeNearerToTheTruth) {
  const Sketch truth = box();
  double free = 0, bound = 0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const EdgeWorld world = noisy_world(truth, 8, seed);
    const Pair p = both(truth, world);
    double before = 0, after = 0;
    for (int i = 0; i < 12; ++i)
      for (int j = i + 1; j < 4 * (i / 4 + 1); ++j) {
        before = std::max(before, angle_deg(p.free, i, j));
        after = std::max(after, angle_deg(p.bound.sketch, i, j));
      }
    EXPECT_GT(before, 0.03) << seed;
    EXPECT_LT(after, 0.01) << seed;
    EXPECT_EQ(count_of(p.bound, RelationKind::kParallel, 4), 3) << seed;
    EXPECT_EQ(count_of(p.bound, RelationKind::kPerpendicular, 8), 3) << seed;
    EXPECT_EQ(count_of(p.bound, RelationKind::kCoplanar, 4), 6) << seed;
    free += error_of(p.free, truth), bound += error_of(p.bound.sketch, truth);
  }
  EXPECT_LT(bound, 0.8 * free);
}

TEST(Regularize, ARampOfHalfADegreeThatTheViewsTellIsKept) {
  for (double ramp : {0.5, 1.0}) {
    const Sketch truth = box(ramp);
    const Pair p = both(truth, noisy_world(truth, 8, 7));
    // Strokes 0, 1 run along the lower face, 2, 3 up the ramp.
    for (int lower : {0, 1})
      for (int upper : {2, 3}) {
        EXPECT_NEAR(angle_deg(p.bound.sketch, lower, upper), ramp, 0.1);
        EXPECT_FALSE(together(p.bound, RelationKind::kParallel, lower, upper));
      }
    EXPECT_LT(angle_deg(p.bound.sketch, 2, 3), 0.01);
    EXPECT_TRUE(together(p.bound, RelationKind::kParallel, 2, 3));
    EXPECT_LE(error_of(p.bound.sketch, truth), error_of(p.free, truth));
  }
}

TEST(Regularize, HolesOfOneDrillShareAxisAndRadiusOthersDoNot) {
  const double px = 3.0 / 500;
  const Vector3d axis = Vector3d(1, 2, 5).normalized(), base(0.35, 0.4, 0.3);
  Vector3d x, y;
  frame_of<double>(axis, &x, &y);
  Sketch truth;
  add_circle(&truth, base, 0.12 * axis);
  add_circle(&truth, base + 0.3 * axis, 0.12 * axis);
  add_circle(&truth, base + 0.4 * x + 1.5 * px * axis, (0.12 + 1.5 * px) * axis);
  add_circle(&truth, base + 0.4 * x + 0.3 * axis + 1.5 * px * y, 0.08 * axis);
  const Pair p = both(truth, noisy_world(truth, 8, 3));
  EXPECT_EQ(count_of(p.bound, RelationKind::kParallel, 4), 1);
  EXPECT_TRUE(together(p.bound, RelationKind::kCoaxial, 0, 1));
  EXPECT_TRUE(together(p.bound, RelationKind::kEqualRadius, 0, 1));
  EXPECT_FALSE(together(p.bound, RelationKind::kEqualRadius, 0, 2));
  EXPECT_FALSE(together(p.bound, RelationKind::kCoaxial, 2, 3));
  EXPECT_FALSE(together(p.bound, RelationKind::kCoplanar, 0, 2));
  const CircleParameters a = circle_parameters(p.bound.sketch, 0),
                         b = circle_parameters(p.bound.sketch, 1);
  EXPECT_LT(std::abs(a.radius - b.radius), 0.002 * px);
  EXPECT_LT((b.centre - a.centre).cross(a.normal).norm(), 0.005 * px);
}

// Holes in pairs on both sides of a plane, at heights and distances of their own; the last pair is
// out of place by `off_px`.
Sketch pairs_of_holes(double off_px) {
  Sketch s;
  const double px = 3.0 / 500;
  const Vector3d axis = Vector3d(1, 2, 5).normalized();
  Vector3d x, y;
  frame_of<double>(axis, &x, &y);
  for (int k = 0; k < 5; ++k) {
    const double side = 0.11 + 0.06 * k + 0.01 * (k == 2), along = -0.3 + 0.14 * k + 0.03 * (k % 2);
    const double off = k == 4 ? off_px * px : 0;
    const Vector3d middle = kMiddle + along * y + (0.05 * k - 0.11 + 0.01 * (k == 3)) * axis;
    add_circle(&s, middle + side * x, (0.035 + 0.011 * k) * axis);
    add_circle(&s, middle - (side + off) * x, (0.035 + 0.011 * k) * axis);
  }
  // What tells the direction of the mirror's normal.
  for (double side : {-0.4, 0.4})
    add_line(&s, kMiddle - 0.4 * x + side * y, kMiddle + 0.4 * x + side * y);
  return s;
}

TEST(Regularize, HolesThatMirrorOneAnotherAreSymmetricOthersAreNot) {
  for (const double off : {0.0, 1.5}) {
    const Sketch truth = pairs_of_holes(off);
    const Pair p = both(truth, noisy_world(truth, 12, 3));
    EXPECT_TRUE(together(p.bound, RelationKind::kSymmetric, 0, 1)) << off;
    EXPECT_TRUE(together(p.bound, RelationKind::kSymmetric, 2, 7)) << off;
    EXPECT_EQ(together(p.bound, RelationKind::kSymmetric, 8, 9), off == 0);
  }
}

TEST(Regularize, CubicsThatGoOnSmoothlyStillDoSo) {
  Sketch truth = box();
  const int n = truth.add_node({0.2, 0.4, 0.9}), m = truth.add_node({0.5, 0.5, 0.9}),
            e = truth.add_node({0.8, 0.4, 0.9});
  truth.add_stroke(StrokeKind::kBezier, n, m, {Vector3d(0.3, 0.3, 0.9), Vector3d(0.4, 0.5, 0.9)});
  truth.add_stroke(StrokeKind::kBezier, m, e, {Vector3d(0.6, 0.5, 0.9), Vector3d(0.7, 0.3, 0.9)});
  Observation last;
  PolishOptions polish_options;
  polish_options.smooth_sigma_deg = 0.02;
  const EdgeWorld world = noisy_world(truth, 8, 5);
  const Sketch free = polish(truth, world, polish_options, &last);
  RegularizeOptions options;
  options.refine.smooth_angle = 0.1;
  options.refine.smooth_weight = std::pow(1 / (0.02 * M_PI / 180), 2);
  const Regularized bound =
      regularize(free, with_strokes(last, world, 1), world.footprint, options);
  EXPECT_GT(bound.kept.size(), 0u);
  const std::vector<SmoothJoint> joints = find_smooth_joints(bound.sketch, 0.2);
  ASSERT_EQ(joints.size(), 1u);
  EXPECT_LT(joints[0].angle, 0.1 * M_PI / 180);
}

// Lines and rings anywhere; radii five pixels apart, as two that agree by chance are equal to all
// who look.
Sketch unrelated(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  const auto place = [&] {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vector3d(x, y, z);
  };
  Sketch s;
  for (int i = 0; i < 10; ++i) {
    const Vector3d a = place();
    add_line(&s, a, a + 0.5 * (place() - kMiddle).normalized());
  }
  for (int i = 0; i < 4; ++i)
    add_circle(&s, place(), (0.05 + 0.03 * i) * (place() - kMiddle).normalized());
  return s;
}

TEST(Regularize, StrokesThatHaveNothingInCommonStayAsTheyAre) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Sketch truth = unrelated(seed);
    const Pair p = both(truth, noisy_world(truth, 8, seed));
    EXPECT_TRUE(p.bound.kept.empty()) << seed;
    EXPECT_EQ(p.bound.sketch.nodes, p.free.nodes);
  }
}

TEST(Regularize, DecidesTheSameInAnyUnitAndAgain) {
  const EdgeWorld world = noisy_world(box(0.5), 6, 5);
  const Pair p = both(box(0.5), world), again = both(box(0.5), world);
  EXPECT_EQ(p.bound.sketch.nodes, again.bound.sketch.nodes);
  for (const double unit : {1e3}) {
    const Sketch truth = scaled(box(0.5), unit);
    const Pair q = both(truth, noisy_world(truth, 6, 5, unit));
    ASSERT_EQ(q.bound.kept.size(), p.bound.kept.size());
    for (size_t i = 0; i < p.bound.kept.size(); ++i) {
      EXPECT_EQ(q.bound.kept[i].kind, p.bound.kept[i].kind);
      EXPECT_EQ(q.bound.kept[i].strokes, p.bound.kept[i].strokes);
    }
    EXPECT_LT((q.bound.sketch.nodes / unit - p.bound.sketch.nodes).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(Regularize, WhatWasTakenFirstStillHoldsAfterWhatWasTakenLast) {
  const EdgeWorld world = noisy_world(box(), 6, 9);
  Observation last;
  const Sketch free = polish(box(), world, {}, &last);
  SampleQuadratics q{last.matches.information, last.matches.slope};
  q.slope.setZero();
  for (Eigen::Matrix3d& information : q.information) information *= 4;  // half a pixel each
  RegularityFinder finder(free, sketch_quadratic(free, last.layout, q), world.footprint, {});
  finder.find(5);
  const Relations kept = finder.kept();
  EXPECT_GT(kept.list.size(), 15u);
  for (const Relation& r : kept.list)
    EXPECT_LT(linearize(finder.weigher().sketch(), kept, r).residual.norm(), 4 * r.sigma)
        << relation_name(r.kind) << " of stroke " << r.stroke;
}

// It ends after so much work, whatever there is to find, and what was half found does not count.
TEST(Regularize, WorkHasABoundBeyondWhichKindsAreLeftOut) {
  const Sketch truth = box();
  const EdgeWorld world = noisy_world(truth, 8, 1);
  Observation last;
  const Sketch free = polish(truth, world, {}, &last);
  RegularizeOptions options;
  options.most_work = 0;
  const Regularized none = regularize(free, with_strokes(last, world, 1), world.footprint, options);
  EXPECT_TRUE(none.kept.empty());
  EXPECT_EQ(none.sketch.nodes, free.nodes);
  size_t fewer = 0;
  for (options.most_work = 1e3; options.most_work < 1e7; options.most_work *= 2) {
    const Regularized some =
        regularize(free, with_strokes(last, world, 1), world.footprint, options);
    EXPECT_GE(some.kept.size(), fewer) << options.most_work;
    fewer = some.kept.size();
  }
  EXPECT_EQ(fewer, regularize(free, with_strokes(last, world, 1), world.footprint, {}).kept.size());
}

TEST(Regularize, NothingStaysNothing) {
  const Regularized r = regularize(Sketch(), StrokeObservation(), 1, {});
  EXPECT_EQ(r.sketch.size(), 0);
  EXPECT_TRUE(r.kept.empty());
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>
#include <random>

#include "sketches/curve/conic.h"
#include "tests/support/sanitizer.h"
#include "tests/topology/build_sketch.h"
#include "topology/core/plain_curve.h"
#include "topology/passes/simplify.h"

namespace sketchsplat {
namespace {

using Pass = std::function<PassResult(const Sketch&, const TopologyOptions&, const StrokePoints&)>;

struct Named {
  const char* name;
  Pass pass;
};
std::vector<Named> all_passes() {
  return {{"merge_endpoints", merge_endpoints},
          {"merge_collinear", merge_collinear},
          {"simplify", [](const Sketch& s, const TopologyOptions& o, const StrokePoints& points) {
             Simplified r = simplify(s, o, points);
             EXPECT_TRUE(r.settled);
             return PassResult{r.sketch, r.remap, r.counts.total(), r.points};
           }}};
}

/// True curves in a box of 120 px, each cut in pieces, doubled, and disturbed by some 0.4 px; every
/// second sketch has stray strokes without meaning on top.
Sketch random_sketch(int seed, int curves) {
  std::mt19937 rng(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * double(rng()) / double(std::mt19937::max());
  };
  const auto point = [&](double size) {
    return Vector3d(uniform(0, size), uniform(0, size), uniform(0, size));
  };
  const auto noise = [&] { return Vector3d(point(0.8).array() - 0.4); };
  const auto evidence = [&] {
    Evidence e;
    e.opacity = uniform(0.2, 1);
    e.support_views = int(uniform(1, 20));
    return e;
  };
  Sketch s;
  Vector3d last = point(120);
  for (int k = 0; k < curves; ++k) {
    const Vector3d next = point(120), h0 = point(120), h1 = point(120);
    const int what = int(uniform(0, 6));
    const double cut = uniform(0.2, 0.8);
    if (what <= 1) {
      const Vector3d at = last + cut * (next - last);
      add_line(&s, last + noise(), at + noise(), evidence());
      add_line(&s, next + noise(), at + noise(), evidence());
      if (what == 1) add_line(&s, last + noise(), last + 0.9 * (next - last), evidence());
      last = next;
    } else if (what == 2) {
      const double split = 360 * cut;
      const Vector3d centre = noise() + point(120);
      add_arc(&s, centre, uniform(1, 40), 0, split, evidence());
      add_arc(&s, centre + noise(), uniform(1, 40), split, 360, evidence());
    } else if (what == 3) {
      const Vector3d centre = point(120);
      const double radius = uniform(5, 40), from = uniform(0, 360);
      add_arc(&s, centre + noise(), radius, from, from + 120 * cut, evidence());
      add_arc(&s, centre + noise(), radius, from + 125 * cut, from + 200, evidence());
      add_arc(&s, centre + noise(), radius, from + 20, from + 60, evidence());
    } else if (what == 4) {
      add_bezier(&s, last + noise(), h0, h1, next + noise(), evidence());
      add_bezier(&s, next + noise(), h1 + noise(), h0 + noise(), last + noise(), evidence());
      last = next;
    } else {
      const Vector3d u = (h0 - last) / 4, v = u.cross(h1).normalized() * u.norm();
      s.add_stroke(StrokeKind::kEllipse, -1, -1, {last, u, v * uniform(0.5, 1.1)}, evidence());
      s.add_stroke(StrokeKind::kCircle, -1, -1, {next, v / 2}, evidence());
      s.add_stroke(StrokeKind::kCircle, -1, -1, {next + noise(), v / 2}, evidence());
      for (const auto& [from, to] : {std::pair(0.0, 5 * cut), std::pair(5 * cut + 0.05, 5.5)}) {
        const ControlPoints c = elliptic_arc(h1, u, 0.6 * v, from, to);
        const int begin = s.add_node(c.p[0] + noise()), end = s.add_node(c.p[3] + noise());
        s.add_stroke(StrokeKind::kEllipticArc, begin, end, {c.p[1] + noise(), c.p[2]}, evidence());
      }
    }
    if (seed % 2) {
      const Vector3d p = point(120);
      add_line(&s, p, p + noise() * 8, evidence());
      add_bezier(&s, p + noise(), p + noise() * 6, p + noise() * 6, p + noise(), evidence());
    }
  }
  return s;
}

/// Largest distance between the samples of a stroke and the best partner of its kind; infinite
/// beyond `reach`, or if the numbers of strokes differ.
double difference(const Sketch& a, const Sketch& b, double reach) {
  if (a.size() != b.size()) return INFINITY;
  const auto mean = [](const PlainCurve& c) {
    const CurveSamples s = sample_curve(c);
    return Vector3d(s.position * s.weight / s.length);
  };
  double worst = 0;
  for (int i = 0; i < a.size(); ++i) {
    double best = INFINITY;
    const PlainCurve ca = plain_curve(a, i);
    const Vector3d middle = mean(ca);
    for (int j = 0; j < b.size(); ++j) {
      if (a.strokes[i].kind != b.strokes[j].kind) continue;
      const PlainCurve cb = plain_curve(b, j);
      if ((mean(cb) - middle).norm() > reach) continue;
      best = std::min(best, std::max(max_distance(ca, sample_curve(cb).position),
                                     max_distance(cb, sample_curve(ca).position)));
    }
    worst = std::max(worst, best);
  }
  return worst;
}

Sketch permuted(const Sketch& s, int seed, std::vector<int>* order) {
  std::mt19937 rng(seed);
  order->resize(s.size());
  std::iota(order->begin(), order->end(), 0);
  for (int i = s.size() - 1; i > 0; --i) std::swap((*order)[i], (*order)[rng() % (i + 1)]);
  Sketch out;
  out.nodes = s.nodes;
  for (int i : *order) {
    const Stroke& stroke = s.strokes[i];
    std::vector<Vector3d> handles;
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      handles.push_back(s.handles.col(stroke.handle + h));
    out.add_stroke(stroke.kind, stroke.begin, stroke.end, handles, s.evidence[i]);
  }
  return out;
}

Sketch moved(const Sketch& s, const Eigen::Matrix3d& rotation, const Vector3d& shift,
             double scale) {
  Sketch out = s;
  const auto point = [&](const Vector3d& p) { return Vector3d(scale * (rotation * p + shift)); };
  for (int n = 0; n < s.nodes.cols(); ++n) out.nodes.col(n) = point(s.nodes.col(n));
  for (const Stroke& stroke : s.strokes)
    for (int h = 0; h < num_handles(stroke.kind); ++h) {
      const bool axis = is_closed(stroke.kind) && h > 0;
      const Vector3d p = s.handles.col(stroke.handle + h);
      out.handles.col(stroke.handle + h) = axis ? Vector3d(scale * (rotation * p)) : point(p);
    }
  return out;
}

constexpr int kSeeds = 20;

TEST(Invariants, EveryPassLeavesASoundSketchAndAConsistentRemap) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Sketch s = random_sketch(seed, 12);
    for (const auto& [name, pass] : all_passes()) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      const PassResult r = pass(s, one_pixel(), {});
      expect_sound(r, s);
      EXPECT_EQ(r.changes == 0, r.remap.is_identity() && difference(s, r.sketch, 1e-3) < 1e-9 &&
                                    s.nodes.cols() == r.sketch.nodes.cols());
    }
  }
}

TEST(Invariants, TheRandomSketchesGiveEveryPassSomethingToDo) {
  std::vector<int> changes(all_passes().size());
  for (int seed = 0; seed < kSeeds; ++seed) {
    int k = 0;
    for (const auto& [name, pass] : all_passes())
      changes[k++] += pass(random_sketch(seed, 12), one_pixel(), {}).changes;
  }
  EXPECT_THAT(changes, testing::Each(testing::Gt(kSeeds)));
}

TEST(Invariants, ASecondCallChangesNothing) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Sketch s = random_sketch(seed, 12);
    for (const auto& [name, pass] : all_passes()) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      const PassResult first = pass(s, one_pixel(), {}),
                       second = pass(first.sketch, one_pixel(), first.points);
      EXPECT_EQ(second.changes, 0);
      EXPECT_TRUE(second.remap.is_identity());
      EXPECT_EQ(second.sketch.nodes, first.sketch.nodes);
      EXPECT_EQ(second.sketch.handles, first.sketch.handles);
    }
  }
}

TEST(Invariants, TheOrderOfTheStrokesDoesNotMatter) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Sketch s = random_sketch(seed, 12);
    std::vector<int> order;
    const Sketch shuffled = permuted(s, seed, &order);
    for (const auto& [name, pass] : all_passes()) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      const PassResult r = pass(s, one_pixel(), {}), q = pass(shuffled, one_pixel(), {});
      EXPECT_EQ(r.changes, q.changes);
      EXPECT_LT(difference(r.sketch, q.sketch, 1e-3), 1e-5);
      // The same strokes were merged with one another.
      for (int i = 0; i < s.size(); ++i)
        for (int j = 0; j < i; ++j)
          EXPECT_EQ(r.remap.stroke[order[i]] == r.remap.stroke[order[j]],
                    q.remap.stroke[i] == q.remap.stroke[j]);
    }
  }
}

TEST(Invariants, RotationTranslationAndScaleDoNotMatter) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.9, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Sketch s = random_sketch(seed, 12);
    const double scale = seed % 2 ? 1e-3 : 1e3;
    for (const auto& [name, pass] : all_passes()) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed << ", scale " << scale);
      TopologyOptions options;
      options.footprint = scale;
      const Vector3d shift(40, -70, 10);
      const PassResult r = pass(s, one_pixel(), {});
      const PassResult q = pass(moved(s, rotation, shift, scale), options, {});
      EXPECT_EQ(r.remap.stroke, q.remap.stroke);
      EXPECT_LT(difference(moved(r.sketch, rotation, shift, scale), q.sketch, 1e-3 * scale),
                1e-5 * scale);
    }
  }
}

TEST(Invariants, LengthGrowsByTheGapsAtMost) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Sketch s = random_sketch(seed, 12);
    for (const auto& [name, pass] : all_passes()) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      const PassResult r = pass(s, one_pixel(), {});
      EXPECT_LE(total_length(r.sketch), total_length(s) + 6 * r.changes);
    }
  }
}

TEST(Invariants, FourHundredStrokesTakeMilliseconds) {
  const Sketch s = random_sketch(3, 90);
  ASSERT_GT(s.size(), 300);
  const auto start = std::chrono::steady_clock::now();
  const Simplified r = simplify(s, one_pixel());
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("milliseconds", std::to_string(ms));
  RecordProperty("strokes", s.size());
  EXPECT_LT(r.sketch.size(), s.size());
  // Generous: the machine may be busy; a cubic algorithm would need seconds.
  EXPECT_LT(ms, test::kSanitized ? 20000 : 2000);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "sketches/curve/curve.h"
#include "sketches/graph/sketch.h"
#include "topology/core/passes.h"

namespace sketchsplat {

using Eigen::Vector3d;

/// One pixel is one world unit: lengths below read as pixels.
inline TopologyOptions one_pixel() {
  TopologyOptions options;
  options.footprint = 1;
  return options;
}

inline Evidence with_opacity(double opacity) {
  Evidence e;
  e.opacity = opacity;
  return e;
}

inline int add_line(Sketch* s, const Vector3d& a, const Vector3d& b, const Evidence& e = {}) {
  const int begin = s->add_node(a), end = s->add_node(b);
  return s->add_stroke(StrokeKind::kLine, begin, end, {}, e);
}

inline int add_bezier(Sketch* s, const Vector3d& a, const Vector3d& h0, const Vector3d& h1,
                      const Vector3d& b, const Evidence& e = {}) {
  const int begin = s->add_node(a), end = s->add_node(b);
  return s->add_stroke(StrokeKind::kBezier, begin, end, {h0, h1}, e);
}

/// Arc in the plane z = centre.z from one angle to another, degrees.
inline int add_arc(Sketch* s, const Vector3d& centre, double radius, double from_deg, double to_deg,
                   const Evidence& e = {}) {
  const auto at = [&](double deg) {
    const double a = deg * M_PI / 180;
    return Vector3d(centre + radius * Vector3d(std::cos(a), std::sin(a), 0));
  };
  const int begin = s->add_node(at(from_deg)), end = s->add_node(at(to_deg));
  return s->add_stroke(StrokeKind::kArc, begin, end, {at((from_deg + to_deg) / 2)}, e);
}

inline double distance_to_line(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  return (p - a).cross((b - a).normalized()).norm();
}

inline double total_length(const Sketch& s) {
  double sum = 0;
  for (int i = 0; i < s.size(); ++i) sum += stroke_length(s, i);
  return sum;
}

inline std::vector<int> node_degrees(const Sketch& s) {
  std::vector<int> degree(s.nodes.cols());
  for (const Stroke& stroke : s.strokes)
    for (int n : {stroke.begin, stroke.end})
      if (n >= 0) ++degree[n];
  return degree;
}

inline void expect_sound(const PassResult& r, const Sketch& input) {
  EXPECT_THAT(validate(r.sketch), testing::IsEmpty());
  ASSERT_EQ(int(r.remap.stroke.size()), input.size());
  std::vector<bool> reached(r.sketch.size());
  for (int to : r.remap.stroke) {
    ASSERT_GE(to, -1);
    ASSERT_LT(to, r.sketch.size());
    if (to >= 0) reached[to] = true;
  }
  EXPECT_THAT(reached, testing::Each(true)) << "a stroke came from nowhere";
}

}  // namespace sketchsplat

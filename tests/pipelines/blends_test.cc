// SPDX-License-Identifier: MIT
#include "pipelines/method/blends.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sketches/curve/curve.h"
#include "tests/pipelines/rendered_part.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

// A step whose convex edges have rounds of 0.036 and 0.024 of its length, along x.
Reconstruction step_with_rounds(bool blends) {
  const TempFolder folder;
  write_rounded_part("blend-step", 3, 0.06, folder.path());
  ReconstructOptions options;
  options.blends = blends;
  return reconstruct(open_scene(folder.path()), options, nullptr);
}

TEST(Blends, RadiiOfConvexRoundsAreToldWithinAFifthAndAddNoStroke) {
  const Reconstruction with = step_with_rounds(true), without = step_with_rounds(false);
  EXPECT_EQ(json_of(with.sketch), json_of(without.sketch));
  EXPECT_TRUE(without.blends.blends.empty());
  ASSERT_EQ(int(with.blends.blends.size()), with.blends.curves.size());
  for (const double radius : {0.036, 0.024}) {
    int found = 0;
    for (size_t b = 0; b < with.blends.blends.size(); ++b) {
      const Blend& blend = with.blends.blends[b];
      if (!(std::abs(blend.radius - radius) < 0.2 * radius)) continue;
      ++found;
      EXPECT_LT(std::abs(blend.radius - radius), 3 * blend.sigma) << radius;
      EXPECT_GT(blend.views, 3);
      const Sketch& curves = with.blends.curves;
      const Eigen::Matrix3Xd along =
          sample_stroke(curves, int(b), 0.1 * stroke_length(curves, int(b)));
      const Eigen::Vector3d side = along.col(along.cols() - 1) - along.col(0);
      EXPECT_GT(std::abs(side.x()), 0.99 * side.norm()) << "it runs along x";
    }
    EXPECT_GE(found, 1) << radius;
  }
}

}  // namespace
}  // namespace sketchsplat

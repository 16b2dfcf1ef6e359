// SPDX-License-Identifier: MIT
#include "eval/metrics/edge_maps.h"

#include <gtest/gtest.h>

#include <fstream>

#include "datasets/types/errors.h"
#include "tests/eval/temp_folder.h"

namespace sketchsplat {
namespace {

Eigen::Matrix2Xd line(double y, double x0, double x1, int n) {
  Eigen::Matrix2Xd m(2, n);
  for (int i = 0; i < n; ++i) m.col(i) << x0 + (x1 - x0) * i / (n - 1), y;
  return m;
}

TEST(EdgeMapScore, CountsSharesOfPointsAndOfLength) {
  // Half of the truth is found, 0.3 px off; a quarter of the points lies elsewhere.
  Eigen::Matrix2Xd points(2, 68);
  points << line(10.3, 0, 50, 51), line(40, 0, 16, 17);
  const EdgeMapScore s = score_edge_points(points, {line(10, 0, 100, 2)}, 1.5);
  EXPECT_NEAR(s.precision, 0.75, 1e-9);
  EXPECT_NEAR(s.recall, 0.515, 0.003);  // the tolerance reaches beyond the end
  EXPECT_NEAR(s.f, 2 * s.precision * s.recall / (s.precision + s.recall), 1e-9);
  EXPECT_NEAR(s.rms_px, 0.3, 0.01);
}

TEST(EdgeMapScore, NothingAgainstNothingIsPerfectAndAgainstSomethingWorthless) {
  EXPECT_EQ(score_edge_points(Eigen::Matrix2Xd(2, 0), {}, 1.5).f, 1);
  EXPECT_EQ(score_edge_points(Eigen::Matrix2Xd(2, 0), {line(0, 0, 9, 2)}, 1.5).f, 0);
  EXPECT_EQ(score_edge_points(line(0, 0, 9, 5), {}, 1.5).f, 0);
}

TEST(EdgePolylines, AreReadAndRefusedInOneLine) {
  const TestFolder folder;
  std::ofstream(folder.path("a.json")) << R"({"polylines": [[[1, 2], [3, 4.5]]]})";
  const auto lines = read_edge_polylines(folder.path("a.json"));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0](1, 1), 4.5);
  for (const char* text :
       {R"({})", R"({"polylines": [[[1, 2]]]})", R"({"polylines": [[[1], [2]]]})"}) {
    std::ofstream(folder.path("b.json")) << text;
    EXPECT_THROW(read_edge_polylines(folder.path("b.json")), InputError) << text;
  }
}

}  // namespace
}  // namespace sketchsplat

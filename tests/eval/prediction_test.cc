// SPDX-License-Identifier: MIT
#include "eval/metrics/prediction.h"

#include <gtest/gtest.h>

#include <sstream>

#include "datasets/types/errors.h"
#include "sketches/io/io.h"
#include "temp_folder.h"

namespace sketchsplat {
namespace {

const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nproperty int stroke_index\nend_header\n0 0 0 4\n1 0 0 2\n0 0 1 4\n";

TEST(ReadPrediction, ReadsParametricEdges) {
  const TestFolder folder;
  const Prediction p =
      read_prediction(folder.write("parametric_edges.json",
                                   R"({"curves_ctl_pts": [[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]],
          "lines_end_pts": [[1,2,3,4,5,6]]})"));
  ASSERT_EQ(p.lines.size(), 1u);
  EXPECT_EQ(p.lines[0].col(1), Eigen::Vector3d(4, 5, 6));
  ASSERT_EQ(p.curves.size(), 1u);
  EXPECT_EQ(p.curves[0].col(2), Eigen::Vector3d(1, 1, 0));
  EXPECT_TRUE(p.strokes.empty());
  EXPECT_FALSE(p.points_only);
}

TEST(ReadPrediction, TakesPrimitivesOfAFolderAndStrokesOfItsPoints) {
  const TestFolder folder;
  folder.write("parametric_edges.json",
               R"({"curves_ctl_pts": [], "lines_end_pts": [[1,2,3,4,5,6]]})");
  folder.write("edge_points.ply", kPly);
  const Prediction p = read_prediction(folder.path());
  EXPECT_EQ(p.lines.size(), 1u);
  EXPECT_FALSE(p.points_only);
  ASSERT_EQ(p.strokes.size(), 2u);
  EXPECT_EQ(p.strokes[0].cols(), 1) << "stroke 2";
  EXPECT_EQ(p.strokes[1].cols(), 2) << "stroke 4";
}

TEST(ReadPrediction, TakesPointsAsTheyAre) {
  const TestFolder folder;
  const Prediction p = read_prediction(folder.write("gaussians_all.ply", kPly));
  EXPECT_TRUE(p.points_only);
  ASSERT_EQ(p.points.cols(), 3);
  EXPECT_EQ(p.points.col(2), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(
      read_prediction(folder.write("p.json", R"({"points": [[1,2,3],[4,5,6]]})")).points(1, 1), 5);
}

TEST(ReadPrediction, ReadsBinaryPoints) {
  const TestFolder folder;
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar red\n"
      "property double x\nproperty float y\nproperty double z\nend_header\n";
  const double x = 1.5, z = -2.5;
  const float y = 0.25f;
  ply += 'r';
  ply.append(reinterpret_cast<const char*>(&x), 8);
  ply.append(reinterpret_cast<const char*>(&y), 4);
  ply.append(reinterpret_cast<const char*>(&z), 8);
  const Prediction p = read_prediction(folder.write("a.ply", ply));
  EXPECT_EQ(p.points.col(0), Eigen::Vector3d(1.5, 0.25, -2.5));
  EXPECT_TRUE(p.strokes.empty());
  ply.resize(ply.size() - 1);
  EXPECT_THROW(read_prediction(folder.write("b.ply", ply)), InputError);
}

TEST(ReadPrediction, ReadsObjPolylinesAndTheirObjects) {
  const TestFolder folder;
  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 1 1\n";
  const Prediction grouped =
      read_prediction(folder.write("a.obj", v + "o first\nl 1 2\nl 2 3\no second\nl 3 4\n"));
  EXPECT_EQ(grouped.lines.size(), 3u);
  ASSERT_EQ(grouped.strokes.size(), 2u);
  EXPECT_GT(grouped.strokes[0].cols(), 1000) << "filled between the vertices";
  EXPECT_EQ(grouped.strokes[0].rightCols<1>(), Eigen::Vector3d(1, 1, 0));
  const Prediction loose = read_prediction(folder.write("b.obj", v + "l 1 2 3\nl -2 -1\n"));
  ASSERT_EQ(loose.lines.size(), 3u);
  EXPECT_EQ(loose.lines[2].col(1), Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(loose.strokes.size(), 2u);
  EXPECT_THROW(read_prediction(folder.write("c.obj", v + "l 1 5\n")), InputError);
  EXPECT_THROW(read_prediction(folder.write("d.obj", v + "l 0 1\n")), InputError);
  EXPECT_THROW(read_prediction(folder.write("e.obj", "v 1 2\n")), InputError);
}

TEST(ReadPrediction, ReadsASketch) {
  Sketch sketch;
  const int a = sketch.add_node({0, 0, 0}), b = sketch.add_node({1, 0, 0});
  sketch.add_stroke(StrokeKind::kLine, a, b, {});
  sketch.add_stroke(StrokeKind::kCircle, -1, -1, {{0.5, 0.5, 0.5}, {0, 0, 0.25}});
  std::ostringstream text;
  write_sketch_json(text, sketch);
  const TestFolder folder;
  const Prediction p = read_prediction(folder.write("sketch.json", text.str()));
  EXPECT_EQ(p.lines.size(), 1u);
  EXPECT_GE(p.curves.size(), 4u);
  EXPECT_EQ(p.strokes.size(), 2u) << "the pieces of the circle are one stroke";
}

TEST(ReadPrediction, TakesASmoothChainOfCubicsForOneCurve) {
  Sketch sketch;
  const int a = sketch.add_node({0, 0, 0}), b = sketch.add_node({2, 0, 0});
  const int c = sketch.add_node({4, 1, 0});
  sketch.add_stroke(StrokeKind::kBezier, a, b, {{0, 1, 0}, {1.5, 0.5, 0}});
  sketch.add_stroke(StrokeKind::kBezier, b, c, {{2.5, -0.5, 0}, {3, 0, 1}});
  std::ostringstream text;
  write_sketch_json(text, sketch);
  const TestFolder folder;
  const Prediction p = read_prediction(folder.write("sketch.json", text.str()));
  EXPECT_EQ(p.curves.size(), 2u);
  ASSERT_EQ(p.strokes.size(), 1u);
  EXPECT_EQ(p.strokes[0].rightCols<1>(), sketch.nodes.col(c));
  EXPECT_EQ(p.facts[0].parameters, 12 + 7) << "the second span begins where and as the first ends";
}

TEST(ReadPrediction, TellsWhatIsWrong) {
  const TestFolder folder;
  const auto broken = [&](const std::string& text) {
    EXPECT_THROW(read_prediction(folder.write("a.json", text)), InputError) << text;
  };
  broken("");
  broken("[1, 2]");
  broken("{}");
  broken(R"({"lines": [[1,2,3,4,5]]})");
  broken(R"({"lines": [[1,2,3,4,5,"six"]]})");
  broken(R"({"curves": [[[0,0,0],[1,0,0],[1,1,0]]]})");
  broken(R"({"lines": )" + std::string(200000, '[') + std::string(200000, ']') + "}");
  EXPECT_THROW(read_prediction(folder.path("nothing.json")), InputError);
  EXPECT_THROW(read_prediction(folder.write("a.txt", "")), InputError);
  std::filesystem::create_directories(folder.path("empty"));
  EXPECT_THROW(read_prediction(folder.path("empty")), InputError);
}

TEST(ReadPrediction, AcceptsAnEmptyOne) {
  const TestFolder folder;
  const Prediction p = read_prediction(
      folder.write("parametric_edges.json", R"({"curves_ctl_pts": [], "lines_end_pts": []})"));
  EXPECT_TRUE(p.lines.empty());
  EXPECT_TRUE(p.curves.empty());
}

}  // namespace
}  // namespace sketchsplat

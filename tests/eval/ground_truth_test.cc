// SPDX-License-Identifier: MIT
#include "datasets/truth/ground_truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "datasets/truth/published_samples.h"
#include "datasets/types/errors.h"
#include "sketches/io/io.h"
#include "temp_folder.h"

namespace sketchsplat {
namespace {

// A line of raw length 10 along x, a second one that is not sharp, and half a circle of radius 5
// whose inner parameters are thousandths, as the released files have them.
const char* kFeatures = R"(curves:
- direction: [1.0, 0.0, 0.0]
  location: [0.0, 0.0, 0.0]
  sharp: true
  type: Line
  vert_indices: [0, 2, 1]
  vert_parameters: [0.0, 4.0, 10.0]
- direction: [0.0, 1.0, 0.0]
  location: [0.0, 0.0, 0.0]
  sharp: false
  type: Line
  vert_indices: [0, 3]
  vert_parameters: [0.0, 5.0]
- location: [5.0, 0.0, 0.0]
  radius: 5.0
  sharp: true
  type: Circle
  vert_indices: [1, 4, 5, 0]
  vert_parameters: [0.0, 1047.1975511965977, 2094.3951023931954, 3.141592653589793]
  x_axis: [1.0, 0.0, 0.0]
  y_axis: [0.0, 1.0, 0.0]
  z_axis: [0.0, 0.0, 1.0]
surfaces:
- this: [is: not yaml
)";
const char* kStats = R"({"00000001": {"bbox": [0, 0, -1, 10, 5, 1, 10, 5, 2]}})";

TEST(FindGroundTruth, ReadsAbcFeaturesWithTheirObj) {
  const TestFolder folder;
  folder.write("scene/gt/00000001_a_features_000.yml", kFeatures);
  folder.write("scene/gt/00000001_a_trimesh_000.obj",
               "# mesh\nv 0 0 0\nv 10 0 0\nv 4 0 0\nv 0 5 0\nv 7.5 4.3301270189 0\n"
               "v 2.5 4.3301270189 0.5\nvn 1 2 3\nf 1 2 3\n");
  folder.write("chunk_0000_stats.json", kStats);
  for (const char* name : {"scene", "scene/", "scene/gt", "scene/gt/00000001_a_features_000.yml"}) {
    const GroundTruth truth = find_ground_truth(folder.path(name));
    EXPECT_EQ(truth.format, "abc");
    ASSERT_EQ(truth.curves.size(), 3u);
    EXPECT_EQ(truth.curves[0].type, "line");
    EXPECT_FALSE(truth.curves[1].sharp);
    // World = raw / 10 + (0.5, 0.5, 0.5) - centre / 10.
    EXPECT_TRUE(truth.curves[0].polyline.col(1).isApprox(Eigen::Vector3d(0.4, 0.25, 0.5), 1e-12));
    EXPECT_TRUE(truth.curves[2].polyline.col(2).isApprox(Eigen::Vector3d(0.25, 0.68301270189, 0.55),
                                                         1e-12));
    EXPECT_NEAR(truth.raw_scale, 0.1, 1e-15);
    EXPECT_EQ(truth.extent, 1);
    EXPECT_FALSE(truth.samples_published);
  }
}

TEST(FindGroundTruth, SamplesSharpCurvesInTheUnitsOfTheFile) {
  const TestFolder folder;
  folder.write("gt/00000001_features.yml", kFeatures);
  folder.write("gt/chunk_0000_stats.json", kStats);
  const GroundTruth truth = find_ground_truth(folder.path());
  // 4 and 6 raw units of line: 799 (Python: 4 // 0.005) and 1199; three chords of 5 units: 1000
  // each at most one less.
  const int line = int(floor_divide(4, 0.005) + floor_divide(6, 0.005));
  EXPECT_EQ(line, 1998);
  EXPECT_GE(truth.samples.cols(), line + 2997);
  EXPECT_LE(truth.samples.cols(), line + 3000);
  EXPECT_TRUE(truth.samples.col(0).isApprox(Eigen::Vector3d(0.4, 0.25, 0.5), 1e-12));
}

TEST(FindGroundTruth, RebuildsLinesAndCirclesWithoutAnObj) {
  const TestFolder folder;
  folder.write("gt/00000001_features.yml", kFeatures);
  folder.write("chunk_0000_stats.json", kStats);
  const GroundTruth truth = find_ground_truth(folder.path());
  ASSERT_EQ(truth.curves.size(), 3u);
  const Eigen::Matrix3Xd& arc = truth.curves[2].polyline;
  for (Eigen::Index i = 0; i < arc.cols(); ++i) {
    EXPECT_NEAR((arc.col(i) - Eigen::Vector3d(0.5, 0.25, 0.5)).norm(), 0.5, 1e-12);
  }
  EXPECT_NEAR(arc(0, 1), 0.75, 1e-12) << "60 degrees";
  EXPECT_NEAR((arc.col(3) - truth.curves[0].polyline.col(0)).norm(), 0, 1e-12) << "shared vertex";
}

TEST(FindGroundTruth, TakesPublishedSamplesAsTheyAre) {
  const TestFolder folder;
  folder.write("gt/00000001_features.yml", kFeatures);
  folder.write("chunk_0000_stats.json", kStats);
  folder.write("gt/00000001_0.005.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
               "property double z\nend_header\n0.5 0.25 0.125\n");
  const GroundTruth truth = find_ground_truth(folder.path());
  EXPECT_TRUE(truth.samples_published);
  ASSERT_EQ(truth.samples.cols(), 1);
  EXPECT_EQ(truth.samples.col(0), Eigen::Vector3d(0.5, 0.25, 0.125));
  EXPECT_EQ(truth.curves.size(), 3u);
}

TEST(FindGroundTruth, FindsTheSceneInATruthFolderOfTheWholeDataSet) {
  const TestFolder folder;
  folder.write("groundtruth/feat/00000001_features.yml", kFeatures);
  folder.write("groundtruth/feat/00000002_features.yml", kFeatures);
  folder.write("groundtruth/chunk_0000_stats.json", kStats);
  folder.write("data/00000001/meta_data.json", "{}");
  EXPECT_EQ(find_ground_truth(folder.path("data/00000001")).curves.size(), 3u);
  EXPECT_THROW(find_ground_truth(folder.path("groundtruth")), InputError) << "which of the two?";
  folder.write("data/00000003/meta_data.json", "{}");
  EXPECT_THROW(find_ground_truth(folder.path("data/00000003")), InputError);
}

TEST(FindGroundTruth, UndoesWorldToGt) {
  const TestFolder folder;
  folder.write("groundtruth/gt.json", R"([{"type": "line", "points": [[0,0,0],[1,0,0]]}])");
  // gt = 2 world + (1, 0, 0)
  folder.write("meta_data.json", R"({"worldtogt": [[2,0,0,1],[0,2,0,0],[0,0,2,0],[0,0,0,1]]})");
  const GroundTruth truth = find_ground_truth(folder.path());
  EXPECT_TRUE(truth.curves[0].polyline.col(1).isApprox(Eigen::Vector3d(0, 0, 0), 1e-12));
  EXPECT_TRUE(truth.curves[0].polyline.col(0).isApprox(Eigen::Vector3d(-0.5, 0, 0), 1e-12));
  EXPECT_NEAR(truth.extent, 0.5, 1e-12);
}

TEST(FindGroundTruth, ReadsListsOfCurvesAndClosesThem) {
  const TestFolder folder;
  folder.write("groundtruth/gt.json",
               R"([{"type": "Circle", "points": [[0,0,0],[8,0,0],[8,8,0]], "closed": true},
                   {"type": "line", "points": [[0,0,0],[1,0,0]], "closed": false}])");
  const GroundTruth truth = find_ground_truth(folder.path());
  ASSERT_EQ(truth.curves.size(), 2u);
  EXPECT_EQ(truth.curves[0].type, "circle");
  EXPECT_EQ(truth.curves[0].polyline.cols(), 4);
  EXPECT_TRUE(truth.curves[0].closed);
  EXPECT_FALSE(truth.curves[1].closed);
  EXPECT_EQ(truth.samples.cols(), 0) << "no units of a CAD file";
  EXPECT_EQ(truth.extent, 8);
}

TEST(FindGroundTruth, ReadsCurvesInMillimetres) {
  const TestFolder folder;
  folder.write("derived_gt_edges.json",
               R"({"scale": 0.1, "offset": [0, 0.5, 0],
                   "curves": [{"type": "Line", "points_mm": [[0,0,0],[9.9,0,0]]}]})");
  const GroundTruth truth = find_ground_truth(folder.path());
  EXPECT_TRUE(truth.curves[0].polyline.col(1).isApprox(Eigen::Vector3d(0.99, 0.5, 0), 1e-12));
  EXPECT_EQ(truth.samples.cols(), int(floor_divide(9.9, 0.005)));
  EXPECT_EQ(truth.extent, 1) << "0.99 is the unit cube's object";
}

TEST(FindGroundTruth, NumbersOfViewsThatNoSceneCanHaveAreRefused) {
  const TestFolder folder;
  const auto read = [&](const std::string& views) {
    folder.write(
        "derived_gt_edges.json",
        R"({"scale": 0.1, "offset": [0, 0, 0], "curves": [{"type": "Line", "points_mm": [[0,0,0],[9.9,0,0]],
                     "visible_views": )" +
            views + "}]}");
    return find_ground_truth(folder.path()).curves.at(0).visible_views;
  };
  EXPECT_EQ(read("[3, 24]"), (std::vector<int>{3, 24}));
  for (const char* wrong : {"[-1e308, 1]", "[1, 3e9]", "[-1, 1]", "[1]"})
    EXPECT_THROW(read(wrong), InputError) << wrong;
}

TEST(FindGroundTruth, KnowsAnObjectThatFillsTheUnitCubeByItsEdges) {
  const TestFolder folder;
  const auto extent = [&](const std::string& from, const std::string& to) {
    return find_ground_truth(folder.write("gt.json", R"([{"type": "line", "points": [)" + from +
                                                         "," + to + "]}]"))
        .extent;
  };
  EXPECT_EQ(extent("[0.2, 0.5, 0.5]", "[0.9, 0.5, 0.5]"), 1);
  EXPECT_EQ(extent("[-0.48, 0, 0]", "[0.48, 0, 0]"), 1);
  EXPECT_NEAR(extent("[0.5, 0.5, 0.5]", "[0.7, 0.5, 0.5]"), 0.2, 1e-12);
  EXPECT_NEAR(extent("[-0.4, 0.5, 0.5]", "[0.3, 0.5, 0.5]"), 0.7, 1e-12);
}

TEST(FindGroundTruth, ReadsASketch) {
  Sketch sketch;
  const int a = sketch.add_node({0, 0, 0}), b = sketch.add_node({3, 0, 0});
  sketch.add_stroke(StrokeKind::kLine, a, b, {});
  sketch.add_stroke(StrokeKind::kCircle, -1, -1, {{1, 1, 1}, {0, 0, 0.5}});
  std::ostringstream text;
  write_sketch_json(text, sketch);
  const TestFolder folder;
  folder.write("groundtruth/sketch.json", text.str());
  const GroundTruth truth = find_ground_truth(folder.path());
  EXPECT_EQ(truth.format, "sketch");
  ASSERT_EQ(truth.curves.size(), 2u);
  EXPECT_EQ(truth.curves[1].type, "circle");
  EXPECT_TRUE(truth.curves[1].closed);
  EXPECT_FALSE(truth.curves[0].closed);
  EXPECT_NEAR(truth.extent, 3, 1e-12);
}

TEST(FindGroundTruth, TellsWhatIsWrong) {
  const TestFolder folder;
  EXPECT_THROW(find_ground_truth(folder.path("nothing")), InputError);
  EXPECT_THROW(find_ground_truth(folder.path()), InputError) << "an empty folder";
  const auto broken = [&](const std::string& name, const std::string& text) {
    EXPECT_THROW(find_ground_truth(folder.write(name, text)), InputError) << text;
  };
  broken("gt.json", "");
  broken("gt.json", "[]");
  broken("gt.json", "{}");
  broken("gt.json", "3");
  broken("gt.json", R"([{"type": "line", "points": [[0,0,0]]}])");
  broken("gt.json", R"([{"type": "line", "points": [[0,0],[1,0]]}])");
  broken("gt.json", R"([{"type": "line", "points": [[0,0,0],[0,0,0]]}])");
  broken("gt.json", R"([{"type": "line", "points": 5}])");
  broken("gt.json", R"({"scale": 0, "offset": [0,0,0], "curves": []})");
  broken("gt.json", std::string(200000, '[') + std::string(200000, ']'));
  broken("gt.txt", "");
  broken("samples.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n");
}

TEST(FindGroundTruth, TellsWhatIsWrongWithAbcFiles) {
  const TestFolder folder;
  const std::string yml = folder.write("00000001_features.yml", kFeatures);
  EXPECT_THROW(find_ground_truth(yml), InputError) << "neither statistics nor OBJ";
  folder.write("chunk_0000_stats.json", R"({"00000002": {}})");
  EXPECT_THROW(find_ground_truth(yml), InputError) << "statistics of another model";
  folder.write("chunk_0000_stats.json", kStats);
  EXPECT_NO_THROW(find_ground_truth(yml));
  folder.write("00000001_trimesh.obj", "v 0 0 0\nv 10 0 0\n");
  EXPECT_THROW(find_ground_truth(yml), InputError) << "indices beyond the vertices";
  folder.write("00000001_trimesh.obj", "v 0 0\n");
  EXPECT_THROW(find_ground_truth(yml), InputError) << "two coordinates";
  std::filesystem::remove(folder.path("00000001_trimesh.obj"));
  const auto broken = [&](const std::string& text) {
    EXPECT_THROW(find_ground_truth(folder.write("00000001_features.yml", text)), InputError)
        << text;
  };
  broken("");
  broken("curves: 5\n");
  broken("curves:\n- type: Line\n");
  broken("curves:\n- [unclosed\n");
  broken("curves:\n- " + std::string(200000, '[') + std::string(200000, ']') + "\n");
  broken("curves:\n- {type: BSpline, sharp: true, vert_indices: [7, 8]}\n");
  broken(
      "curves:\n- {type: Line, sharp: false, vert_indices: [0, 1], vert_parameters: [0.0, 1.0],"
      " location: [0.0, 0.0, 0.0], direction: [1.0, 0.0, 0.0]}\n");
}

}  // namespace
}  // namespace sketchsplat

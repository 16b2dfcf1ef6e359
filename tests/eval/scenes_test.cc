// SPDX-License-Identifier: MIT
#include "eval/metrics/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "eval/metrics/report.h"
#include "temp_folder.h"

namespace sketchsplat {
namespace {

const char* const kTruth = R"([{"type": "Line", "points": [[0,0,0],[0.5,0,0],[1,0,0]],
                                "visible_views": [3, 2, 0]}])";
const char* const kLine = R"({"lines_end_pts": [[0,0,0,1,0,0]], "curves_ctl_pts": []})";

std::vector<SceneEvaluation> all(const TestFolder& folder) {
  std::vector<SceneEvaluation> results;
  for (const ScenePair& scene : find_scenes(folder.path("results"), folder.path("scenes"))) {
    results.push_back(evaluate_scene(scene, {}));
  }
  return results;
}

TEST(Scenes, MissingResultsCountAsZeroInTheMean) {
  const TestFolder folder;
  folder.write("scenes/a/groundtruth/gt.json", kTruth);
  folder.write("scenes/b/groundtruth/gt.json", kTruth);
  folder.write("scenes/no_truth/readme", "");
  folder.write("results/a/parametric_edges.json", kLine);
  EXPECT_TRUE(is_folder_of_scenes(folder.path("scenes")));
  EXPECT_FALSE(is_folder_of_scenes(folder.path("scenes/a")));
  const auto results = all(folder);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_FALSE(results[0].missing);
  EXPECT_TRUE(results[1].missing);
  const auto json = nlohmann::json::parse(scenes_to_json(results));
  EXPECT_EQ(json["missing"], 1);
  EXPECT_EQ(json["scenes"][1]["scene"], "b");
  EXPECT_NEAR(double(json["mean"]["F5"]), 50, 1e-4);
  EXPECT_NEAR(double(json["mean"]["structure.f"]), 50, 1e-9);
  EXPECT_NEAR(double(json["mean"]["F5_visible"]), 50, 1e-4);
  EXPECT_EQ(double(json["mean"]["acc"]), double(json["scenes"][0]["acc"])) << "b has none";
  EXPECT_THAT(scenes_to_csv(results), testing::HasSubstr("\nb,1,"));
  EXPECT_THAT(scenes_to_table(results), testing::HasSubstr("b (missing)"));
}

TEST(Scenes, ResultsMayBeFilesOfAnybody) {
  const TestFolder folder;
  for (const char* name : {"a", "b", "c"}) {
    folder.write(std::string("scenes/") + name + "/groundtruth/gt.json", kTruth);
  }
  folder.write("results/a.json", kLine);
  folder.write("results/b.obj", "v 0 0 0\nv 0.5 0 0\nv 1 0 0\nl 1 2 3\n");
  // NEF's cells: x and y exchanged, 2.4 / 256 each, the first at -1.2.
  folder.write("results/record_c_stage2_cubic.json",
               R"({"date": "", "scene_name": "c.ply", "curves_ctl_pts":
               [[[128,128,128],[128,163.5555555,128],[128,199.111111,128],
                 [128,234.6666666,128]]]})");
  for (const SceneEvaluation& scene : all(folder)) {
    EXPECT_NEAR(scene.evaluation.fine.levels[0].f, 100, 1e-4) << scene.name;
    EXPECT_EQ(scene.evaluation.structure.matched, 1) << scene.name;
  }
}

TEST(Scenes, OfNothingAreRefused) {
  const TestFolder folder;
  folder.write("empty/readme", "");
  folder.write("scenes/a/groundtruth/gt.json", kTruth);
  EXPECT_THROW(find_scenes(folder.path("empty"), folder.path("empty")), InputError);
  EXPECT_THROW(find_scenes(folder.path("empty"), folder.path("scenes")), InputError) << "no result";
  EXPECT_THROW(find_scenes(folder.path("nowhere"), folder.path("scenes")), InputError);
  folder.write("results/a.json", "{");
  EXPECT_THROW(all(folder), InputError) << "broken is not missing";
}

TEST(Scenes, VisibilityMustTellOfEveryPoint) {
  const TestFolder folder;
  const std::string truth = folder.write(
      "gt.json", R"([{"type": "Line", "points": [[0,0,0],[1,0,0]], "visible_views": [3]}])");
  EXPECT_THROW(find_ground_truth(truth), InputError);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// The published protocol on real scenes, against an independent evaluator: numbers that it gave for
// the predictions made here, and, where it can be run, the evaluator itself.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "eval/metrics/evaluate.h"
#include "eval/metrics/report.h"
#include "temp_folder.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace sketchsplat {
namespace {

const fs::path kShared = fs::path(SKETCHSPLAT_SOURCE_DIR) / ".." / "shared";
const fs::path kScenes = kShared / "data" / "abc-nef";

// Numbers in [-1, 1) that are the same everywhere.
class Noise {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return double(state_ >> 11) / double(uint64_t(1) << 52) - 1;
  }

 private:
  uint64_t state_ = 1;
};

// The true edges moved by up to 0.003 at their control points, all but two; one wrong line.
json noisy_prediction(const GroundTruth& truth) {
  Noise noise;
  json lines = json::array(), curves = json::array();
  for (size_t k = 2; k < truth.curves.size(); ++k) {
    const Eigen::Matrix3Xd& p = truth.curves[k].polyline;
    const bool line = truth.curves[k].type == "line";
    json control = json::array();
    for (int i = 0; i < (line ? 2 : 4); ++i) {
      const Eigen::Vector3d c = p.col((p.cols() - 1) * i / (line ? 1 : 3));
      json point = {c[0] + 0.003 * noise(), c[1] + 0.003 * noise(), c[2] + 0.003 * noise()};
      control.push_back(point);
    }
    (line ? lines : curves).push_back(control);
  }
  lines.push_back({{0.1, 0.2, 0.3}, {0.5, 0.5, 0.5}});
  for (json& line : lines) {
    line = {line[0][0], line[0][1], line[0][2], line[1][0], line[1][1], line[1][2]};
  }
  return {{"curves_ctl_pts", curves}, {"lines_end_pts", lines}};
}

json evaluate_as(const std::string& prediction, const GroundTruth& truth, Protocol protocol) {
  EvaluateOptions options;
  options.protocol = protocol;
  return json::parse(to_json(evaluate(read_prediction(prediction), truth, options)));
}

void expect_equal(const json& ours, const json& theirs) {
  for (const auto& [key, value] : theirs.items()) {
    if (value.is_number() && ours.contains(key) && key != "lines" && key != "curves") {
      EXPECT_NEAR(double(ours[key]), double(value), 1e-4) << key;
    }
  }
}

// Lays the truth out as the independent evaluator wants it. Curves without ABC files are written
// as such, with a box that gives their scale and offset.
void make_root(const TestFolder& folder, const std::string& id) {
  const fs::path root = folder.path("root");
  for (const char* name : {"feat", "obj", "sampled_pts"}) fs::create_directories(root / name);
  const fs::path derived = kScenes / id / "derived_gt_edges.json";
  if (!fs::exists(derived)) {
    const std::map<std::string, std::string> place = {
        {".yml", "feat"}, {".obj", "obj"}, {".ply", "sampled_pts"}};
    for (const auto& file : fs::directory_iterator(kScenes / id / "gt")) {
      fs::copy(file, root / place.at(file.path().extension().string()) / file.path().filename());
    }
    fs::copy(kScenes / "chunk_0000_stats.json", root / "chunk_0000_stats.json");
    return;
  }
  std::ifstream in(derived);
  const json truth = json::parse(in);
  json curves = json::array();
  std::string obj;
  int vertices = 0;
  for (const json& curve : truth["curves"]) {
    json indices = json::array();
    for (const json& p : curve["points_mm"]) {
      obj += "v " + p[0].dump() + " " + p[1].dump() + " " + p[2].dump() + "\n";
      indices.push_back(vertices++);
    }
    curves.push_back({{"type", curve["type"]}, {"sharp", true}, {"vert_indices", indices}});
  }
  folder.write("root/feat/" + id + "_features.yml", json{{"curves", curves}}.dump());
  folder.write("root/obj/" + id + "_mesh.obj", obj);
  const double side = 1 / double(truth["scale"]);
  json box = json::array();
  for (double half : {-0.5, 0.5}) {
    for (const json& offset : truth["offset"]) box.push_back((0.5 - double(offset) + half) * side);
  }
  for (int k = 0; k < 3; ++k) box.push_back(side);
  folder.write("root/chunk_0000_stats.json", json{{id, {{"bbox", box}}}}.dump());
}

class Published : public testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  void SetUp() override {
    id_ = GetParam().first;
    if (!fs::exists(kScenes / id_)) {
      GTEST_SKIP() << "The scene abc-nef/" << id_
                   << " is not beside the repository: " << kScenes.string();
    }
    truth_ = find_ground_truth((kScenes / id_).string());
  }
  std::string id_;
  GroundTruth truth_;
};

TEST_P(Published, NumbersAreThoseOfTheIndependentEvaluator) {
  const TestFolder folder;
  const std::string file = folder.write("p.json", noisy_prediction(truth_).dump());
  const json ours = evaluate_as(file, truth_, Protocol::kSketchSplat);
  const json theirs = json::parse(GetParam().second);
  expect_equal(ours, theirs["published"]);
  for (const auto& [key, value] : theirs["fine"].items()) {
    EXPECT_NEAR(double(ours["fine"][key]), double(value), 1e-3) << "fine " << key;
  }
  EXPECT_EQ(ours["structure"]["edges"], theirs["edges"]);
}

TEST_P(Published, AgreeWithTheEvaluatorItself) {
  const fs::path tool = kShared / "tools" / "eval_edges.py";
  const std::string python = "/usr/bin/python3";
  if (!fs::exists(tool) || std::system((python + " -c 'import numpy, scipy, yaml' 2>&1").c_str())) {
    GTEST_SKIP() << "The independent evaluator or Python's numpy, scipy or yaml is not here.";
  }
  const TestFolder folder;
  make_root(folder, id_);
  const std::string file = folder.write("p.json", noisy_prediction(truth_).dump());
  for (const bool voxel : {false, true}) {
    const std::string out = folder.path("out.json");
    const std::string command = python + " '" + tool.string() + "' eval --scene " + id_ +
                                " --gt-root '" + folder.path("root") + "' '" + file + "' --json '" +
                                out + "'" + (voxel ? " --voxel" : "") + " > '" +
                                folder.path("log") + "' 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream in(out);
    const json theirs = json::parse(in).at(file);
    ASSERT_TRUE(theirs.contains("F5") && theirs.contains("comp"));
    expect_equal(evaluate_as(file, truth_, voxel ? Protocol::kEmap : Protocol::kSketchSplat),
                 theirs);
  }
}

TEST_P(Published, TruthAgainstItselfIsPerfect) {
  Prediction prediction;
  prediction.points_only = true;
  prediction.points = truth_.samples;
  for (const Level& level : evaluate(prediction, truth_).published.levels) {
    EXPECT_NEAR(level.f, 100, 1e-4);
  }
}

TEST_P(Published, ShiftsBelowAThresholdPassAndAboveFail) {
  const auto f5 = [&](double shift) {
    Prediction moved;
    moved.points_only = true;
    moved.points = truth_.samples.colwise() + shift * Eigen::Vector3d(1, 2, 2) / 3;
    return evaluate(moved, truth_).published.levels[2].f;
  };
  EXPECT_NEAR(f5(0.004), 100, 1e-4);
  EXPECT_LT(f5(0.0051), 99.9);
}

INSTANTIATE_TEST_SUITE_P(AbcNef, Published,
                         testing::Values(std::pair("00000952",
                                                   R"(
{"published": {"acc": 14.359556, "comp": 8.062366, "samples": 2126, "P20": 94.967074, "R20":
94.055674, "F20": 94.509172, "P10": 94.967074, "R10": 93.683824, "F10": 94.32108, "P5":
94.967074, "R5": 93.490664, "F5": 94.223081, "P2": 67.732832, "R2": 38.881463, "F2": 49.403344,
"P1": 27.469426, "R1": 7.497875, "F1": 11.780279}, "fine": {"F5": 94.231955, "F2": 66.862271,
"F1": 26.360686, "acc": 14.314637, "comp": 8.042031}, "edges": 30})"),
                                         std::pair("00004926",
                                                   R"(
{"published": {"acc": 10.9872, "comp": 4.225552, "samples": 3028, "P20": 96.466314, "R20":
97.910401, "F20": 97.182988, "P10": 95.970938, "R10": 97.044173, "F10": 96.504567, "P5":
85.568032, "R5": 86.005639, "F5": 85.786272, "P2": 51.585205, "R2": 27.06297, "F2": 35.501108,
"P1": 13.011889, "R1": 3.385025, "F1": 5.372419}, "fine": {"F5": 85.989257, "F2": 50.854622,
"F1": 12.332374, "acc": 10.978299, "comp": 4.217027}, "edges": 33})"),
                                         std::pair("00004605",
                                                   R"(
{"published": {"acc": 36.554063, "comp": 54.161925, "samples": 1193, "P20": 55.658005, "R20":
42.778243, "F20": 48.375501, "P10": 51.215423, "R10": 38.713316, "F10": 44.095328, "P5":
48.868399, "R5": 36.783173, "F5": 41.973183, "P2": 38.642079, "R2": 13.509837, "F2": 20.020284,
"P1": 4.526404, "R1": 0.61625, "F1": 1.084807}, "fine": {"F5": 42.121828, "F2": 33.001558, "F1":
3.330626, "acc": 35.402093, "comp": 54.192858}, "edges": 12})")),
                         [](const auto& info) { return std::string("scene_") + info.param.first; });

}  // namespace
}  // namespace sketchsplat

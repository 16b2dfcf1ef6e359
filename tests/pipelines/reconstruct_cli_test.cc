// SPDX-License-Identifier: MIT
// From a CAD part to its files and back to a score, through the program alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipelines/options/options.h"
#include "pipelines/options/output_options.h"
#include "tests/pipelines/program.h"
#include "tests/support/sanitizer.h"

namespace sketchsplat {
namespace {

using nlohmann::json;

const char kScene[] =
    "synthesize box-hole --views 24 --resolution 400 --seed 3 --outputs none --quiet --out ";

class Chain : public Program {
 protected:
  // One scene for all tests of this file: rendering takes longest.
  static void SetUpTestSuite() {
    scene_ =
        (fs::temp_directory_path() / ("sketchsplat_chain." + std::to_string(getpid()))).string();
    Program::run_in(fs::temp_directory_path(), kScene + scene_);
  }
  static void TearDownTestSuite() { fs::remove_all(scene_); }

  json json_in(const std::string& name) const { return json::parse(text_of_file(folder_ / name)); }

  static std::string scene_;
};
std::string Chain::scene_;

TEST_F(Chain, WritesEveryFileItPromisesAndFindsTheEdgesOfThePart) {
  const Outcome o = run("reconstruct " + scene_ + " --out " + in_folder("result"));
  ASSERT_EQ(o.status, 0) << o.err;
  std::vector<std::string> names;
  int overlays = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "result")) {
    const std::string name = entry.path().filename().string();
    EXPECT_GT(entry.file_size(), 0u) << name;
    if (name.rfind("overlay_", 0) == 0)
      ++overlays;
    else
      names.push_back(name);
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre(
                         "sketch.json", "parametric_edges.json", "sketch.obj", "sketch.step",
                         "solid.step", "solid.json", "surfaces.csv", "dimensions.csv",
                         "edge_points.ply", "report.json", "report.html"));
  EXPECT_EQ(overlays, OutputOptions().overlays);
  const Outcome score = run("evaluate --pred " + in_folder("result") + " --gt " + scene_ +
                            " --json " + in_folder("score.json"));
  ASSERT_EQ(score.status, 0) << score.err;
  EXPECT_GT(json_in("score.json")["F5"], 95) << score.out;
}

TEST_F(Chain, EveryStrokeHasConfidenceCovarianceAndViewsAndTheUnsureCanBeLeftOut) {
  ASSERT_EQ(run("reconstruct " + scene_ + " -q --overlays 0 --out " + in_folder("all")).status, 0);
  const json all = json_in("all/sketch.json");
  std::vector<double> confidence;
  for (const json& stroke : all["strokes"]) {
    confidence.push_back(stroke["confidence"]);
    EXPECT_EQ(stroke["views"].size(), stroke["support_views"]);
    EXPECT_LT(stroke["views"].back(), all["views"].size());
    EXPECT_GE(stroke["covariance"].size(), 21u);
    EXPECT_GE(stroke["determined"], 4);
  }
  std::vector<double> sorted = confidence;
  std::sort(sorted.begin(), sorted.end());
  const double least = sorted[sorted.size() / 2];
  const int sure = int(
      std::count_if(confidence.begin(), confidence.end(), [&](double c) { return c >= least; }));
  ASSERT_LT(sure, int(confidence.size()));
  std::ostringstream text;
  text.precision(17);
  text << least;
  ASSERT_EQ(run("reconstruct " + scene_ + " -q --overlays 0 --min-confidence " + text.str() +
                " --out " + in_folder("sure"))
                .status,
            0);
  EXPECT_EQ(int(json_in("sure/sketch.json")["strokes"].size()), sure);
  const json report = json_in("sure/report.json");
  EXPECT_EQ(report["counts"]["unsure"], int(confidence.size()) - sure);
  EXPECT_EQ(int(report["strokes"].size()), sure);
}

TEST_F(Chain, EvaluationDrawsWhatIsMissed) {
  const std::string wrong = in_folder("wrong.json");
  std::ofstream(wrong) << R"({"lines_end_pts": [[0.3, 0.3, 0.3, 0.6, 0.7, 0.7]]})";
  const std::string command = "evaluate --pred " + wrong + " --gt " + scene_;
  EXPECT_EQ(run(command + " --overlays 2").status, kWrongUsage) << "where to?";
  const Outcome o = run(command + " --overlays 2 --out " + in_folder("worst"));
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, testing::HasSubstr("\nstroke line 0 (line): length 0.640, P5 "));
  EXPECT_GE(json_in("worst/evaluation.json")["worst_edges"].size(), 5u);
  EXPECT_EQ(count_lines(text_of_file(folder_ / "worst" / "evaluation.csv")), 3);
  int pictures = 0;
  for (const auto& file : fs::directory_iterator(folder_ / "worst")) {
    pictures += file.path().extension() == ".png";
  }
  EXPECT_EQ(pictures, 2);
}

TEST_F(Chain, ReportRecordsEveryOptionAndWhatOverrodeThePreset) {
  ASSERT_EQ(run("reconstruct " + scene_ + " --rounds 2 --preset fast --out " + in_folder("result"))
                .status,
            0);
  const json options = json_in("result/report.json")["options"];
  ReconstructOptions expected;
  apply_preset("fast", &expected);
  expected.rounds = 2;
  OutputOptions output;
  Fields fields;
  list_fields(&expected, &fields);
  list_fields(&output, &fields);
  for (const Field& field : fields.list)
    EXPECT_EQ(options[field.name], json::parse(fields_json(fields.list))[field.name]) << field.name;
  EXPECT_EQ(options.size(), fields.list.size() + 1) << "and the seed";
}

TEST_F(Chain, SketchIsTheSameForAnyNumberOfThreads) {
  const std::string work = "reconstruct " + scene_ + " --overlays 0 --preset fast --out ";
  ASSERT_EQ(run(work + in_folder("one") + " --threads 1").status, 0);
  ASSERT_EQ(run(work + in_folder("three") + " --threads 3").status, 0);
  for (const char* name : {"sketch.json", "sketch.obj", "sketch.step", "edge_points.ply"})
    EXPECT_TRUE(text_of_file(folder_ / "one" / name) == text_of_file(folder_ / "three" / name))
        << name;
}

// The mark says that the program need not ask libm for its plain versions: this CPU has no others.
TEST_F(Chain, SketchIsTheSameOnACpuWithoutAvx) {
  if (test::kSanitized) GTEST_SKIP() << "qemu has no room for its memory";
  if (std::system("command -v qemu-x86_64 >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no such CPU here: Debian's qemu-user has one";
  const std::string work = "reconstruct " + scene_ + " --overlays 0 --preset fast --out ";
  ASSERT_EQ(run(work + in_folder("here")).status, 0);
  const std::string old = "SKETCHSPLAT_ENVIRONMENT=set qemu-x86_64 -cpu Nehalem '" +
                          std::string(SKETCHSPLAT_BINARY) + "' " + work + in_folder("there") +
                          " >/dev/null 2>&1";
  ASSERT_EQ(std::system(old.c_str()), 0);
  for (const char* name : {"sketch.json", "sketch.obj", "sketch.step", "edge_points.ply"})
    EXPECT_TRUE(text_of_file(folder_ / "here" / name) == text_of_file(folder_ / "there" / name))
        << name;
}

TEST_F(Chain, ExportGivesTheFilesOfTheReconstruction) {
  ASSERT_EQ(run("reconstruct " + scene_ + " --preset fast --out " + in_folder("result")).status, 0);
  for (const char* name : {"sketch.obj", "edge_points.ply", "parametric_edges.json"}) {
    ASSERT_EQ(run("export " + in_folder("result") + " --out " + in_folder(name)).status, 0) << name;
    EXPECT_TRUE(text_of_file(folder_ / name) == text_of_file(folder_ / "result" / name)) << name;
  }
  ASSERT_EQ(run("export " + in_folder("result") + " -o " + in_folder("a.step")).status, 0);
  EXPECT_THAT(text_of_file(folder_ / "a.step"), testing::StartsWith("ISO-10303-21;"));
  EXPECT_EQ(run("export " + in_folder("result") + " -o " + in_folder("A.STEP")).status, 0);
  EXPECT_EQ(run("export " + in_folder("result") + " -o " + in_folder("a.xyz")).status, kWrongUsage);
  EXPECT_EQ(run("export " + in_folder("nothing") + " -o " + in_folder("a.obj")).status, kBadInput);
}

TEST_F(Program, ImpossibleNamesAreNoDefect) {
  const std::string name(300, 'a');  // longer than file systems allow
  const std::string s = scene();
  EXPECT_EQ(run("reconstruct " + s + " --out " + in_folder(name)).status, kNoOutput);
  EXPECT_EQ(run("export " + name + " --out " + in_folder("a.obj")).status, kBadInput);
  EXPECT_EQ(run("evaluate --pred " + name + " --gt " + s).status, kBadInput);
}

TEST_F(Program, ImagesOfAnotherSizeThanTheSceneSaysAreStatus3) {
  const std::string s = scene();
  std::string json = text_of_file(fs::path(s) / "meta_data.json");
  json.replace(json.find("\"height\": 48"), 12, "\"height\": 96");
  std::ofstream(fs::path(s) / "meta_data.json") << json;
  const Outcome o = run("reconstruct " + s + " -q --out " + in_folder("result"));
  EXPECT_EQ(o.status, kBadInput);
  EXPECT_THAT(o.err, testing::HasSubstr("64 x 96"));
}

TEST_F(Program, SceneWithTooLittleIsStatus4) {
  const Outcome o = run("reconstruct " + scene() + " -q --out " + in_folder("result"));
  EXPECT_EQ(o.status, kTooLittle);
  EXPECT_EQ(count_lines(o.err), 1) << o.err;
}

}  // namespace
}  // namespace sketchsplat

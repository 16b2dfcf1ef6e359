// SPDX-License-Identifier: MIT
// What people expect of any program on a command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class Habits : public Program {
 protected:
  static void SetUpTestSuite() {
    part_ = fs::temp_directory_path() / ("sketchsplat_habits." + std::to_string(getpid()));
    fs::create_directories(part_);
    made_ = Program::run_in(part_,
                            "synthesize box --views 12 --resolution 160 --outputs edges "
                            "--json --out " +
                                (part_ / "scene").string());
    result_ =
        Program::run_in(part_, "reconstruct " + (part_ / "scene").string() +
                                   " --preset fast --json --out " + (part_ / "result").string());
  }
  static void TearDownTestSuite() { fs::remove_all(part_); }

  static std::string scene() { return (part_ / "scene").string(); }
  static std::string result() { return (part_ / "result").string(); }

  static fs::path part_;
  static Outcome made_, result_;
};
fs::path Habits::part_;
Outcome Habits::made_, Habits::result_;

TEST_F(Habits, EveryVerbWritesItsResultsAsJsonIfAsked) {
  EXPECT_EQ(json::parse(made_.out)["views"], 12) << made_.err;
  EXPECT_EQ(json::parse(made_.out)["true_edges"], 12);
  const json report = json::parse(result_.out);
  EXPECT_EQ(report["out"], result());
  EXPECT_EQ(report["counts"]["views"], 12);
  EXPECT_EQ(report["options"]["preset"], "fast");

  const json parts = json::parse(run("synthesize --list-parts --json").out);
  EXPECT_EQ(parts["box"]["width"]["unit"], "mm");
  const json maps =
      json::parse(run("detect " + scene() + " --score --json --out " + in_folder("maps")).out);
  EXPECT_EQ(maps["maps"], 12);
  EXPECT_GT(maps["score"]["f"], 50);
  const json file =
      json::parse(run("export " + result() + " --json --out " + in_folder("a.dxf")).out);
  EXPECT_EQ(file["format"], "dxf");
  EXPECT_GT(file["curves"], 8);
  EXPECT_EQ(file["left_out"], 0);
  const std::string pair = "evaluate --pred " + result() + " --gt " + scene();
  const json numbers = json::parse(run(pair + " --json").out);
  EXPECT_GT(numbers["F5"], 80);
  EXPECT_EQ(json::parse(run("evaluate --json --gt " + scene() + " --pred " + result()).out),
            numbers);
  EXPECT_EQ(json::parse(run("--json " + pair).out), numbers) << "before the verb";
  const Outcome both = run(pair + " --json " + in_folder("numbers.json"));
  EXPECT_THAT(both.out, HasSubstr("F20")) << "with a file the table stays";
  EXPECT_EQ(json::parse(text_of_file(folder_ / "numbers.json")), numbers);
  const json rows = json::parse(
      run("bench " + scene() + " --presets fast --json -q --out " + in_folder("bench")).out);
  EXPECT_EQ(rows["rows"].size(), 1u);
  const json batch =
      json::parse(run("batch " + scene() + " --json -q --out " + in_folder("batch")).out);
  EXPECT_EQ(batch["done"], 1);
}

TEST_F(Habits, DryRunSaysWhatWouldBeReadAndWritesNothing) {
  const std::string work = "reconstruct " + scene() + " --out " + in_folder("nothing");
  const Outcome o = run(work + " --dry-run --threads 1");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("abc-nef, 12 views, 0.3 million pixels"),
                           HasSubstr(" s with 1 thread, "), HasSubstr(" MB, into ")));
  const json plan = json::parse(run(work + " --dry-run --json --detector maps:none").out);
  EXPECT_EQ(plan["views"], 12);
  EXPECT_EQ(plan["missing_maps"], 12);
  EXPECT_GT(plan["expected_mb"], 1);
  EXPECT_FALSE(fs::exists(folder_ / "nothing"));
  EXPECT_THAT(run("reconstruct --dry-run --out x --images " + scene() + "/color").out,
              AllOf(HasSubstr("without cameras, 12 views"), HasSubstr("after COLMAP")));
  EXPECT_EQ(run("reconstruct " + in_folder("gone") + " --out x --dry-run").status, kBadInput);
}

TEST_F(Habits, TheLogHasWhatIsSaidAndWhyItEnded) {
  const std::string log = in_folder("log");
  ASSERT_EQ(run("detect " + scene() + " -q --log " + log + " --out " + in_folder("maps")).status,
            0);
  EXPECT_EQ(run("detect " + in_folder("gone") + " --log " + log + " --out x").status, kBadInput);
  EXPECT_THAT(text_of_file(log), AllOf(HasSubstr(" detect  "), HasSubstr("a scene folder")));
  EXPECT_EQ(run("detect " + scene() + " --log /proc/none/log --out " + in_folder("x")).status,
            kNoOutput);
}

}  // namespace
}  // namespace sketchsplat

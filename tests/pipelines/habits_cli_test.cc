// SPDX-License-Identifier: MIT
// What people expect of any program on a command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

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

  // What a shell command writes to its standard output.
  std::string shell(const std::string& command) const {
    const std::string file = in_folder("shell.txt");
    const int status = std::system(("(" + command + ") >'" + file + "' 2>&1 </dev/null").c_str());
    EXPECT_EQ(status, 0) << command << "\n" << text_of_file(file);
    return text_of_file(file);
  }
  // The program on a terminal: all that it writes there.
  std::string on_terminal(const std::string& environment, const std::string& arguments) const {
    return shell(environment + " script -qec \"'" + SKETCHSPLAT_BINARY + "' " + arguments +
                 " || true\" /dev/null");
  }
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

TEST_F(Habits, WarningsComeAgainAtTheEnd) {
  const fs::path broken = folder_ / "broken";
  fs::copy(part_ / "scene", broken, fs::copy_options::recursive);
  fs::remove(broken / "color" / "3_colors.png");
  const Outcome o = run("detect " + broken.string() + " --out " + in_folder("maps"));
  const std::string warning = "warning: frame 3_colors.png is left out: its image is missing\n";
  ASSERT_EQ(o.status, 0);
  EXPECT_EQ(o.err.substr(0, warning.size()), warning);
  EXPECT_EQ(o.err.substr(o.err.size() - warning.size()), warning);
}

TEST_F(Habits, ColourIsForTerminalsOnly) {
  if (std::system("script -qec true /dev/null >/dev/null 2>&1 </dev/null") != 0)
    GTEST_SKIP() << "nothing here makes a terminal (script, and a pseudo-terminal)";
  const std::string wrong = "detect " + in_folder("gone") + " --out x";
  EXPECT_THAT(on_terminal("TERM=xterm NO_COLOR=", wrong),
              HasSubstr("\033[31msketchsplat:\033[0m "));
  EXPECT_THAT(on_terminal("TERM=xterm NO_COLOR=1", wrong), Not(HasSubstr("\033[3")));
  EXPECT_THAT(on_terminal("TERM=dumb NO_COLOR=", wrong), Not(HasSubstr("\033[")));
  EXPECT_EQ(run(wrong).err.find('\033'), std::string::npos);
  const std::string work = "detect " + scene() + " --out " + in_folder("maps");
  EXPECT_THAT(on_terminal("TERM=xterm", work), HasSubstr("] 0/12")) << "a bar";
  EXPECT_THAT(on_terminal("TERM=dumb", work), Not(HasSubstr("] 0/12")));
}

TEST_F(Habits, TheVersionNamesCommitAndLibraries) {
  EXPECT_TRUE(std::regex_search(run("--version").out,
                                std::regex("\ncommit ([0-9a-f]{7,}(-dirty)?|unknown)\n")));
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// Files of options: --save-config and --config.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// What a dry run with these arguments would save as options.
class Config : public Program {
 protected:
  std::string saved(const std::string& arguments) const {
    const std::string file = in_folder("saved.toml");
    const Outcome o = run("reconstruct " + scene() + " --out " + in_folder("dry") +
                          " --dry-run --save-config " + file + " " + arguments);
    EXPECT_EQ(o.status, 0) << o.err;
    return text_of_file(file);
  }
  std::string file_of(const std::string& text) const {
    std::ofstream(in_folder("options.toml")) << text;
    return in_folder("options.toml");
  }
  void expect_refused(const std::string& text, ExitStatus status, const std::string& why) const {
    const Outcome o = run("reconstruct " + scene() + " --out " + in_folder("dry") +
                          " --dry-run --config " + file_of(text));
    EXPECT_EQ(o.status, status) << text;
    EXPECT_THAT(o.err, AllOf(HasSubstr("options.toml"), HasSubstr(why))) << text;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
  }
};

TEST_F(Config, WhatIsSavedIsReadAgain) {
  EXPECT_EQ(saved(""), "[reconstruct]\n");
  const std::string some = saved(
      "--detector geometry --lift-views 30 --blends --without close,conics --min-confidence "
      "0.5 --like 'a b.json' --like c.json --box=-1,-1,-1,1,1,1 --no-reproducible");
  EXPECT_THAT(some, AllOf(HasSubstr("detector=\"geometry\"\n"), HasSubstr("lift-views=30\n"),
                          HasSubstr("like=[\"a b.json\", \"c.json\"]\n"),
                          HasSubstr("blends=true\n"), HasSubstr("reproducible=false\n")));
  EXPECT_THAT(some, testing::Not(HasSubstr("\nout=")));
  EXPECT_EQ(saved("--config " + file_of(some)), some);
}

TEST_F(Config, TheCommandLineOverridesTheFileAndOtherVerbsHaveTheirOwnSections) {
  const std::string file = file_of(
      "threads = 1 # of all verbs\n[reconstruct]\nrounds = 3\nmin-views = 7\n[batch]\njobs = 2\n");
  EXPECT_EQ(saved("--rounds 1 --config " + file), "[reconstruct]\nmin-views=7\nrounds=1\n");
}

TEST_F(Config, WhatIsNoOptionIsRefusedInOneLine) {
  expect_refused("[reconstruct]\nmin-veiws = 3\n", kBadInput, "min-veiws");
  expect_refused("rounds = 3\n", kBadInput, "those of a verb below a line [VERB]");
  expect_refused("[reconstruct]\nrounds = much\n", kWrongUsage, "--rounds: expected a whole");
  expect_refused("[reconstruct]\nwithout = [\"close\", \"conic\"]\n", kWrongUsage, "got 'conic'");
  expect_refused("[reconstruct]\nout = \"elsewhere\"\n", kBadInput, "out");
  const Outcome none = run("reconstruct " + scene() + " --out x --config " + in_folder("gone"));
  EXPECT_EQ(none.status, kBadInput);
  EXPECT_THAT(none.err, HasSubstr("gone: expected a file of options, found none"));
}

}  // namespace
}  // namespace sketchsplat

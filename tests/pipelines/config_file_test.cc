// SPDX-License-Identifier: MIT
#include "pipelines/command/config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/types/errors.h"
#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

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
  void expect_refused(const std::string& text, const std::string& why) const {
    const Outcome o = run("reconstruct " + scene() + " --out " + in_folder("dry") +
                          " --dry-run --config " + file_of(text));
    EXPECT_EQ(o.status, kBadInput) << text;
    EXPECT_THAT(o.err, AllOf(HasSubstr("options.toml: "), HasSubstr(why))) << text;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
  }
};

TEST_F(Config, WhatIsSavedIsReadAgain) {
  EXPECT_EQ(saved(""), "[reconstruct]\n");
  const std::string some = saved(
      "--detector geometry --min-nats 2.5 --without close,conics --like 'a b.json' --like c.json");
  EXPECT_EQ(
      some,
      "[reconstruct]\ndetector = \"geometry\"\n"
      "like = [\"a b.json\", \"c.json\"]\nwithout = [\"conics\", \"close\"]\nmin-nats = 2.5\n");
  EXPECT_EQ(saved("--config " + file_of(some)), some);
}

TEST_F(Config, TheCommandLineHasTheLastWordAndOtherVerbsTheirOwnSections) {
  const std::string file =
      file_of("min-nats = 3 # comment\n[reconstruct]\nmin-length = 7\n[batch]\njobs = 2\n");
  EXPECT_EQ(saved("--min-nats 1 --config " + file),
            "[reconstruct]\nmin-nats = 1\nmin-length = 7\n");
}

TEST_F(Config, WhatIsNoOptionIsRefusedInOneLine) {
  expect_refused("min-natz = 3\n", "found 'min-natz', did you mean min-nats?");
  expect_refused("min-nats = much\n", "min-nats");
  expect_refused("min-nats = [1, 2]\n", "expected one value of min-nats, found 2");
  expect_refused("conics = false\n", "found 'conics', replaced by --without conics");
  expect_refused("map-min-chain = 3\n", "found 'map-min-chain', replaced by --detect-min-chain");
  expect_refused("without = [\"close\", \"conic\"]\n", "got 'conic'");
  expect_refused("out = \"elsewhere\"\n", "found 'out'");
  expect_refused("config = \"options.toml\"\n", "found 'config'");
  fs::remove(in_folder("options.toml"));
  const Outcome none = run("reconstruct " + scene() + " --out " + in_folder("dry") +
                           " --config " + in_folder("options.toml"));
  EXPECT_EQ(none.status, kBadInput);
  EXPECT_THAT(none.err, HasSubstr("expected a file of options, found none"));
}

// Without the program: options of every kind.
struct ConfigFile : Config {
  ConfigFile() {
    fields.add("count", &count, "", 0, 9, "");
    fields.add("on", &on, "");
    fields.add("names", &names, "NAME", "").several = true;
    fields.choose("kind", &kind, {"a", "b"}, "");
  }
  int count = 3;
  bool on = true;
  std::string names, kind = "a";
  Fields fields;
};

TEST_F(ConfigFile, DefaultsAreNotWrittenAndAllElseIsAsItWasGiven) {
  EXPECT_EQ(config_text("verb", fields.list), "[verb]\n");
  count = 4, on = false, names = "one\ntwo's", kind = "b";
  const std::string text = config_text("verb", fields.list);
  EXPECT_EQ(text,
            "[verb]\ncount = 4\non = false\nnames = [\"one\", \"two's\"]\nkind = \"b\"\n");
  EXPECT_THAT(read_config(file_of(text), "verb", fields.list),
              ElementsAre(Pair("count", "4"), Pair("kind", "b"), Pair("names", "one\ntwo's"),
                          Pair("on", "false")));
  EXPECT_TRUE(read_config(file_of(text), "other", fields.list).empty());
}

TEST_F(ConfigFile, ATextThatNoFileCanHoldIsRefused) {
  kind = "b", names = "\"'";
  EXPECT_THROW(config_text("verb", fields.list), UsageError);
}

TEST_F(ConfigFile, AFolderOrAHugeFileIsNoFileOfOptions) {
  EXPECT_THROW(read_config(in_folder(""), "verb", fields.list), InputError);
  EXPECT_THROW(read_config(file_of(std::string(2 << 20, '#')), "verb", fields.list), InputError);
}

}  // namespace
}  // namespace sketchsplat

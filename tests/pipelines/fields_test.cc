// SPDX-License-Identifier: MIT
#include "pipelines/base/fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "pipelines/options/common_options.h"
#include "pipelines/options/options.h"
#include "pipelines/options/output_options.h"

namespace sketchsplat {
namespace {

using testing::HasSubstr;

enum class Shape { kRound, kSquare };

struct Sample {
  int rounds = 7;
  double size_px = 0.1;
  bool fast = false;
  std::string detector = "image";
  Shape shape = Shape::kSquare;
};

std::vector<Field> list(Sample* s) {
  Fields f;
  f.add("rounds", &s->rounds, "", 1, 50, "Rounds");
  f.add("size-px", &s->size_px, "px", 0.05, 10, "Size");
  f.add("fast", &s->fast, "Hurry");
  f.choose("detector", &s->detector, {"image", "maps:NAME"}, "Detector");
  f.choose("shape", &s->shape, {"round", "square"}, "Shape");
  return f.list;
}

std::string refusal(const Field& field, const std::string& text) {
  try {
    assign(field, text);
  } catch (const UsageError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Fields, AssignReachesTheMember) {
  Sample s;
  const auto f = list(&s);
  assign(f[0], "50");
  assign(f[1], "1e-1");
  assign(f[2], "true");
  assign(f[3], "maps:DexiNed");
  assign(f[4], "round");
  EXPECT_EQ(s.rounds, 50);
  EXPECT_EQ(s.size_px, 0.1);
  EXPECT_TRUE(s.fast);
  EXPECT_EQ(s.detector, "maps:DexiNed");
  EXPECT_EQ(s.shape, Shape::kRound);
}

TEST(Fields, RefusalNamesFlagRangeAndWhatItGot) {
  Sample s;
  const auto f = list(&s);
  EXPECT_EQ(refusal(f[0], "51"), "--rounds: expected a whole number from 1 to 50, got '51'");
  EXPECT_EQ(refusal(f[1], "0.01"), "--size-px: expected a number from 0.05 to 10 px, got '0.01'");
  EXPECT_EQ(refusal(f[4], "oval"), "--shape: expected one of round, square, got 'oval'");
  EXPECT_EQ(s.rounds, 7) << "a refused value must not be assigned";
}

TEST(Fields, SomeOfAListAreOneTextInItsOrder) {
  std::string without = "none";
  Fields f;
  f.pick("without", &without, {"a", "b", "c"}, "Left out");
  const Field& field = f.list[0];
  EXPECT_EQ(field.help, "Left out, with commas between: a, b, c");
  assign(field, "c,a\nc");
  EXPECT_EQ(without, "a,c");
  EXPECT_TRUE(picked(without, "c"));
  EXPECT_FALSE(picked(without, "b"));
  for (const char* text : {"", "a,", "ab", "a b", "none,a"})
    EXPECT_THAT(refusal(field, text), HasSubstr("none or some of a, b, c, got '")) << text;
  EXPECT_EQ(without, "a,c");
  assign(field, "none");
  EXPECT_EQ(without, "none");
}

TEST(Fields, AnUnknownOptionNamesWhatReplacesItOrWasMeant) {
  std::string without = "none";
  int size = 0;
  Fields f;
  f.pick("without", &without, {"conics"}, "Left out");
  f.add("size", &size, "px", 0, 9, "Size");
  const auto hint = [&](const std::string& given) { return unknown_option(f.list, given, "work"); };
  EXPECT_EQ(hint("--no-conics"),
            "unknown option --no-conics, replaced by --without conics (see "
            "sketchsplat work --help-all)");
  EXPECT_THAT(hint("conics"), HasSubstr(", replaced by without conics "));
  EXPECT_THAT(hint("--sise=3"), HasSubstr("option --sise=3, did you mean --size? "));
  EXPECT_THAT(hint("sise"), HasSubstr(", did you mean size? "));
  EXPECT_THAT(hint("--bananas"), HasSubstr("option --bananas (see "));
}

TEST(Fields, WhatIsNoNumberIsRefused) {
  Sample s;
  const auto f = list(&s);
  for (const char* text : {"", " ", "x", "1x", "nan", "inf", "1.5", "99999999999", "- 1", "0x10"})
    EXPECT_THAT(refusal(f[0], text), HasSubstr("--rounds")) << "'" << text << "'";
  for (const char* text : {"", "nan", "inf", "1e999", "1,5", "1 "})
    EXPECT_THAT(refusal(f[1], text), HasSubstr("--size-px")) << "'" << text << "'";
  for (const char* text : {"", "maps:", "maps", "images"})
    EXPECT_THAT(refusal(f[3], text), HasSubstr("--detector")) << "'" << text << "'";
}

TEST(Fields, JsonHoldsEveryFieldWithItsType) {
  Sample s;
  const auto json = nlohmann::json::parse(fields_json(list(&s)));
  EXPECT_EQ(json, nlohmann::json::parse(R"({"rounds": 7, "size-px": 0.1, "fast": false,
                                            "detector": "image", "shape": "square"})"));
}

TEST(Fields, InitialTextIsWhatGivesTheDefaultBack) {
  Sample s, t;
  for (const Field& field : list(&s)) assign(*find_field(list(&t), field.name), field.initial);
  EXPECT_EQ(fields_json(list(&s)), fields_json(list(&t)));
}

TEST(Options, EveryDefaultLiesInItsRange) {
  CommonOptions common;
  ReconstructOptions method;
  OutputOptions output;
  Fields f;
  list_fields(&common, &f);
  list_fields(&method, &f);
  list_fields(&output, &f);
  for (const Field& field : f.list) {
    const std::set<std::string> none = {"log", "config", "save-config", "like",
                                        "surfel"};  // if left out
    if (none.count(field.name)) continue;
    EXPECT_NO_THROW(assign(field, field.initial)) << field.name;
  }
}

TEST(Options, EveryFieldHasAUniqueNameAndOneLineOfHelp) {
  CommonOptions common;
  ReconstructOptions method;
  OutputOptions output;
  Fields f;
  list_fields(&common, &f);
  list_fields(&method, &f);
  list_fields(&output, &f);
  std::vector<std::string> names;
  for (const Field& field : f.list) {
    EXPECT_THAT(names, testing::Not(testing::Contains(field.name)));
    names.push_back(field.name);
    EXPECT_FALSE(field.help.empty()) << field.name;
    EXPECT_EQ(field.help.find('\n'), std::string::npos) << field.name;
  }
}

TEST(Options, StepsThatAreLeftOutAreOffAndAllOthersAreAsTheyWere) {
  ReconstructOptions options;
  Fields f;
  list_fields(&options, &f);
  const Field* without = find_field(f.list, "without");
  ASSERT_NE(without, nullptr);
  const auto leave_out = [&](const std::string& text) {
    assign(*without, text);
    without->applied();
  };
  leave_out("close,polish");
  EXPECT_FALSE(options.close.on);
  EXPECT_FALSE(options.early_polish || options.final_polish);
  EXPECT_TRUE(options.regularize.on);
  leave_out("regularize");
  EXPECT_FALSE(options.regularize.on);
  EXPECT_TRUE(options.close.on);
  EXPECT_TRUE(options.early_polish && options.final_polish);
}

TEST(Options, SurfelsAreSetByNamesOrTheirCountAlone) {
  ReconstructOptions options;
  set_options({{"surfel", "kernel=skew-normal,count=2000"}}, &options);
  EXPECT_EQ(options.surfels.kernel, SurfelKernel::kSkewNormal);
  EXPECT_EQ(options.surfels.surfels, 2000);
  set_options({{"surfel", "500"}}, &options);
  EXPECT_EQ(options.surfels.surfels, 500);
  for (const char* wrong : {"kernel=round", "count=1", "size=3", "many", "kernel"})
    EXPECT_THROW(set_options({{"surfel", wrong}}, &options), UsageError) << wrong;
}

TEST(Options, TheFolderOfSiblingsIsNotPartOfTheirNames) {
  ReconstructOptions options;
  set_options({{"like", "out/./a/box\nout/./b"}}, &options);
  EXPECT_EQ(options.like, "a/box\nb");
  EXPECT_EQ(options.like_folder, "out");
  EXPECT_THROW(set_options({{"like", "out/./a\nb"}}, &options), UsageError);
  ReconstructOptions plain;
  set_options({{"like", "./a"}}, &plain);
  EXPECT_EQ(plain.like, "./a");
  EXPECT_EQ(plain.like_folder, "");
}

TEST(Options, BalancedIsTheDefaults) {
  ReconstructOptions untouched, balanced;
  apply_preset("balanced", &balanced);
  Fields a, b;
  list_fields(&untouched, &a);
  list_fields(&balanced, &b);
  EXPECT_EQ(fields_json(a.list), fields_json(b.list));
}

TEST(Options, EveryPresetIsAppliedAndRecorded) {
  for (const std::string& name : preset_names()) {
    ReconstructOptions options;
    ASSERT_NO_THROW(apply_preset(name, &options)) << name;
    EXPECT_EQ(options.preset, name);
  }
  ReconstructOptions options;
  EXPECT_THROW(apply_preset("hasty", &options), UsageError);
}

TEST(Help, NearestWordForgivesTyposOnly) {
  EXPECT_EQ(nearest_word("reconstuct", {"detect", "reconstruct"}), "reconstruct");
  EXPECT_EQ(nearest_word("--treads", {"--seed", "--threads"}), "--threads");
  EXPECT_EQ(nearest_word("bananas", {"detect", "reconstruct"}), "");
  EXPECT_EQ(nearest_word("x", {}), "");
}

}  // namespace
}  // namespace sketchsplat

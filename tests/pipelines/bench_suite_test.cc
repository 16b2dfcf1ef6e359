// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "datasets/types/errors.h"
#include "pipelines/bench/plan.h"
#include "pipelines/bench/suite.h"
#include "pipelines/command/cli.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

Suite suite_of_text(const TempFolder& folder, const std::string& text) {
  const std::string path = folder.file("some.yml");
  std::ofstream(path) << text;
  return read_suite(path);
}

TEST(Suite, ListsScenesPartsVariantsAndAxes) {
  const TempFolder folder;
  const Suite suite = suite_of_text(folder, R"(
presets: [fast, balanced]
detectors: [image, maps:DexiNed]
synthesize: {views: 24, noise: 2}
reconstruct: {overlays: 0}
repeats: 2
scenes: [real, {part: files/bracket.step, name: mine, synthesize: {views: 10}}]
parts: [box, box]
axes:
  - {name: noise, title: noise of the images, vary: synthesize.noise, levels: [0, 2.5]}
  - {name: threads, vary: reconstruct.threads, levels: [1, 2], report: constant, parts: [flange]}
)");
  EXPECT_EQ(suite.name, "some");
  EXPECT_EQ(suite.repeats, 2);
  ASSERT_EQ(suite.scenes.size(), 4u);
  EXPECT_EQ(suite.scenes[0].folder, folder.path() + "/real") << "beside the suite";
  EXPECT_EQ(suite.scenes[1].name, "mine");
  EXPECT_EQ(suite.scenes[1].part, folder.path() + "/files/bracket.step");
  EXPECT_EQ(suite.scenes[3].name, "box_2");
  ASSERT_EQ(suite.variants.size(), 4u);
  EXPECT_EQ(suite.variants[1].name, "fast, maps:DexiNed");
  ASSERT_EQ(suite.axes.size(), 2u);
  EXPECT_EQ(suite.axes[1].scenes.size(), 1u);
  EXPECT_TRUE(suite.axes[1].of_reconstruct);

  const std::vector<BenchLevel> noise = plan_jobs(suite, &suite.axes[0], {{"rounds", "1"}});
  ASSERT_EQ(noise.size(), 2u);
  ASSERT_EQ(noise[1].size(), 4u * 4) << "scenes, variants";
  const BenchJob& mine = noise[1][4];
  EXPECT_EQ(mine.scene, "mine");
  EXPECT_THAT(mine.synthesize, testing::Contains(Pair("views", "10"))) << "over the suite's";
  EXPECT_THAT(mine.synthesize, testing::Contains(Pair("noise", "2.5"))) << "over both";
  EXPECT_THAT(mine.reconstruct, testing::Contains(Pair("rounds", "1")));
  const std::vector<BenchLevel> threads = plan_jobs(suite, &suite.axes[1], {});
  ASSERT_EQ(threads[0].size(), 1u * 4);
  EXPECT_THAT(threads[1][0].reconstruct, testing::Contains(Pair("threads", "2")));
}

TEST(Suite, StepsThatAreLeftOutAddUp) {
  const TempFolder folder;
  const Suite suite = suite_of_text(
      folder,
      "parts: [box]\npresets: [fast]\nreconstruct: {without: close}\naxes:\n  - {name: a, "
      "vary: reconstruct.without, levels: [none, conics], report: constant}\n");
  const std::vector<BenchLevel> levels =
      plan_jobs(suite, &suite.axes[0], {{"without", "regularize"}});
  EXPECT_THAT(levels[1][0].reconstruct,
              testing::Contains(Pair("without", "close,regularize,conics")));
  EXPECT_THAT(levels[0][0].reconstruct, testing::Contains(Pair("without", "close,regularize")));
  EXPECT_THROW(suite_of_text(folder, "parts: [box]\nreconstruct: {conics: false}\n"), InputError);
}

TEST(Suite, LevelsInPixelsBecomeSharesOfTheObject) {
  const TempFolder folder;
  const Suite suite = suite_of_text(folder, R"(
parts: [box]
synthesize: {resolution: 400, distance: 4}
axes: [{name: wall, vary: synthesize.blur, levels: [20, 10], pixels: true}]
)");
  const std::vector<BenchLevel> levels = plan_jobs(suite, &suite.axes[0], {});
  // ABC-NEF's camera at 400 px shows a length of 1 at a distance of 4 as 1111.11 / 2 / 4 px.
  EXPECT_NEAR(std::stod(levels[0][0].synthesize.back().second), 20 / 138.889, 1e-4);
  EXPECT_NEAR(object_pixels({{"object-size", "0.5"}, {"resolution", "300"}}), 150, 1e-9);
  EXPECT_NEAR(object_pixels({{"style", "photo"}, {"resolution", "960"}}), 1.15 * 960 / 2.6, 1e-9);
}

TEST(Suite, LevelsOfADropAreNumbersOrTrueAndFalse) {
  EXPECT_EQ(level_number("0.25"), 0.25);
  EXPECT_EQ(level_number("true"), 1);
  EXPECT_EQ(level_number("false"), 0);
  EXPECT_FALSE(level_number("some").has_value());
  EXPECT_FALSE(level_number("").has_value());
  const TempFolder folder;
  const std::string axis = "parts: [box]\naxes: [{name: a, vary: synthesize.masks, levels: ";
  const Suite suite = suite_of_text(folder, axis + "[true, false]}]");
  const std::vector<BenchLevel> levels = plan_jobs(suite, &suite.axes[0], {});
  EXPECT_THAT(flags_of(levels[1][0].synthesize, synthesize_verb().fields),
              testing::Contains("--no-masks"));
  EXPECT_THROW(suite_of_text(folder, axis + "[true, perhaps]}]"), InputError);
}

TEST(Flags, AreWhatAUserWouldType) {
  const std::vector<Field> fields = reconstruct_verb().fields;
  EXPECT_THAT(flags_of({{"preset", "fast"}, {"blends", "true"}, {"param.gap", "0.1"}}, fields),
              ElementsAre("--preset", "fast", "--blends", "--param", "gap=0.1"));
  EXPECT_THAT(flags_of({{"noise", "2"}, {"part", "box"}}, synthesize_verb().fields),
              ElementsAre("box", "--noise", "2"));
}

TEST(Suite, ShippedOnesCanBeReadAndMissingOnesNot) {
  EXPECT_THROW(read_suite("/no/such/suite.yml"), InputError);
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SKETCHSPLAT_SOURCE_DIR "/eval/suites")) {
    EXPECT_NO_THROW(read_suite(entry.path())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 3);
}

struct Bad {
  const char *name, *text, *complaint;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadSuite : public testing::TestWithParam<Bad> {};

TEST_P(BadSuite, IsRefusedInOneLineThatSaysWhereAndWhatIsExpected) {
  const TempFolder folder;
  try {
    suite_of_text(folder, GetParam().text);
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr(GetParam().complaint));
    EXPECT_THAT(e.what(), HasSubstr("some.yml"));
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadSuite,
    testing::Values(
        Bad{"NoYaml", "parts: [box\nfoo: }", "some.yml:2: expected YAML or JSON"},
        Bad{"Empty", "", "expected a mapping with name, scenes"},
        Bad{"List", "[1, 2]", "found a list"},
        Bad{"Nothing", "name: x\n", "expected scenes, parts or axes, found none"},
        Bad{"Typo", "\nprats: [box]\n", "some.yml:2: expected 'parts', found 'prats'"},
        Bad{"NoPartNorFolder", "scenes: [{name: x}]", "either part or folder, found none"},
        Bad{"TextForList", "parts: box", "expected a list, found 'box'"},
        Bad{"TextForNumber", "parts: [box]\nrepeats: many",
            "some.yml:2: expected a number from 1 to 1000, found 'many'"},
        Bad{"HalfARepeat", "parts: [box]\nrepeats: 1.5", "a whole number"},
        Bad{"UnknownPreset", "parts: [box]\npresets: [fastest]", "fastest"},
        Bad{"UnknownOption", "parts: [box]\nsynthesize: {nose: 1}", "unknown option nose"},
        Bad{"OutOfRange", "parts: [box]\nsynthesize: {noise: 1000}", "noise"},
        Bad{"LevelOutOfRange",
            "parts: [box]\naxes: [{name: a, vary: synthesize.noise, levels: [0, -1]}]", "noise"},
        Bad{"LevelNoNumber", "parts: [box]\naxes: [{name: a, vary: synthesize.noise, levels: [x]}]",
            "a number from"},
        Bad{"NoVerb", "parts: [box]\naxes: [{name: a, vary: noise, levels: [1]}]",
            "synthesize.OPTION or reconstruct.OPTION"},
        Bad{"NothingVaried", "parts: [box]\naxes: [{name: a, levels: [1]}]", "the key 'vary'"},
        Bad{"SameNames",
            "parts: [box]\naxes: [{name: a, vary: synthesize.noise, levels: [1]}, "
            "{name: a, vary: synthesize.blur, levels: [1]}]",
            "a name of its own"},
        Bad{"ExponentOfNothing",
            "parts: [box]\n"
            "axes: [{name: a, vary: synthesize.views, levels: [9], report: exponent}]",
            "'against'"},
        Bad{"AxisWithoutScenes", "axes: [{name: a, vary: synthesize.noise, levels: [1]}]",
            "scenes or parts"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace sketchsplat

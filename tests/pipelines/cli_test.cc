// SPDX-License-Identifier: MIT
// The program as its users meet it: a binary, its streams and its exit status.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "pipelines/options/options.h"
#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> verbs_in(const std::string& help) {
  std::vector<std::string> verbs;
  std::istringstream lines(help.substr(help.find("Verbs:\n") + 7));
  std::string line;
  while (std::getline(lines, line) && !line.empty())
    if (std::isalpha(line[2])) verbs.push_back(line.substr(2, line.find(' ', 2) - 2));
  return verbs;
}

TEST_F(Program, TellsItsVersion) {
  const Outcome o = run("--version");
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.out, StartsWith("sketchsplat " SKETCHSPLAT_VERSION "\ncommit "));
  EXPECT_THAT(o.out, AllOf(HasSubstr("Ceres "), HasSubstr("OpenCV "), HasSubstr("g++ ")));
  EXPECT_EQ(o.err, "");
}

TEST_F(Program, HelpBeginsWithExamples) {
  for (const char* arguments :
       {"--help", "-h", "help", "detect --help", "help detect", "-h detect"}) {
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 0) << arguments;
    EXPECT_THAT(o.out, StartsWith("Examples:\n  sketchsplat ")) << arguments;
    EXPECT_EQ(o.err, "") << arguments;
  }
}

TEST_F(Program, EveryExampleInTheHelpOfAVerbParses) {
  const std::regex example("  sketchsplat ([^\n]*)\n");
  for (const std::string& verb : verbs_in(run("--help").out)) {
    const std::string help = run(verb + " --help").out;
    const std::string block = help.substr(0, help.find("\n\n") + 1);
    int found = 0;
    for (std::sregex_iterator it(block.begin(), block.end(), example), end; it != end; ++it) {
      // The folders of the examples do not exist here: anything but wrong usage will do.
      ++found;
      if (verb == "synthesize" || verb == "bench") continue;  // would do their work
      EXPECT_NE(run((*it)[1]).status, kWrongUsage) << (*it)[1];
    }
    EXPECT_GT(found, 0) << verb;
  }
}

TEST_F(Program, HelpListsEveryOptionWithItsDefault) {
  EXPECT_FALSE(verbs_in(run("--help").out).empty());
  CommonOptions common;
  Fields fields;
  list_fields(&common, &fields);
  DetectionOptions detect;
  list_fields(&detect, &fields);
  // Long lines are wrapped.
  const std::string help =
      std::regex_replace(run("detect --help-all").out, std::regex("\\s+"), " ");
  for (const Field& field : fields.list) {
    EXPECT_THAT(help,
                testing::AnyOf(HasSubstr("--" + field.name), HasSubstr("--[no-]" + field.name)));
    EXPECT_THAT(help, HasSubstr(field.help)) << field.name;
    EXPECT_THAT(help, HasSubstr(facts(field))) << field.name;
    if (!field.initial.empty()) EXPECT_THAT(facts(field), HasSubstr("default")) << field.name;
  }
}

TEST_F(Program, HelpOfReconstructFitsOnAPageAndSaysWhereTheRestIs) {
  const std::string some = run("reconstruct --help").out, all = run("reconstruct --help-all").out;
  EXPECT_LE(count_lines(some), 48);
  EXPECT_THAT(some, AllOf(HasSubstr("--preset"), HasSubstr("--threads"), HasSubstr("--scale"),
                          HasSubstr("--min-confidence"), HasSubstr("--help-all shows ")));
  EXPECT_THAT(some, testing::Not(HasSubstr("--lift-views")));
  EXPECT_THAT(all, AllOf(HasSubstr("--lift-views"), HasSubstr("Threads to use")));
}

TEST_F(Program, ReconstructHasAtMostThirtyOptionsOfItsOwn) {
  const std::string page = run("--options-markdown").out;
  EXPECT_LE(count_lines(page.substr(0, page.find("\n\n`sketchsplat batch"))) - 3, 31);
}

TEST_F(Program, AStepIsLeftOutByItsName) {
  const std::string work = "reconstruct " + scene() + " --dry-run --out " + in_folder("dry");
  EXPECT_EQ(run(work + " --without conics,polish --without close").status, 0);
  for (const auto& [given, answer] : std::vector<std::pair<std::string, std::string>>{
           {"--without conic", "--without: expected none or some of silhouettes, conics, "},
           {"--without none,conics", "got 'none'"},
           {"--no-inferred",
            "unknown option --no-inferred, replaced by --without inferred (see "}}) {
    const Outcome o = run(work + " " + given);
    EXPECT_EQ(o.status, kWrongUsage) << given;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
    EXPECT_THAT(o.err, HasSubstr(answer)) << given;
  }
}

TEST_F(Program, ThreadsThatWaitSpinForMicrosecondsUnlessTheUserSaysSo) {
  const std::string program = std::string("'") + SKETCHSPLAT_BINARY + "'";
  const auto spins = [&](const std::string& set) {  // as libgomp says, the last time it is loaded
    const std::string file = in_folder("env");
    std::system(("env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=verbose " + set + " " +
                 program + " --version >/dev/null 2>'" + file + "'")
                    .c_str());
    const std::string text = text_of_file(file), key = "GOMP_SPINCOUNT = '";
    const size_t at = text.rfind(key);
    return at == std::string::npos ? -1.0 : std::stod(text.substr(at + key.size()));
  };
  EXPECT_EQ(spins(""), 2000);
  EXPECT_GT(spins("OMP_WAIT_POLICY=active"), 1e6);
  EXPECT_EQ(spins("GOMP_SPINCOUNT=1234"), 1234);
}

TEST_F(Program, NoLineOfHelpIsWiderThanAPage) {
  for (const std::string& verb : verbs_in(run("--help").out)) {
    std::istringstream lines(run(verb + " --help-all").out);
    std::string line;
    while (std::getline(lines, line)) EXPECT_LE(line.size(), 110u) << line;
  }
}

TEST_F(Program, WrongUsageIsOneSentenceAndStatus2) {
  for (const char* arguments : {"",
                                "detekt",
                                "detekt --help",
                                "help detekt",
                                "--frobnicate",
                                "detect",
                                "detect scene",
                                "detect --out x",
                                "detect scene --out x --frobnicate",
                                "detect scene --out x --ridge",
                                "detect scene --out x --ridge 99",
                                "detect scene --out x --ridge nan",
                                "detect scene --out x --threads many",
                                "detect scene --out x --threads -1",
                                "detect scene another --out x",
                                "detect scene --out ''",
                                "detect '' --out x",
                                "detect scene --out x --format jpeg",
                                "--seed",
                                "--seed 1.5 detect scene --out x"}) {
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, kWrongUsage) << arguments;
    EXPECT_EQ(o.out, "") << arguments;
    EXPECT_EQ(count_lines(o.err), 1) << arguments << "\n" << o.err;
    EXPECT_THAT(o.err, StartsWith("sketchsplat: ")) << arguments;
  }
}

TEST_F(Program, RefusalNamesOptionRangeAndValue) {
  EXPECT_EQ(run("detect scene --out x --ridge 99").err,
            "sketchsplat: --ridge: expected a number from 0.3 to 10 px, got '99'\n");
}

TEST_F(Program, TyposGetAHint) {
  EXPECT_THAT(run("detct").err, HasSubstr("did you mean detect?"));
  EXPECT_THAT(run("detect scene --out x --treads 2").err, HasSubstr("did you mean --threads?"));
}

TEST_F(Program, MissingSceneIsNamedWithStatus3AndNothingIsMade) {
  const Outcome o = run("detect " + in_folder("nowhere") + " --out " + in_folder("result"));
  EXPECT_EQ(o.status, kBadInput);
  EXPECT_EQ(count_lines(o.err), 1) << o.err;
  EXPECT_THAT(o.err, HasSubstr(in_folder("nowhere") + ": expected "));
  EXPECT_EQ(o.out, "");
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(Program, OutputThatCannotBeWrittenIsStatus5) {
  std::ofstream(folder_ / "file") << "x";
  for (const std::string& out :
       {in_folder("file"), in_folder("file") + "/below", std::string("/proc/sketchsplat")}) {
    const Outcome o = run("detect " + scene() + " --out " + out);
    EXPECT_EQ(o.status, kNoOutput) << out;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
    EXPECT_THAT(o.err, HasSubstr(out));
  }
}

TEST_F(Program, StandardOutputThatIsFullIsStatus5) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string command =
      std::string("'") + SKETCHSPLAT_BINARY + "' --help >/dev/full 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), kNoOutput);
}

TEST_F(Program, DetectWritesAMapPerViewWithTheImagesName) {
  const Outcome o = run("detect " + scene() + " -o " + in_folder("result"));
  ASSERT_EQ(o.status, 0) << o.err;
  for (const char* name : {"0_colors.png", "1_colors.png"}) {
    const Image<float> map = read_grey(in_folder("result/edge_image/") + name);
    ASSERT_EQ(map.width, 64);
    ASSERT_EQ(map.height, 48);
    EXPECT_GT(map.at(16, 24), 0.3f) << "the left side of the square";
    EXPECT_EQ(map.at(32, 24), 0) << "its middle";
  }
}

TEST_F(Program, MapsLieOverTheImageWhateverTheLensAndMasksMayComeFromElsewhere) {
  const std::string pictures = scene() + "/color";
  const fs::path model = folder_ / "model";
  fs::create_directories(model / "masks");
  fs::create_directory_symlink(pictures, model / "images");
  std::ofstream(model / "cameras.txt") << "1 SIMPLE_RADIAL 64 48 60 32 24 -0.9\n";
  std::ofstream(model / "images.txt") << "1 1 0 0 0 0 0 3 1 0_colors.png\n\n";
  Image<float> left(64, 48, 0.0f);
  for (int y = 0; y < 48; ++y) std::fill_n(left.row(y), 32, 1.0f);
  write_png((model / "masks/0_colors.png").string(), Image<float>(64, 48, 1.0f));
  fs::create_directories(folder_ / "left");
  write_png(in_folder("left/0_colors.png"), left);
  const std::string map = in_folder("result/edge_image/0_colors.png");
  ASSERT_EQ(run("detect " + model.string() + " -o " + in_folder("result")).status, 0);
  EXPECT_GT(read_grey(map).at(16, 24), 0.3f) << "where the image has it";
  EXPECT_GT(read_grey(map).at(47, 24), 0.3f);
  EXPECT_EQ(read_grey(map).at(32, 24), 0);
  ASSERT_EQ(run("detect " + model.string() + " --masks " + in_folder("left") + " -o " +
                in_folder("result"))
                .status,
            0);
  EXPECT_GT(read_grey(map).at(31, 24), 0.3f) << "the mask ends here";
  EXPECT_EQ(read_grey(map).at(47, 24), 0) << "and this is outside";
  const Outcome o =
      run("detect " + model.string() + " --masks " + pictures + "/none -o " + in_folder("result"));
  EXPECT_EQ(o.status, kBadInput);
  EXPECT_THAT(o.err, HasSubstr("expected a folder of masks, found nothing"));
}

TEST_F(Program, OnlyResultsGoToStandardOutputAndQuietSilencesTheRest) {
  const std::string work = "detect " + scene() + " --out " + in_folder("result");
  const Outcome plain = run(work);
  EXPECT_EQ(plain.out, in_folder("result") + "/edge_image: 2 edge maps\n");
  EXPECT_THAT(plain.err, HasSubstr("detect"));
  EXPECT_THAT(plain.err, Not(HasSubstr("\r"))) << "no bar where there is no terminal";
  for (const std::string& quiet : {work + " --quiet", "-q " + work, "--quiet " + work}) {
    const Outcome o = run(quiet);
    EXPECT_EQ(o.status, 0) << quiet;
    EXPECT_EQ(o.err, "") << quiet;
    EXPECT_EQ(o.out, plain.out) << quiet;
  }
}

TEST_F(Program, MapsAreTheSameForAnyNumberOfThreads) {
  const std::string scene_folder = scene();
  run("detect " + scene_folder + " --threads 1 --out " + in_folder("one"));
  run("detect " + scene_folder + " --threads 3 --out " + in_folder("three"));
  const std::string one = text_of_file(folder_ / "one/edge_image/0_colors.png");
  EXPECT_FALSE(one.empty());
  EXPECT_TRUE(one == text_of_file(folder_ / "three/edge_image/0_colors.png"));
}

TEST_F(Program, OptionsPageShowsTheOptionsAsTheyAre) {
  const std::string page = text_of_file(fs::path(SKETCHSPLAT_SOURCE_DIR) / "OPTIONS.md");
  const std::string now = run("--options-markdown").out;
  EXPECT_TRUE(page.find(now) != std::string::npos) << "./run options writes OPTIONS.md anew";
}

}  // namespace
}  // namespace sketchsplat

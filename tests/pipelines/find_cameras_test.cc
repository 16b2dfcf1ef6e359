// SPDX-License-Identifier: MIT
// Photographs alone, and a script in COLMAP's place that writes down how it was called.
#include "pipelines/cameras/find_cameras.h"

#include <gmock/gmock.h>

#include "datasets/types/errors.h"
#include "pipelines/base/child_lines.h"
#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class FindCameras : public Program {
 protected:
  FindCameras() {
    const char* path = std::getenv("PATH");
    path_ = path ? path : "";
    fs::create_directories(in("bin"));
    setenv("PATH", (in("bin") + ":/usr/bin:/bin").c_str(), 1);
  }
  ~FindCameras() override { setenv("PATH", path_.c_str(), 1); }

  std::string in(const std::string& name) const { return (folder_ / name).string(); }

  void photograph(const std::string& name, int width = 16) const {
    fs::create_directories(fs::path(in("photos/" + name)).parent_path());
    write_png(in("photos/" + name), Image<float>(width, 12, 0.3f));
  }

  // `mapper` is what the script does for that command; $out is the folder for models.
  void install(const std::string& mapper, const std::string& help = "--SiftExtraction.use_gpu") {
    std::ofstream script(in("bin/colmap"));
    script << "#!/bin/sh\n"
           << "echo \"$QT_QPA_PLATFORM $*\" >>'" << in("calls") << "'\n"
           << "command=$1\n"
           << "if [ \"$2\" = --help ]; then echo '" << help << "'; exit 0; fi\n"
           << "while [ $# -gt 0 ]; do\n"
           << "  [ \"$1\" = --output_path ] && out=$2\n"
           << "  [ \"$1\" = --image_list_path ] && cp \"$2\" '" << in("names") << "'\n"
           << "  [ \"$1\" = --match_list_path ] && cp \"$2\" '" << in("pairs") << "'\n"
           << "  shift\ndone\n"
           << "case $command in\n"
           << "  feature_extractor) echo 'Processed file [1/3]' ;;\n"
           << "  mapper) " << mapper << " ;;\n"
           << "esac\n";
    script.close();
    fs::permissions(in("bin/colmap"), fs::perms::owner_all);
  }

  // A model of one image: a.png.
  static std::string writes_a_model() {
    return "echo 'Registering image #1 (1)'; mkdir -p $out/0\n"
           "    echo 1 OPENCV 16 12 20 20 8 6 -0.1 0 0 0 >$out/0/cameras.txt\n"
           "    printf '1 1 0 0 0 0 0 1 1 a.png\\n\\n' >$out/0/images.txt";
  }

  std::vector<std::string> calls() const {
    std::vector<std::string> lines;
    std::ifstream in_file(in("calls"));
    for (std::string line; std::getline(in_file, line);) lines.push_back(line);
    return lines;
  }

  std::string path_;
};

TEST_F(FindCameras, ColmapIsRunStepByStepAndItsModelIsAScene) {
  install(writes_a_model());
  for (const char* name : {"a.png", "b.png", "more/c.png"}) photograph(name);
  std::ofstream(in("photos/notes.txt")) << "no photograph";
  RunReport report;
  find_cameras(in("photos"), {}, in("colmap"), 3, {&report});
  const std::vector<std::string> lines = calls();
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0], "offscreen feature_extractor --help");
  EXPECT_THAT(
      lines[1],
      AllOf(StartsWith("offscreen feature_extractor --database_path " + in("colmap/database.db")),
            HasSubstr("--SiftExtraction.use_gpu 0"), HasSubstr("--SiftExtraction.num_threads 3"),
            HasSubstr("--ImageReader.single_camera 1"),
            HasSubstr("--ImageReader.camera_model OPENCV")));
  EXPECT_THAT(lines[2], AllOf(StartsWith("offscreen exhaustive_matcher"),
                              HasSubstr("--SiftMatching.use_gpu 0")));
  EXPECT_THAT(lines[3], AllOf(StartsWith("offscreen mapper"),
                              HasSubstr("--output_path " + in("colmap/sparse"))));
  EXPECT_EQ(text_of_file(in("names")), "a.png\nb.png\nmore/c.png\n");
  ASSERT_EQ(report.stages.size(), 3u);
  EXPECT_EQ(report.stages[0].name, "colmap features");
  EXPECT_EQ(report.stages[1].result, "all pairs of 3 photographs");
  const Scene scene = open_scene(in("colmap"));
  EXPECT_EQ(scene.format, "colmap");
  ASSERT_EQ(scene.views.size(), 1u);
  EXPECT_EQ(read_picture(scene.views[0]).width(), 16);
  EXPECT_THAT(scene.warnings, ElementsAre("images without a pose: 2 (b.png, more/c.png)"));
}

TEST_F(FindCameras, TheModelIsUsedAgainUntilThePhotographsChange) {
  install(writes_a_model());
  for (const char* name : {"a.png", "b.png", "c.png"}) photograph(name);
  find_cameras(in("photos"), {}, in("colmap"), 0, {});
  const size_t first = calls().size();
  find_cameras(in("photos"), {}, in("colmap"), 0, {});
  EXPECT_EQ(calls().size(), first);
  photograph("d.png");
  find_cameras(in("photos"), {}, in("colmap"), 0, {});
  EXPECT_EQ(calls().size(), 2 * first);
  photograph("b.png", 20);
  find_cameras(in("photos"), {}, in("colmap"), 0, {});
  EXPECT_EQ(calls().size(), 3 * first);
  EXPECT_THAT(calls().at(2 * first + 1),
              AllOf(Not(HasSubstr("single_camera")), HasSubstr("camera_model SIMPLE_RADIAL")))
      << "of two sizes, hence of several cameras";
}

TEST_F(FindCameras, MasksAndResultsBelowThePhotographsAreNone) {
  install(writes_a_model());
  for (const char* name : {"a.png", "b.png", "c.png", "masks/a.png", "out/overlay_a.png"})
    photograph(name);
  find_cameras(in("photos"), {in("photos/out"), in("photos/masks"), "", in("photos")},
               in("photos/out/colmap"), 0, {});
  EXPECT_EQ(text_of_file(in("names")), "a.png\nb.png\nc.png\n");
  const Outcome o =
      run("reconstruct --images '" + in("photos") + "' --out '" + in("photos") + "/'");
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("--out must be another folder than --images"));
}

TEST_F(FindCameras, NewerVersionsNameTheirOptionsOtherwise) {
  install(writes_a_model(), "  --FeatureExtraction.use_gpu arg (=1)");
  for (const char* name : {"a.png", "b.png", "c.png"}) photograph(name);
  find_cameras(in("photos"), {}, in("colmap"), 0, {});
  EXPECT_THAT(calls().at(1), HasSubstr("--FeatureExtraction.use_gpu 0"));
  EXPECT_THAT(calls().at(2), HasSubstr("--FeatureMatching.use_gpu 0"));
}

TEST_F(FindCameras, LargeSetsAreMatchedAlongTheCircleOfTheirNames) {
  install(writes_a_model());
  for (int i = 0; i < 100; ++i) photograph(std::to_string(100 + i) + ".png");
  find_cameras(in("photos"), {}, in("colmap"), 0, {});
  EXPECT_THAT(calls().at(2), AllOf(HasSubstr(" matches_importer "), HasSubstr("--match_type pairs"),
                                   HasSubstr("--SiftMatching.use_gpu 0")));
  const std::string pairs = text_of_file(in("pairs"));
  EXPECT_THAT(pairs, HasSubstr("100.png 101.png\n"));
  EXPECT_THAT(pairs, HasSubstr("100.png 199.png\n")) << "back at the start";
  EXPECT_THAT(pairs, HasSubstr("100.png 148.png\n")) << "from the other side";
  EXPECT_EQ(pairs.find("101.png 100.png"), std::string::npos) << "one way is enough";
  EXPECT_LT(count_lines(pairs), 1100);
  EXPECT_GT(count_lines(pairs), 600);
}

TEST_F(FindCameras, WhatGoesWrongIsOneSentenceWithAWayOut) {
  for (const char* name : {"a.png", "b.png"}) photograph(name);
  install("echo nothing");
  const std::string command =
      "reconstruct --quiet --images '" + in("photos") + "' --out '" + in("result") + "'";
  const auto outcome = [&](int status) {
    const Outcome o = run(command);
    EXPECT_EQ(o.status, status) << o.err;
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
    return o.err;
  };
  EXPECT_THAT(outcome(3), HasSubstr("at least three photographs that can be read, found 2"));
  photograph("c.png");
  EXPECT_THAT(outcome(4), HasSubstr("take more of them"));
  install("exit 1");
  EXPECT_THAT(outcome(4), HasSubstr("colmap.log"));
  install(writes_a_model());
  std::ofstream(in("bin/colmap")) << "#!/bin/sh\necho 'no such option' >&2; exit 7\n";
  EXPECT_THAT(outcome(3), AllOf(HasSubstr("colmap feature_extractor: expected"),
                                HasSubstr("exit status 7 (no such option; ")));
  fs::remove(in("bin/colmap"));
  if (!has_program("colmap")) {
    EXPECT_THAT(outcome(3), HasSubstr("apt-get install colmap"));
  }
}

TEST_F(FindCameras, TheProgramGoesOnWithTheModel) {
  install(writes_a_model());
  for (const char* name : {"a.png", "b.png", "c.png"}) photograph(name);
  const Outcome o = run("reconstruct --images '" + in("photos") + "' --out '" + in("result") + "'");
  EXPECT_EQ(o.status, 4) << "one image is not enough";
  EXPECT_THAT(o.err, AllOf(HasSubstr("colmap features"), HasSubstr("colmap matches"),
                           HasSubstr("colmap cameras"), HasSubstr("images without a pose: 2")));
  EXPECT_TRUE(fs::exists(in("result/colmap/sparse/0/images.txt")));
  const Outcome both = run("reconstruct scene --images photos --out '" + in("result") + "'");
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("SCENE or --images DIR, not both"));
  const Outcome neither = run("reconstruct --out '" + in("result") + "'");
  EXPECT_EQ(neither.status, 2);
  EXPECT_THAT(neither.err, HasSubstr("reconstruct needs SCENE or --images DIR; usage: sketchsplat "
                                     "reconstruct (SCENE | --images DIR) --out DIR"));
}

TEST(RunProgram, HandsOnLinesAndTheStatus) {
  std::vector<std::string> lines;
  const int status =
      run_program("sh", {"-c", "echo a; echo \"it's two\" >&2; printf 'b\\rc'; exit 5"},
                  [&](const std::string& l) { lines.push_back(l); });
  EXPECT_EQ(status, 5);
  EXPECT_THAT(lines, ElementsAre("a", "it's two", "b", "c"));
  EXPECT_EQ(run_program("sh", {"-c", "kill -9 $$"}, [](const std::string&) {}), 137);
  EXPECT_EQ(run_program("/nowhere", {}, [](const std::string&) {}), 127);
  EXPECT_TRUE(has_program("sh"));
  EXPECT_FALSE(has_program("no such program"));
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/base/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "datasets/types/errors.h"
#include "pipelines/base/run_report.h"

namespace sketchsplat {
namespace {

using testing::HasSubstr;
using testing::internal::CaptureStderr;
using testing::internal::GetCapturedStderr;

std::string spoken(Progress::Mode mode, bool verbose) {
  CaptureStderr();
  Progress progress(mode, verbose);
  progress.begin("detect", 3);
  progress.step();
  progress.note("a detail");
  progress.warn("view 21 is broken");
  progress.end("3 maps");
  return GetCapturedStderr();
}

TEST(Progress, SilentSaysNothing) { EXPECT_EQ(spoken(Progress::Mode::kSilent, true), ""); }

TEST(Progress, LinesAreOnePerStageAndWarning) {
  const std::string text = spoken(Progress::Mode::kLines, false);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_THAT(text, HasSubstr("warning: view 21 is broken\n"));
  EXPECT_THAT(text, HasSubstr("3 maps\n"));
  EXPECT_THAT(text, Not(HasSubstr("\r"))) << "no terminal, no cursor tricks";
  EXPECT_THAT(text, Not(HasSubstr("a detail")));
  EXPECT_THAT(spoken(Progress::Mode::kLines, true), HasSubstr("a detail\n"));
}

TEST(Progress, BarIsWipedBeforeAnyLine) {
  const std::string text = spoken(Progress::Mode::kBar, false);
  EXPECT_THAT(text, HasSubstr("[..............................] 0/3"));
  EXPECT_THAT(text, HasSubstr("\r\033[Kwarning: "));
}

TEST(Progress, MoreStepsThanAnnouncedDoNotOverflowTheBar) {
  CaptureStderr();
  Progress progress(Progress::Mode::kBar);
  progress.begin("sweep", 2);
  for (int i = 0; i < 5; ++i) progress.step();
  progress.begin("next", -1);
  progress.end();
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("sweep"));
}

TEST(Progress, BarTellsTheTimeLeftByTheShareOfTheWork) {
  CaptureStderr();
  Progress progress(Progress::Mode::kBar);
  progress.begin("batch", 100);
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  progress.step();  // one scene, but a long one
  progress.share(0.5);
  std::this_thread::sleep_for(std::chrono::milliseconds(110));
  progress.step();
  EXPECT_THAT(GetCapturedStderr(),
              testing::AnyOf(HasSubstr("2/100, 3 s left"), HasSubstr("2/100, 4 s left")));
}

TEST(Progress, DurationsAreRough) {
  EXPECT_EQ(rough_duration(0.2), "1 s");
  EXPECT_EQ(rough_duration(59.4), "60 s");
  EXPECT_EQ(rough_duration(59.6), "1 min");
  EXPECT_EQ(rough_duration(12 * 60 + 20), "12 min");
  EXPECT_EQ(rough_duration(3600), "1 h");
  EXPECT_EQ(rough_duration(3600 * 3 + 1200), "3 h 20 min");
  EXPECT_EQ(rough_duration(3600 * 52), "2 d 4 h");
}

TEST(Progress, WarningsComeAgainAtTheEndUnlessNothingCameBetween) {
  CaptureStderr();
  {
    Progress progress(Progress::Mode::kLines);
    progress.warn("view 21 is broken");
    progress.repeat_warnings();
    EXPECT_EQ(GetCapturedStderr(), "warning: view 21 is broken\n");
    CaptureStderr();
    progress.begin("detect", 1);
    progress.end();
    progress.repeat_warnings();
  }
  const std::string text = GetCapturedStderr();
  EXPECT_EQ(text.substr(text.find('\n') + 1), "warning: view 21 is broken\n");
}

TEST(Progress, LogHasEveryLineWithTheTimeEvenIfSilent) {
  const std::string path = testing::TempDir() + "progress." + std::to_string(getpid()) + ".log";
  for (int run = 0; run < 2; ++run) {
    Progress progress(Progress::Mode::kSilent);
    progress.log_to(path);
    progress.begin("detect", 1);
    progress.warn("view 21 is broken");
    progress.end("3 maps");
  }
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::remove(path.c_str());
  ASSERT_EQ(lines.size(), 4u) << "of two runs";
  EXPECT_THAT(lines[0], testing::MatchesRegex("20..-..-..T..:..:.. warning: view 21 is broken"));
  EXPECT_THAT(lines[1], HasSubstr("3 maps"));
  EXPECT_THROW(Progress(Progress::Mode::kSilent).log_to("/proc/none/log"), OutputError);
}

TEST(Progress, ColourIsForWarningsAndOnlyWhereItIsWanted) {
  CaptureStderr();
  Progress progress(Progress::Mode::kLines);
  progress.use_color(true);
  progress.warn("x");
  progress.info("y");
  EXPECT_EQ(GetCapturedStderr(), "\033[33mwarning:\033[0m x\ny\n");
}

TEST(Stage, RecordsNameResultAndCosts) {
  RunReport report;
  {
    Stage stage("lift", {&report}, 2);
    stage.step();
    stage.result("12 points");
  }
  ASSERT_EQ(report.stages.size(), 1u);
  EXPECT_EQ(report.stages[0].name, "lift");
  EXPECT_EQ(report.stages[0].result, "12 points");
  EXPECT_GE(report.stages[0].seconds, 0);
  EXPECT_GT(report.stages[0].peak_mb, 1) << "this very test holds more than a megabyte";
}

TEST(Stage, ReportAndProgressMayBeMissing) {
  Stage stage("lift", {});
  stage.step();
  RunLog().warn("nobody hears it");
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "pipelines/run_report.h"

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

TEST(Stage, RecordsNameResultAndCosts) {
  RunReport report;
  {
    Stage stage("lift", 2, &report, nullptr);
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
  Stage stage("lift", 0, nullptr, nullptr);
  stage.step();
  warn("nobody hears it", nullptr, nullptr);
}

}  // namespace
}  // namespace sketchsplat

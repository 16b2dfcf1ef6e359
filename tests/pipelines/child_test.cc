// SPDX-License-Identifier: MIT
// The program that a child runs is this one: tests that are off play its part.
#include "pipelines/base/child.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "tests/support/sanitizer.h"

namespace sketchsplat {
namespace {

TEST(Part, DISABLED_Complains) {
  std::fprintf(stderr, "first\nsketchsplat: x: expected a, found b\n\n");
  std::fflush(stderr);
  _exit(3);
}
TEST(Part, DISABLED_Crashes) {
  std::signal(SIGSEGV, SIG_DFL);
  std::raise(SIGSEGV);
}
TEST(Part, DISABLED_NeverEnds) {
  for (;;) pause();
}
TEST(Part, DISABLED_LeavesSomebodyBehind) {
  if (fork() == 0)
    for (;;) pause();
  _exit(0);
}
TEST(Part, DISABLED_TakesMuchMemory) {
  try {
    std::vector<char> much(size_t(3e9), 1);
    _exit(much[12345] == 1 ? 0 : 1);
  } catch (const std::bad_alloc&) {
    _exit(7);
  }
}
TEST(Part, DISABLED_IsWell) { _exit(0); }

class ChildTest : public testing::Test {
 protected:
  std::vector<std::string> part(const std::string& name) const {
    return {"--gtest_also_run_disabled_tests", "--gtest_filter=Part.DISABLED_" + name};
  }
  ~ChildTest() override { std::remove(log_.c_str()); }
  const std::string log_ = testing::TempDir() + "child." + std::to_string(getpid()) + ".log";
};

TEST_F(ChildTest, TellsStatusAndLastWordsAndKeepsTheLog) {
  const ChildResult r = run_self(part("Complains"), log_, 60);
  EXPECT_EQ(r.status, 3);
  EXPECT_EQ(r.last_words, "sketchsplat: x: expected a, found b");
  EXPECT_EQ(reason_of(r, 60), "x: expected a, found b");
  EXPECT_TRUE(std::filesystem::exists(log_));
  EXPECT_EQ(run_self(part("IsWell"), log_, 60).status, 0);
  EXPECT_FALSE(std::filesystem::exists(log_));
}

TEST_F(ChildTest, NamesTheSignalThatEndedIt) {
  const ChildResult r = run_self(part("Crashes"), log_, 60);
  EXPECT_EQ(r.status, 128 + SIGSEGV);
  EXPECT_EQ(reason_of(r, 60), "ended by signal 11 (SIGSEGV)");
}

TEST_F(ChildTest, IsEndedIfItTakesTooLong) {
  const ChildResult r = run_self(part("NeverEnds"), log_, 0.2);
  EXPECT_TRUE(r.timed_out);
  EXPECT_GE(r.seconds, 0.2);
  EXPECT_LT(r.seconds, 30);
  EXPECT_EQ(reason_of(r, 0.2), "took longer than 0.2 s");
}

TEST_F(ChildTest, TakesWhatItStartedWithIt) {
  Child child(part("LeavesSomebodyBehind"), log_);
  const pid_t group = child.pid();
  child.wait();
  for (int i = 0; i < 500 && kill(-group, 0) == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_NE(kill(-group, 0), 0) << "somebody of its group still lives";
}

TEST_F(ChildTest, DiesWithItsObject) {
  pid_t pid = 0;
  {
    Child child(part("NeverEnds"), log_);
    pid = child.pid();
    EXPECT_FALSE(child.ended());
    EXPECT_FALSE(child.wait_for(0.05));
  }
  EXPECT_NE(kill(pid, 0), 0);
}

TEST_F(ChildTest, ItsMemoryCanBeLimited) {
  if (test::kSanitized) GTEST_SKIP() << "it takes all addresses";
  Child limited(part("TakesMuchMemory"), log_, 2000);
  limited.wait();
  EXPECT_EQ(limited.result().status, 7);
}

TEST_F(ChildTest, IsWhomTheKernelEndsFirst) {
  Child child(part("NeverEnds"), log_);
  std::string score;
  for (int i = 0; i < 500 && score != "500"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::ifstream("/proc/" + std::to_string(child.pid()) + "/oom_score_adj") >> score;
  }
  EXPECT_EQ(score, "500");
}

}  // namespace
}  // namespace sketchsplat

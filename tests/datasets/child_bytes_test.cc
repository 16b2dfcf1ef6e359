// SPDX-License-Identifier: MIT
#include "datasets/step/child_bytes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <new>
#include <stdexcept>
#include <string>

namespace sketchsplat {
namespace {

TEST(ChildBytes, EverythingThatIsSaidArrives) {
  const std::string said(3'000'001, '\xff');
  const ChildBytes out = run_in_child([&] { return said; }, 60);
  EXPECT_EQ(out.bytes, said);
  EXPECT_EQ(out.exit_status, 0);
  EXPECT_EQ(out.signal, 0);
}

TEST(ChildBytes, WhatTheChildDoesStaysThere) {
  int number = 1;
  const ChildBytes out = run_in_child([&] { return std::to_string(++number); }, 60);
  EXPECT_EQ(out.bytes, "2");
  EXPECT_EQ(number, 1);
}

TEST(ChildBytes, ACrashIsASignalAndNothingMore) {
  const ChildBytes out = run_in_child(
      []() -> std::string {
        raise(SIGSEGV);
        return "never";
      },
      60);
  EXPECT_EQ(out.signal, SIGSEGV);
  EXPECT_EQ(out.bytes, "");
}

TEST(ChildBytes, ALoopWithoutEndIsStopped) {
  const ChildBytes out = run_in_child(
      []() -> std::string {
        for (volatile unsigned n = 0;; n = n + 1) {
        }
      },
      1);
  EXPECT_TRUE(out.signal == SIGXCPU || out.signal == SIGKILL) << out.signal;
}

TEST(ChildBytes, ExceptionsAreExitStatuses) {
  const auto threw = run_in_child([]() -> std::string { throw std::runtime_error("no"); }, 60);
  EXPECT_EQ(threw.exit_status, 1);
  EXPECT_EQ(threw.bytes, "");
  const auto full = run_in_child([]() -> std::string { throw std::bad_alloc(); }, 60);
  EXPECT_EQ(full.exit_status, 2);
}

TEST(ChildBytes, InAChildWorkRunsInPlaceAndItsExceptionsAreTheSame) {
  const ChildBytes out = run_in_child(
      [] {
        const pid_t child = getpid();
        pid_t inner = 0;
        const auto said = run_in_child([&] { return std::to_string(inner = getpid()); }, 60);
        const auto threw = run_in_child([]() -> std::string { throw std::bad_alloc(); }, 60);
        return said.bytes == std::to_string(child) && inner == child &&
                       threw.exit_status == ChildBytes::kNoMemory
                   ? "in place"
                   : "elsewhere";
      },
      60);
  EXPECT_EQ(out.bytes, "in place");
}

}  // namespace
}  // namespace sketchsplat

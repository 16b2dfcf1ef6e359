// SPDX-License-Identifier: MIT
#include "datasets/io/exr_header.h"

#include <gtest/gtest.h>

namespace sketchsplat {
namespace {

using namespace std::string_literals;

std::string head_of(char flags) { return "v/1\1\2"s + flags + "\0\0"s; }
std::string attribute(const std::string& size, const std::string& value) {
  return "name\0string\0"s + size + value;
}
bool believable(const std::string& file) { return exr_sizes_are_believable(file, file.size()); }

const std::string kEnd(1, '\0'), kThree = attribute("\3\0\0\0"s, "abc");
const std::string kTwoGigabytes = attribute("\xff\xff\xff\x7f", "abc");

TEST(ExrHeader, ClaimsNoMoreThanTheFileHas) {
  EXPECT_TRUE(believable(head_of(0) + kThree + kThree + kEnd + "pixels"));
  EXPECT_FALSE(believable(head_of(0) + kTwoGigabytes + kEnd));
  EXPECT_FALSE(believable(head_of(0) + kThree + kTwoGigabytes + kEnd));
  EXPECT_FALSE(believable(head_of(0) + attribute("\xff\xff\xff\xff", "abc") + kEnd));
}

TEST(ExrHeader, OfEveryPartCounts) {
  const char several = 1 << 4;  // bit 12
  EXPECT_TRUE(believable(head_of(several) + kThree + kEnd + kThree + kEnd + kEnd));
  EXPECT_FALSE(believable(head_of(several) + kThree + kEnd + kTwoGigabytes + kEnd + kEnd));
  EXPECT_TRUE(believable(head_of(0) + kThree + kEnd + kTwoGigabytes)) << "these are pixels";
}

TEST(ExrHeader, WhatEndsBeforeItOrIsNoneIsLeftToTheLibrary) {
  const std::string whole = head_of(0) + kThree + kEnd;
  for (size_t n = 0; n <= whole.size(); ++n)
    EXPECT_TRUE(exr_sizes_are_believable(whole.substr(0, n), whole.size())) << n;
  EXPECT_TRUE(believable("II*" + kTwoGigabytes));
}

}  // namespace
}  // namespace sketchsplat

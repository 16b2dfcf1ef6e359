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

// The library reads these by their contents: what comes after would be read from elsewhere.
TEST(ExrHeader, ValuesAreAsLongAsTheirTypesAre) {
  const auto value = [](const std::string& type, const std::string& bytes) {
    return head_of(0) + "name\0"s + type + '\0' + char(bytes.size()) + "\0\0\0"s + bytes + kEnd;
  };
  const std::string kChannel = "R\0"s + std::string(16, '\1');
  EXPECT_TRUE(believable(value("chlist", kChannel + kChannel + kEnd)));
  EXPECT_FALSE(believable(value("chlist", kChannel + kChannel)));
  EXPECT_FALSE(believable(value("chlist", kChannel + kEnd + kEnd)));
  EXPECT_FALSE(believable(value("chlist", kChannel.substr(0, 9))));
  EXPECT_FALSE(believable(value("chlist", "")));
  EXPECT_TRUE(believable(value("box2i", std::string(16, '\0'))));
  EXPECT_FALSE(believable(value("box2i", std::string(15, '\0'))));
  EXPECT_TRUE(believable(value("stringvector", "\2\0\0\0ab\0\0\0\0"s)));
  EXPECT_FALSE(believable(value("stringvector", "\2\0\0\0ab\1\0\0\0"s)));
  EXPECT_FALSE(believable(value("stringvector", "\2\0\0"s)));
  EXPECT_TRUE(believable(value("preview", "\1\0\0\0\1\0\0\0abcd"s)));
  EXPECT_FALSE(believable(value("preview",
                                "\1\0\0\0\1\0\0\x40"
                                "abcd"s)));
  EXPECT_FALSE(believable(value("preview", "\0\0\0\x80\0\0\0\x80"s))) << "2^64 bytes";
  EXPECT_TRUE(believable(value("of the future", "abc")));
}

std::string packed(char codec) { return "compression\0compression\0\1\0\0\0"s + codec; }
std::string window(const std::string& corner) {
  return "dataWindow\0box2i\0\x10\0\0\0"s + std::string(8, '\0') + corner;
}
const std::string kWide = "\xff\xff\1\0\0\0\0\0"s;  // 131072 x 1

TEST(ExrHeader, ClaimsNoMorePixelsThanTheFileCanHold) {
  const std::string head = head_of(0) + packed(0);
  EXPECT_TRUE(believable(head + window("\xff\3\0\0\xff\0\0\0"s) + kEnd)) << "1024 x 256";
  EXPECT_FALSE(believable(head + window("\xff\3\0\0\xff\xff\0\0"s) + kEnd)) << "1024 x 65536";
  EXPECT_FALSE(believable(head + window("\xff\xff\xff\x7f\0\0\0\0"s) + kEnd)) << "2^31 x 1";
  EXPECT_TRUE(believable(head + window("\xff\xff\xff\xff\1\0\0\0"s) + kEnd))
      << "none: left to the library";
}

TEST(ExrHeader, CodecsTakeMemoryForAllTheLinesThatTheyPackTogether) {
  const char none = 0, dwab = 9;
  EXPECT_TRUE(believable(head_of(0) + packed(none) + window(kWide) + kEnd));
  EXPECT_FALSE(believable(head_of(0) + packed(dwab) + window(kWide) + kEnd));
  EXPECT_FALSE(exr_sizes_are_believable(head_of(0) + packed(none) + window(kWide) + kEnd, 90, 100));
}

TEST(ExrHeader, WhatEndsBeforeItOrIsNoneIsLeftToTheLibrary) {
  const std::string whole = head_of(0) + kThree + kEnd;
  for (size_t n = 0; n <= whole.size(); ++n)
    EXPECT_TRUE(exr_sizes_are_believable(whole.substr(0, n), whole.size())) << n;
  EXPECT_TRUE(believable("II*" + kTwoGigabytes));
}

}  // namespace
}  // namespace sketchsplat

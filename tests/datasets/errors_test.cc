// SPDX-License-Identifier: MIT
#include "datasets/types/errors.h"

#include <gtest/gtest.h>

namespace sketchsplat {
namespace {

TEST(Errors, StayOnOneLineWhateverNamesHold) {
  const InputError e("a\nb", "a camera of \x1b[31mred\r\n.png", "unknown escape character: \n");
  EXPECT_STREQ(e.what(),
               "a b: expected a camera of  [31mred  .png, found unknown escape character:  ");
  EXPECT_STREQ(OutputError("a\nb", "c\td").what(), "a b: expected a place to write, found c d");
}

TEST(Errors, AreAsLongAsPeopleRead) {
  const std::string what = InputError("a", "b", std::string(5000, 'x')).what();
  EXPECT_LT(what.size(), 900u);
  EXPECT_EQ(what.substr(what.size() - 4), "x...");
}

TEST(Errors, KeepAndDoNotCutLettersOfUtf8) {
  std::string umlauts;
  for (int i = 0; i < 500; ++i) umlauts += "\xc3\xa4";
  EXPECT_EQ(short_line("x" + umlauts), "x" + umlauts.substr(0, 798) + "...");
  EXPECT_EQ(one_line("gr\xc3\xbc\xc3\x9f"), "gr\xc3\xbc\xc3\x9f");
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// A small good scene, damaged in one place: the program ends with this status and says this one
// line. Everything runs in this process; nothing may end it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "pipelines/command/cli.h"
#include "tests/pipelines/bad_scenes.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using namespace test;

std::vector<BadScene> all() {
  std::vector<BadScene> rows;
  for (const auto& some : {bad_scene_files(), bad_transforms(), bad_colmap_files(), bad_images(),
                           bad_edges()})
    rows.insert(rows.end(), some.begin(), some.end());
  return rows;
}

int run(const std::string& command, const std::string& folder, std::string* said) {
  std::vector<std::string> words = {"sketchsplat"};
  std::istringstream in(replaced(command, "{}", folder, true));
  for (std::string word; in >> word;) words.push_back(word);
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int status = run_command_line(int(argv.size()), argv.data(), all_verbs());
  testing::internal::GetCapturedStdout();
  *said = testing::internal::GetCapturedStderr();
  return status;
}

/// Lines that begin so.
std::vector<std::string> lines_of(const std::string& said, const std::string& begin) {
  std::vector<std::string> lines;
  std::istringstream in(said);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(begin, 0) == 0) lines.push_back(line);
  return lines;
}
std::vector<std::string> errors(const std::string& said) { return lines_of(said, "sketchsplat: "); }
std::vector<std::string> warnings(const std::string& said) { return lines_of(said, "warning: "); }

class BadScenes : public testing::TestWithParam<BadScene> {};

TEST_P(BadScenes, GetOneLine) {
  const BadScene& row = GetParam();
  const TempFolder temporary;
  const std::string folder = temporary.path() + "/scene";
  write_small_scene(folder, row.format);
  row.damage(folder);
  std::string said;
  EXPECT_EQ(run(row.command, folder, &said), row.status) << said;
  const std::vector<std::string> lines = row.status == 0 ? warnings(said) : errors(said);
  EXPECT_EQ(errors(said).size(), row.status == 0 ? 0u : 1u) << said;
  ASSERT_FALSE(lines.empty()) << said;
  EXPECT_TRUE(std::regex_search(lines[0], std::regex(row.line))) << lines[0];
  for (const std::string& line : lines) {
    EXPECT_LT(line.size(), 600u);
    EXPECT_EQ(line, lines[0]) << "one thing is wrong, not two";
  }
}

INSTANTIATE_TEST_SUITE_P(Table, BadScenes, testing::ValuesIn(all()),
                         [](const auto& info) { return info.param.name; });

class GoodScenes : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(GoodScenes, AreReadWithoutAWord) {
  const TempFolder temporary;
  test::write_small_scene(temporary.path(), GetParam().first);
  std::string said;
  EXPECT_EQ(run(GetParam().second, temporary.path(), &said), 0) << said;
  EXPECT_TRUE(errors(said).empty() && warnings(said).empty()) << said;
}

INSTANTIATE_TEST_SUITE_P(
    Table, GoodScenes,
    testing::Values(std::pair("abc-nef", kOpen), std::pair("nerf", kOpen),
                    std::pair("nerfstudio", kOpen), std::pair("colmap-text", kOpen),
                    std::pair("colmap-binary", kOpen), std::pair("abc-nef", kDetect),
                    std::pair("nerfstudio", kMasks), std::pair("edges", kSketch),
                    std::pair("edges", kEmap), std::pair("edges", kNef), std::pair("edges", kPly),
                    std::pair("edges", kObj), std::pair("edges", kAbc)));

TEST(Outside, LinksOfTheFolderMayLeadOutAndNamesMayNot) {
  const TempFolder temporary;
  const std::string folder = temporary.path() + "/scene",
                    photographs = temporary.path() + "/photos";
  test::write_small_scene(folder, "colmap-text");
  fs::rename(folder + "/images", photographs);
  fs::create_symlink(photographs, folder + "/images");
  std::string said;
  EXPECT_EQ(run(kOpen, folder, &said), 0);
  EXPECT_TRUE(warnings(said).empty()) << said;
  const std::string list = folder + "/sparse/0/images.txt";
  write_file(list, replaced(bytes_of(list), "0.png", "../../photos/0.png", false));
  EXPECT_EQ(run(kOpen, folder, &said), 0);
  EXPECT_THAT(said, testing::HasSubstr("../../photos/0.png is left out: its image lies outside"));
  EXPECT_EQ(run(kOutside, folder, &said), 0);
  EXPECT_THAT(warnings(said), testing::Each(testing::Not(testing::HasSubstr("outside"))));
}

}  // namespace
}  // namespace sketchsplat

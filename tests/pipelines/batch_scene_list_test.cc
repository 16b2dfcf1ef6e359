// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "datasets/io/image_io.h"
#include "datasets/types/errors.h"
#include "pipelines/base/fields.h"
#include "pipelines/batch/scene_input.h"
#include "pipelines/batch/scene_list.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SceneList : public testing::Test {
 protected:
  void scene(const std::string& name) { folder_.write(name + "/meta_data.json", "{}"); }
  std::string path(const std::string& name) const { return folder_.path() + "/" + name; }

  std::vector<std::string> names(const SceneSearch& search) {
    std::vector<std::string> all;
    warnings_.clear();
    for (const BatchScene& s : find_scene_folders(search, &warnings_)) all.push_back(s.name);
    return all;
  }

  TempFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(SceneList, ScenesAreFoundAtAnyDepthButNotInOneAnotherNorInHiddenFoldersNorInTheOutput) {
  for (const char* name : {"b", "a/deep/one", "a/deep/two", "b/inner", ".git/c", "out/d"})
    scene(name);
  folder_.write("e/notes.txt", "no scene");
  const SceneSearch search = {{folder_.path()}, {}, {}, "", path("out")};
  EXPECT_THAT(names(search), ElementsAre("a/deep/one", "a/deep/two", "b"));
  EXPECT_THAT(warnings_, IsEmpty());
  std::vector<std::string> none;
  EXPECT_EQ(find_scene_folders(search, &none)[2].folder, path("b"));
}

TEST_F(SceneList, NamesAreApartAndDoNotDependOnHowRootsAreSpelled) {
  scene("x/a"), scene("y/a"), scene("y/b");
  for (const std::string& root : {path("x"), path("x/"), path("x/."), path("y/../x")})
    EXPECT_THAT(names({{root}, {}, {}, "", ""}), ElementsAre("a")) << root;
  EXPECT_THAT(names({{path("x"), path("y")}, {}, {}, "", ""}), ElementsAre("x/a", "y/a", "y/b"));
  EXPECT_THAT(names({{path("y/a"), path("y/b")}, {}, {}, "", ""}), ElementsAre("a", "b"))
      << "as a shell makes of y/*";
  EXPECT_THAT(names({{path("y/a")}, {}, {}, "", ""}), ElementsAre("a"));
  EXPECT_THAT(names({{path("y"), path("y/a")}, {}, {}, "", ""}), ElementsAre("y/a", "y/b"))
      << "each once";
}

TEST_F(SceneList, LinksAreFollowedButNotInCircles) {
  scene("x/a");
  fs::create_directory_symlink(path("x"), path("x/loop"));
  scene("elsewhere/b");
  fs::create_directory_symlink(path("elsewhere"), path("x/link"));
  EXPECT_THAT(names({{path("x")}, {}, {}, "", ""}), ElementsAre("a", "link/b"));
}

TEST_F(SceneList, GlobsMatchNamesOrTheirLastParts) {
  scene("x/00000952"), scene("x/00001206"), scene("y/00000952");
  const auto with = [&](std::vector<std::string> globs) {
    return names({{folder_.path()}, {}, globs, "", ""});
  };
  EXPECT_THAT(with({"0000095?"}), ElementsAre("x/00000952", "y/00000952"));
  EXPECT_THAT(with({"x/*"}), ElementsAre("x/00000952", "x/00001206"));
  EXPECT_THAT(with({"y/*", "*1206"}), ElementsAre("x/00001206", "y/00000952"));
  EXPECT_THROW(with({"z*"}), InputError);
}

TEST_F(SceneList, AListNamesScenesWhetherTheyAreThereOrNot) {
  scene("x/a");
  const std::string file = folder_.write(
      "list", "# two\n" + path("x/a") + "/\r\n\n" + path("x/gone") + "\n" + path("x/a") + "\n");
  const std::vector<std::string> list = read_scene_list(file);
  EXPECT_EQ(list.size(), 3u);
  EXPECT_THAT(names({{}, list, {}, "", ""}), ElementsAre("a", "gone"));
  EXPECT_THROW(read_scene_list(path("no list")), InputError);
  EXPECT_THROW(read_scene_list(folder_.write("empty", "# nothing\n")), InputError);
}

TEST_F(SceneList, WhatWouldOverwriteOrNestIsRefused) {
  scene("x/a"), scene("x/a/inner"), scene("x/.batch");
  EXPECT_THROW(names({{path("x")}, {}, {}, "", path("x")}), UsageError) << "a onto itself";
  EXPECT_THROW(names({{path("x/a"), path("x/a/inner")}, {}, {}, "", ""}), UsageError);
  EXPECT_THROW(names({{path("x/a"), path("x/.batch")}, {}, {}, "", ""}), UsageError);
  EXPECT_THROW(names({{path("nothing")}, {}, {}, "", ""}), InputError);
  EXPECT_THROW(names({{folder_.write("file", "")}, {}, {}, "", ""}), InputError);
  fs::create_directory(path("empty"));
  EXPECT_THROW(names({{path("empty")}, {}, {}, "", ""}), InputError);
}

TEST_F(SceneList, TheFormatDecidesWhatIsAScene) {
  scene("abc");
  folder_.write("nerf/transforms_train.json", "{}");
  EXPECT_THAT(names({{folder_.path()}, {}, {}, "nerf", ""}), ElementsAre("nerf"));
}

TEST(Shards, HoldEverySceneOnceAndAboutEquallyMany) {
  std::vector<int> sizes(4);
  for (int i = 0; i < 1000; ++i) {
    int owners = 0;
    for (int shard = 1; shard <= 4; ++shard)
      if (in_shard("scene" + std::to_string(i), shard, 4)) ++owners, ++sizes[shard - 1];
    EXPECT_EQ(owners, 1);
  }
  for (const int size : sizes) EXPECT_NEAR(size, 250, 60);
  EXPECT_TRUE(in_shard("x", 1, 1));
}

TEST(InputHash, ChangesWithPosesNamesAndSizesButNotWithTheFolder) {
  const TempFolder folder;
  const auto make = [&](const std::string& name) {
    folder.write(name + "/meta_data.json", "{1}");
    folder.write(name + "/color/0.png", "abc");
    return input_hash(folder.path() + "/" + name);
  };
  const std::string first = make("a");
  EXPECT_EQ(make("b"), first);
  folder.write("b/meta_data.json", "{2}");
  EXPECT_NE(input_hash(folder.path() + "/b"), first) << "same sizes";
  make("b");
  folder.write("b/sparse/0/images.bin", "1");
  const std::string colmap = input_hash(folder.path() + "/b");
  folder.write("b/sparse/0/images.bin", "2");
  EXPECT_NE(input_hash(folder.path() + "/b"), colmap) << "cameras of COLMAP";
  fs::remove_all(folder.path() + "/b/sparse");
  folder.write("b/color/1.png", "");
  EXPECT_NE(input_hash(folder.path() + "/b"), first);
  fs::remove(folder.path() + "/b/color/1.png");
  EXPECT_EQ(input_hash(folder.path() + "/b"), first);
  EXPECT_EQ(input_hash(folder.path() + "/none"), "");
}

TEST(SceneSize, IsThatOfTheHeadersAndNothingOfABrokenScene) {
  const TempFolder folder;
  std::string frames;
  for (const char* file : {"0.png", "1.png"}) {
    write_png(folder.file(std::string("two/color/") + file), Image<float>(8, 6, 0.5f));
    frames += std::string(frames.empty() ? "" : ",") + R"({"rgb_path": ")" + file +
              R"(", "camtoworld": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]],)"
              R"( "intrinsics": [[9,0,4],[0,9,3],[0,0,1]]})";
  }
  folder.write("two/meta_data.json", R"({"frames": [)" + frames + "]}");
  folder.write("broken/meta_data.json", "{");
  EXPECT_EQ(scene_size(folder.path() + "/two", {}).views, 2);
  EXPECT_EQ(scene_size(folder.path() + "/two", {}).pixels, 2 * 8 * 6);
  EXPECT_EQ(scene_size(folder.path() + "/broken", {}).views, 0);
  EXPECT_EQ(scene_size(folder.path() + "/gone", {}).views, 0);
}

}  // namespace
}  // namespace sketchsplat

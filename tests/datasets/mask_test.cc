// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Picture grey(int width, int height, float value) {
  Picture p;
  p.red = p.green = p.blue = Image<float>(width, height, value);
  return p;
}

// Two views, of which the second image has alpha.
struct Masks : testing::Test {
  Masks() {
    write_png(folder.file("images/a.png"), grey(8, 6, 0.4f));
    Picture clear = grey(8, 6, 0.4f);
    clear.alpha = Image<float>(8, 6, 0.2f);
    clear.alpha.at(3, 3) = 1;
    write_png(folder.file("images/sub/b.png"), clear);
    folder.write("sparse/0/cameras.txt", "1 PINHOLE 8 6 9 9 4 3\n");
    folder.write("sparse/0/images.txt",
                 "1 1 0 0 0 0 0 1 1 a.png\n\n2 1 0 0 0 0 0 2 1 sub/b.png\n\n");
  }
  void write_mask(const std::string& name, float corner, int width = 8) const {
    Image<float> mask(width, 6, 1.0f);
    mask.at(0, 0) = corner;
    write_png(folder.file(name), mask);
  }
  std::string complaint(const View& view) const {
    try {
      read_picture(view);
    } catch (const InputError& e) {
      return std::string(e.what()).substr(folder.path().size());
    }
    return "";
  }
  TempFolder folder;
};

TEST_F(Masks, FillTheAlphaOfPicturesThatHaveNoneAndStaySoft) {
  write_mask("masks/a.png", 0.4f);
  write_mask("masks/sub/b.png", 0.6f);
  const Scene scene = open_scene(folder.path());
  const Picture a = read_picture(scene.views[0]), b = read_picture(scene.views[1]);
  EXPECT_NEAR(a.alpha.at(0, 0), 0.4, 1e-6);
  EXPECT_EQ(a.alpha.at(1, 0), 1);
  EXPECT_NEAR(a.red.at(0, 0), 0.4, 1e-6) << "colours are left alone";
  EXPECT_NEAR(b.alpha.at(0, 0), 0.2, 1e-6) << "alpha comes first";
}

TEST_F(Masks, AlphaThatIsOpaqueEverywhereIsNoMask) {
  Picture opaque = grey(8, 6, 0.4f);
  opaque.alpha = Image<float>(8, 6, 1.0f);
  write_png(folder.file("images/sub/b.png"), opaque);
  write_mask("masks/sub/b.png", 0);
  EXPECT_EQ(read_picture(open_scene(folder.path()).views[1]).alpha.at(0, 0), 0);
}

TEST_F(Masks, FromAnotherFolderComeBeforeAlphaAndBeforeTheScenes) {
  write_mask("masks/a.png", 0);
  write_mask("other/a.png", 0.6f);
  write_mask("other/sub/b.png", 0.8f);
  Scene scene = open_scene(folder.path());
  use_masks(folder.path() + "/other", &scene);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_NEAR(read_picture(scene.views[0]).alpha.at(0, 0), 0.6, 1e-6);
  EXPECT_NEAR(read_picture(scene.views[1]).alpha.at(0, 0), 0.8, 1e-6);
}

TEST_F(Masks, LongerPathsComeFirstAndTheFileNameDoes) {
  write_mask("other/b.png", 0);
  write_mask("flat/b.png.png", 0.2f);
  write_mask("other/sub/b.png.png", 0.6f);
  Scene scene = open_scene(folder.path());
  use_masks(folder.path() + "/other", &scene);
  EXPECT_NEAR(read_picture(scene.views[1]).alpha.at(0, 0), 0.6, 1e-6);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("views without a mask in")));
  EXPECT_THAT(scene.warnings[0], HasSubstr(": 1 (a.png)"));
  use_masks(folder.path() + "/flat", &scene);
  EXPECT_NEAR(read_picture(scene.views[1]).alpha.at(0, 0), 0.2, 1e-6);
}

TEST_F(Masks, OfAnotherSizeOrWithoutAnythingWhiteAreRefused) {
  write_mask("masks/a.png", 0, 7);
  EXPECT_EQ(complaint(open_scene(folder.path()).views[0]),
            "/masks/a.png: expected a mask of 8 x 6 px, found 7 x 6");
  write_png(folder.file("masks/a.png"), Image<float>(8, 6, 1 / 255.f));
  EXPECT_EQ(complaint(open_scene(folder.path()).views[0]),
            "/masks/a.png: expected a mask that is white where the object is, found nothing white");
}

TEST_F(Masks, FoldersWithoutAnyAreRefused) {
  Scene scene = open_scene(folder.path());
  EXPECT_THROW(use_masks(folder.path() + "/none", &scene), InputError);
  folder.write("empty/readme", "");
  try {
    use_masks(folder.path() + "/empty", &scene);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("masks named like the images"), HasSubstr("a.png")));
  }
}

TEST_F(Masks, ShrinkWithTheirPictures) {
  write_mask("masks/a.png", 0);
  const Picture p = read_picture(open_scene(folder.path()).views[0], 2);
  EXPECT_EQ(p.width(), 4);
  EXPECT_EQ(p.alpha.height, 3);
  EXPECT_NEAR(p.alpha.at(0, 0), 0.75, 1e-6);
}

}  // namespace
}  // namespace sketchsplat

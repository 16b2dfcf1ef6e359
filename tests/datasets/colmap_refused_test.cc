// SPDX-License-Identifier: MIT
// What COLMAP's reader says of files that are none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/types/errors.h"
#include "tests/datasets/colmap_scene.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using ::testing::AllOf;
using ::testing::HasSubstr;

// What is said of a scene, from the name of the file in its model on.
std::string complaint(const TempFolder& folder) {
  try {
    open_scene(folder.path());
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_EQ(what.find('\n'), std::string::npos);
    const size_t at = what.find("/sparse/0/");
    return at == std::string::npos ? what : what.substr(at + 10);
  }
  return "";
}

// The same of the small model, of which one file is another.
std::string complaint(const std::string& file, const std::string& bytes) {
  const TempFolder folder;
  write_images(folder);
  const bool binary = file.find(".bin") != std::string::npos;
  (binary ? write_colmap_binary : write_colmap_text)(small_model(), folder.path() + "/sparse/0");
  folder.write("sparse/0/" + file, bytes);
  return complaint(folder);
}

TEST(ColmapRefused, BinaryFilesAreRefusedWhereverTheyAreCut) {
  const ColmapFiles m = small_model();
  const TempFolder folder;
  write_images(folder);
  write_colmap_binary(m, folder.path() + "/sparse/0");
  for (const auto& [file, bytes] : {std::pair{"sparse/0/cameras.bin", cameras_binary(m)},
                                    {"sparse/0/images.bin", images_binary(m)},
                                    {"sparse/0/points3D.bin", points_binary(m)}}) {
    for (size_t size = 0; size < bytes.size(); ++size) {
      folder.write(file, bytes.substr(0, size));
      EXPECT_THAT(complaint(folder), HasSubstr(".bin: expected whole ")) << file << size;
    }
    folder.write(file, bytes);
  }
}

TEST(ColmapRefused, CountsThatTheFileCannotHoldAreRefusedBeforeMemoryIsTaken) {
  const ColmapFiles m = small_model();
  const std::string many("\xff\xff\xff\xff\xff\xff\xff\x0f", 8);
  for (const auto& [file, bytes] : {std::pair{"cameras.bin", cameras_binary(m)},
                                    {"images.bin", images_binary(m)},
                                    {"points3D.bin", points_binary(m)}})
    EXPECT_THAT(complaint(file, std::string(bytes).replace(0, 8, many)),
                HasSubstr("found a count of 1152921504606846975"));
  // The points of the first image, the track of the first point.
  std::string images = images_binary(m), points = points_binary(m);
  images.replace(images.find("words.png") + 10, 8, many);
  EXPECT_THAT(complaint("images.bin", images), HasSubstr("found a count of"));
  points.replace(8 + 8 + 24 + 3 + 8, 8, many);
  EXPECT_THAT(complaint("points3D.bin", points), HasSubstr("found a count of"));
}

TEST(ColmapRefused, TextThatIsNoneIsNamedByItsLine) {
  EXPECT_EQ(complaint("cameras.txt", "1 PINHOLE 16 12 20 x 8 6\n"),
            "cameras.txt: expected a number in line 1, found \"x\"");
  EXPECT_EQ(complaint("cameras.txt", "# c\n1 PINHOLE 16 12 20 20 8\n"),
            "cameras.txt: expected a number in line 2, found its end");
  EXPECT_EQ(complaint("cameras.txt", "1 PINHOLE 0 12 20 20 8 8\n"),
            "cameras.txt: expected a size of pictures in line 1, found \"0.000000\"");
  EXPECT_EQ(complaint("images.txt", "1 1 0 0 0 0 0 1 7\n\n"),
            "images.txt: expected the name of an image in line 1, found its end");
  EXPECT_EQ(complaint("images.txt", "1 1 0 0 0 0 0 1 -7 a\n\n"),
            "images.txt: expected a whole number in line 1, found \"-7.000000\"");
  EXPECT_EQ(complaint("points3D.txt", "1 0 0 0 9 9 9 0.1 4 0 5\n"),
            "points3D.txt: expected a number in line 1, found its end");
}

TEST(ColmapRefused, CamerasThatAreMissingAreNamed) {
  EXPECT_EQ(complaint("cameras.txt", "3 SIMPLE_PINHOLE 16 12 25 8 6\n"),
            "images.txt: expected a camera of sub/two words.png in the file of cameras, found no "
            "camera 7");
}

TEST(ColmapRefused, OtherCameraModelsAreRefusedWithAWayOut) {
  ColmapFiles m = small_model();
  m.cameras[0] = {7, "FOV", 7, 16, 12, {20, 20, 8, 6, 0.9}};
  for (const auto& [file, bytes] :
       {std::pair{"cameras.txt", cameras_text(m)}, {"cameras.bin", cameras_binary(m)}})
    EXPECT_THAT(complaint(file, bytes),
                AllOf(HasSubstr("camera model of sub/two words.png"),
                      HasSubstr("colmap image_undistorter"), HasSubstr("found FOV")));
  m.cameras[0].model = "NEW_ONE", m.cameras[0].model_id = 42;
  EXPECT_THAT(complaint("cameras.txt", cameras_text(m)), HasSubstr("found NEW_ONE"));
  EXPECT_THAT(complaint("cameras.bin", cameras_binary(m)),
              AllOf(HasSubstr("colmap image_undistorter"), HasSubstr("found number 42")));
  m.images.erase(m.images.begin());
  const TempFolder folder;
  write_images(folder);
  write_colmap_text(m, folder.path() + "/sparse/0");
  EXPECT_EQ(open_scene(folder.path()).views.size(), 2u) << "nobody uses that camera";
}

TEST(ColmapRefused, AFolderWithoutAModelSaysWhereItShouldBe) {
  const TempFolder folder;
  write_images(folder);
  folder.write("sparse/0/cameras.bin", "");
  try {
    open_scene(folder.path());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("expected a model of COLMAP"));
  }
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// Bad scenes: files that tell of cameras and images.
#include "tests/pipelines/bad_scenes.h"

#include <filesystem>

namespace sketchsplat::test {

namespace fs = std::filesystem;

std::vector<BadScene> bad_scene_files() {
  const auto meta = [](const std::string& name, const Damage& damage, int status,
                       const std::string& line) {
    return BadScene{name, "abc-nef", kOpen, damage, status, line};
  };
  const auto pose = [&](const std::string& name, const std::string& matrix, int status,
                        const std::string& line) {
    return meta(name, swap(kMeta, kIdentity, matrix), status, line);
  };
  const auto lens = [&](const std::string& name, const std::string& matrix, int status,
                        const std::string& line) {
    return meta(name, swap(kMeta, "[[40,0,15.5],[0,40,11.5],[0,0,1]]", matrix), status, line);
  };
  const std::string left_out = "0\\.png is left out: ";
  return {
      meta("NothingInIt", put(kMeta, ""), 3,
           "meta_data.json: expected a JSON file, found nothing to read"),
      meta("OneBracket", put(kMeta, "{"), 3,
           "meta_data.json: expected a JSON file, found no JSON at byte 2"),
      meta("CutInHalf", cut(kMeta, 0.5), 3, "expected a JSON file, found no JSON at byte"),
      meta("Binary", put(kMeta, std::string("\0\xff\x80{", 4)), 3, "found no JSON at byte 1"),
      meta("BrokenUtf8", swap(kMeta, "0.png", "\xff.png"), 3, "found no JSON at byte"),
      meta("Null", put(kMeta, "null"), 3, "an object with the key \"frames\", found null"),
      meta("AnArray", put(kMeta, "[]"), 3, "an object with the key \"frames\", found \\[\\]"),
      meta("NoFrames", put(kMeta, "{}"), 3, "expected the key \"frames\", found none"),
      meta("FramesAreANumber", put(kMeta, "{\"frames\": 5}"), 3, "an array in frames, found 5"),
      meta("EmptyFrames", put(kMeta, "{\"frames\": []}"), 3,
           "frames that can be used, found no frame"),
      meta("FrameIsANumber", put(kMeta, "{\"frames\": [1]}"), 3,
           "the key \"rgb_path\"[^,]*, found 1"),
      meta("TooManyFrames", put(kMeta, many_frames(20001)), 3, "at most 20000 frames, found 20001"),
      meta("AMillionFrames", put(kMeta, many_frames(1000000)), 3,
           "at most 20000 frames, found 1000000"),
      meta("DeeplyNested", put(kMeta, std::string(200000, '[')), 3,
           "at most 100 arrays and objects in one another, found 200000"),
      meta("TenGigabytes", blow_up(kMeta), 3,
           "meta_data.json: expected a file of at most 250 MB, found 10000 MB"),
      meta("IsAFolder", folder_instead(kMeta), 3,
           "meta_data.json: expected a JSON file, found nothing to read"),
      meta("NoName", swap(kMeta, "\"rgb_path\": \"0.png\",", ""), 3,
           "the key \"rgb_path\" in frames\\[0\\], found none"),
      meta("NameIsANumber", swap(kMeta, "\"0.png\"", "7"), 3,
           "a text in frames\\[0\\].rgb_path, found 7"),
      meta("EmptyName", swap(kMeta, "0.png", ""), 0, "its image is missing"),
      meta("ImageOutside", swap(kMeta, "0.png", "../../x.png"), 0,
           "frame ../../x.png is left out: its image lies outside of the scene's folder "
           "\\(--allow-outside"),
      meta("AbsoluteImage", swap(kMeta, "0.png", "/etc/hostname"), 0,
           "frame /etc/hostname is left out: its image lies outside"),
      meta("OutInAndOutAgain", swap(kMeta, "0.png", "a/../../../color/0.png"), 0,
           "its image lies outside of the scene's folder"),
      meta("AllImagesOutside", swap_all(kMeta, "\"rgb_path\": \"", "\"rgb_path\": \"../../"), 3,
           "frames that can be used, found none \\(frame ../../0.png is left out: its image lies "
           "outside"),
      {"AllowedOutside", "abc-nef", kOutside, swap(kMeta, "0.png", "../../x.png"), 0,
       "frame ../../x.png is left out: its image is missing"},
      meta("ImageTwice", swap(kMeta, "1.png", "0.png"), 0,
           left_out + "its image is that of another frame"),
      meta("ImageGone", gone("color/0.png"), 0, left_out + "its image is missing"),
      meta("ImageIsAFolder", folder_instead("color/0.png"), 0, left_out + "its image is missing"),
      meta("ImageIsAPipe", pipe_instead("color/0.png"), 0, left_out + "its image is missing"),
      meta("AllImagesGone", gone("color"), 3,
           "frames that can be used, found none \\(frame 0.png is left out: its image is "
           "missing\\)"),
      pose("PoseThreeByThree", "[[1,0,0],[0,1,0],[0,0,1]]", 3,
           "a 4 x 4 matrix in frames\\[0\\].camtoworld"),
      pose("PoseIsText", "\"here\"", 3,
           "a 4 x 4 matrix in frames\\[0\\].camtoworld, found \"here\""),
      pose("PoseHoldsText", "[[\"a\",0,0,0],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]", 3,
           "a number in frames\\[0\\].camtoworld\\[0\\], found \"a\""),
      pose("PoseIsNan", "[[NaN,0,0,0],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]", 0,
           left_out + "its pose is not finite"),
      pose("PoseOverflows", "[[1,0,0,1e999],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]", 3,
           "meta_data.json: expected numbers below 1.8e308, found a larger one"),
      pose("PoseIsHuge", "[[1,0,0,1e308],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]", 0,
           left_out + "its pose holds numbers that are too large"),
      pose("PoseFarAway", "[[1,0,0,1e9],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]", 0, "0.png is left out: "),
      pose("PoseScales", "[[2,0,0,0],[0,2,0,0],[0,0,2,-4],[0,0,0,1]]", 0,
           left_out + "its pose is no rotation"),
      pose("PoseMirrors", "[[-1,0,0,0],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]", 0,
           left_out + "its pose is a reflection"),
      pose("PoseProjects", "[[1,0,0,0],[0,1,0,0],[0,0,1,-4],[0,0,1,1]]", 0,
           left_out + "the last row of its pose is not 0 0 0 1"),
      lens("FocalLengthZero", "[[0,0,15.5],[0,40,11.5],[0,0,1]]", 0,
           left_out + "its focal length is not positive"),
      lens("FocalLengthNegative", "[[40,0,15.5],[0,-40,11.5],[0,0,1]]", 0,
           left_out + "its focal length is not positive"),
      lens("Skewed", "[[40,3,15.5],[0,40,11.5],[0,0,1]]", 0,
           left_out + "its intrinsics are skewed"),
      lens("IntrinsicsNan", "[[40,0,NaN],[0,40,11.5],[0,0,1]]", 0,
           left_out + "its intrinsics are not finite"),
      lens("IntrinsicsTwoByTwo", "[[40,0],[0,40]]", 3,
           "a 3 x 3 matrix in frames\\[0\\].intrinsics"),
      meta("WidthZero", swap(kMeta, "\"width\": 32", "\"width\": 0"), 3,
           "a positive whole number in width, found 0"),
      meta("WidthNegative", swap(kMeta, "\"width\": 32", "\"width\": -3"), 3,
           "a positive whole number in width, found -3"),
      meta("WidthBroken", swap(kMeta, "\"width\": 32", "\"width\": 1.5"), 3,
           "a positive whole number in width, found 1.5"),
      meta("WidthHuge", swap(kMeta, "\"width\": 32", "\"width\": 1e300"), 3,
           "a positive whole number in width"),
      meta("TooManyPixels",
           both(swap(kMeta, "\"width\": 32", "\"width\": 1000000"),
                swap(kMeta, "\"height\": 24", "\"height\": 1000")),
           3, "its image has more than 300 million pixels"),
      meta("WorldToGtTooSmall", swap(kMeta, "[[1,0,0,0],", "["), 3, "a 4 x 4 matrix in worldtogt"),
      meta("WorldToGtNan", swap(kMeta, "[[1,0,0,0],", "[[NaN,0,0,0],"), 3,
           "finite numbers in worldtogt"),
      meta("NoSceneAtAll", gone(kMeta), 3,
           "a scene folder \\(with .*meta_data.json.*\\), found none of them"),
  };
}

std::vector<BadScene> bad_transforms() {
  const auto nerf = [](const std::string& name, const Damage& damage, int status,
                       const std::string& line) {
    return BadScene{"Nerf" + name, "nerf", kOpen, damage, status, line};
  };
  const auto studio = [](const std::string& name, const Damage& damage, int status,
                         const std::string& line) {
    return BadScene{"Nerfstudio" + name, "nerfstudio", kOpen, damage, status, line};
  };
  return {
      nerf("NoAngle", swap(kTrain, "camera_angle_x", "angle"), 3,
           "the key \"camera_angle_x\", found none"),
      nerf("AngleIsText", swap(kTrain, "0.76", "\"wide\""), 3,
           "a number in camera_angle_x, found \"wide\""),
      nerf("AngleZero", swap(kTrain, "0.76", "0"), 3,
           "found none \\(frame ./train/0 is left out: its intrinsics are not finite\\)"),
      nerf("AngleNegative", swap(kTrain, "0.76", "-1"), 3, "its focal length is not positive"),
      nerf("NoPose", swap(kTrain, "transform_matrix", "pose"), 3,
           "the key \"transform_matrix\" in frames\\[0\\], found none"),
      nerf("ImageOutside", swap(kTrain, "./train/0", "../train/0"), 0,
           "frame ../train/0 is left out: its image lies outside"),
      nerf("ImageIsText", put("train/0.png", "hello"), 0,
           "frame ./train/0 is left out: its image cannot be read"),
      studio("UnknownCamera", swap(kTrans, "OPENCV", "EQUIRECTANGULAR"), 3,
             "expected OPENCV, .* in camera_model, found \"EQUIRECTANGULAR\""),
      studio("FourthTerm", swap(kTrans, "\"k4\": 0", "\"k4\": 0.1"), 3,
             "0 with a camera model that is no fisheye in k4, found 0.1"),
      studio("NoFocalLength", swap(kTrans, "fl_x", "fl"), 3, "the key \"fl_x\", found none"),
      studio("WidthZero", swap(kTrans, "\"w\": 32", "\"w\": 0"), 3,
             "a positive whole number in w, found 0"),
      studio("FocalLengthIsText", swap(kTrans, "\"fl_x\": 40", "\"fl_x\": \"a\""), 3,
             "a number in fl_x, found \"a\""),
      studio("LensNan", swap(kTrans, "\"k1\": 0.01", "\"k1\": NaN"), 3,
             "its distortion is not finite"),
      studio("ImageGone", gone("images/0.png"), 0, "poses without an image: 1 \\(images/0.png\\)"),
      studio("ImageOutside", both(swap(kTrans, "images/0", "../images/0"), gone("images/0.png")), 0,
             "frame ../images/0.png is left out: its image lies outside"),
      studio("MaskGone", gone("masks/0.png"), 0,
             "masks that are missing or outside of the scene: 1 \\(masks/0.png\\)"),
      studio("MaskOutside", swap(kTrans, "masks/0.png", "/etc/hostname"), 0,
             "masks that are missing or outside of the scene: 1 \\(/etc/hostname\\)"),
      studio("ImageNobodyKnows", put("images/9.png", "?"), 0,
             "images without a pose: 1 \\(images/9.png\\)"),
  };
}

std::vector<BadScene> bad_colmap_files() {
  const auto text = [](const std::string& name, const Damage& damage, int status,
                       const std::string& line) {
    return BadScene{"ColmapText" + name, "colmap-text", kOpen, damage, status, line};
  };
  const auto binary = [](const std::string& name, const Damage& damage, int status,
                         const std::string& line) {
    return BadScene{"ColmapBinary" + name, "colmap-binary", kOpen, damage, status, line};
  };
  const std::string camera = "1 PINHOLE 32 24 40 40 16 12";
  return {
      text("NoCameras", put(kCameras + ".txt", ""), 3,
           "a camera of 0.png in the file of cameras, found no camera 1"),
      text("UnknownCamera", swap(kCameras + ".txt", "PINHOLE", "LYTRO"), 3,
           "as the camera model of 0.png .*found LYTRO"),
      text("CameraOfOthers",
           swap(kCameras + ".txt", "PINHOLE 32 24 40 40 16 12", "FOV 32 24 40 40 16 12 0.5"), 3,
           "as the camera model of 0.png .*found FOV"),
      text("WidthZero", swap(kCameras + ".txt", " 32 ", " 0 "), 3,
           "cameras.txt: expected a size of pictures in line 3"),
      text("WidthHuge", swap(kCameras + ".txt", " 32 ", " 1e9 "), 3,
           "cameras.txt: expected a size of pictures in line 3"),
      text("CameraCutOff", swap(kCameras + ".txt", " 40 40 16 12", " 40"), 3,
           "cameras.txt: expected a number in line 3, found its end"),
      text("WordForANumber", swap(kCameras + ".txt", " 40 40", " 40 wide"), 3,
           "a number in line 3, found \"wide\""),
      text("ImageCutOff", swap(kImages + ".txt", " 1 0.png", ""), 3,
           "images.txt: expected a number in line 2, found its end"),
      text("ImageWithoutName", swap(kImages + ".txt", " 0.png", ""), 3,
           "the name of an image in line 2, found its end"),
      text("CameraOfNobody", swap(kImages + ".txt", " 1 0.png", " 7 0.png"), 3,
           "a camera of 0.png in the file of cameras, found no camera 7"),
      text("NegativeCamera", swap(kImages + ".txt", " 1 0.png", " -1 0.png"), 3,
           "a whole number in line 2, found \"-1"),
      text("NoRotation", swap(kImages + ".txt", "1 1 0 0 0", "1 0 0 0 0"), 0,
           "0.png is left out: its pose is no rotation"),
      text("RotationNan", swap(kImages + ".txt", "1 1 0 0 0", "1 nan 0 0 0"), 0,
           "0.png is left out: its pose is not finite"),
      text("ImageOutside",
           both(swap(kImages + ".txt", "0.png", "../../0.png"), gone("images/0.png")), 0,
           "frame ../../0.png is left out: its image lies outside"),
      text("ImageGone", gone("images/0.png"), 0, "poses without an image: 1 \\(0.png\\)"),
      text("WordForAPoint", swap(kPoints + ".txt", "0.5 1", "0.5 one"), 3,
           "points3D.txt: expected a number in line 2, found \"one\""),
      text("NoImages", gone(kImages + ".txt"), 3, "a model of COLMAP \\(cameras and images"),
      text("TenGigabytes", blow_up(kImages + ".txt"), 3,
           "images.txt: expected a file of at most 1000 MB, found 10000 MB"),
      binary("NoCameras", put(kCameras + ".bin", ""), 3,
             "whole cameras of COLMAP, found the end of the file"),
      binary("CameraCutOff", cut(kCameras + ".bin", 0.8), 3,
             "cameras.bin: expected whole cameras of COLMAP, found"),
      binary(
          "CountTooLarge", poke(kImages + ".bin", 0, bytes(std::uint64_t(1) << 60)), 3,
          "images.bin: expected whole images of COLMAP, found a count of 1152921504606846976 with"),
      binary("UnknownCamera", poke(kCameras + ".bin", 12, bytes(std::int32_t(99))), 3,
             "a camera model that is known .*, found number 99"),
      binary("WidthHuge", poke(kCameras + ".bin", 16, bytes(std::uint64_t(1) << 40)), 3,
             "a size of pictures, found 1099511627776"),
      binary("ImageCutOff", cut(kImages + ".bin", 0.9), 3, "whole images of COLMAP, found"),
      binary("NameWithoutEnd", cut(kImages + ".bin", 0.26), 3, "whole images of COLMAP, found"),
      binary("PointCutOff", cut(kPoints + ".bin", 0.9), 3, "whole points of COLMAP, found"),
      binary("AMillionImages",
             both(blow_up(kImages + ".bin"),
                  [](const std::string& folder) {
                    fs::resize_file(folder + "/sparse/0/images.bin", 900'000'000);
                    std::fstream(folder + "/sparse/0/images.bin",
                                 std::ios::in | std::ios::out | std::ios::binary)
                        << bytes(std::uint64_t(1000000));
                  }),
             3, "images.bin: expected at most 20000 frames, found 20001"),
      binary("TenGigabytes", blow_up(kPoints + ".bin"), 3,
             "points3D.bin: expected a file of at most 1000 MB, found 10000 MB"),
  };
}

}  // namespace sketchsplat::test

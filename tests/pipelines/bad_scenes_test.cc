// SPDX-License-Identifier: MIT
// A small good scene, damaged in one place: the program ends with this status and says this one
// line. Everything runs in this process; nothing may end it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "pipelines/cli.h"
#include "tests/support/damage.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using namespace test;

// ----------------------------------------------------------------------------------- table

// {} is the folder of the scene.
constexpr char kOpen[] = "reconstruct {} --dry-run --out {}/out";
constexpr char kDetect[] = "detect {} --out {}/out";
constexpr char kMasks[] = "detect {} --masks {}/masks --out {}/out";
constexpr char kGeometry[] = "detect {} --detector geometry --out {}/out";
constexpr char kOutside[] = "reconstruct {} --dry-run --allow-outside --out {}/out";
constexpr char kSketch[] = "export {}/sketch.json --format obj --out {}/out.obj";
constexpr char kEmap[] = "evaluate --pred {}/emap.json --gt {}/gt.json";
constexpr char kNef[] = "evaluate --pred {}/nef.json --gt {}/gt.json";
constexpr char kPly[] = "evaluate --pred {}/points.ply --gt {}/gt.json";
constexpr char kObj[] = "evaluate --pred {}/lines.obj --gt {}/gt.json";
constexpr char kAbc[] = "evaluate --pred {}/emap.json --gt {}/abc";
constexpr char kStep[] = "synthesize {}/part.step --out {}/out";

const std::string kMeta = "meta_data.json", kTrain = "transforms_train.json",
                  kTrans = "transforms.json";
const std::string kCameras = "sparse/0/cameras", kImages = "sparse/0/images",
                  kPoints = "sparse/0/points3D";
const std::string kIdentity = "[[1,0,0,0.000000],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]";

struct BadScene {
  std::string name;
  std::string format;  ///< of the good scene
  std::string command;
  Damage damage;
  int status;
  std::string line;  ///< a regular expression, of the error or else of the warning
};
void PrintTo(const BadScene& row, std::ostream* out) { *out << row.name; }

std::vector<BadScene> scene_files() {
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

std::vector<BadScene> transforms() {
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

std::vector<BadScene> colmap_files() {
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
             "a size of pictures, found 1099511627776 x 24"),
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
             3, "images.bin: expected at most 20000 frames, found 1000000"),
      binary("TenGigabytes", blow_up(kPoints + ".bin"), 3,
             "points3D.bin: expected a file of at most 1000 MB, found 10000 MB"),
  };
}

std::vector<BadScene> images() {
  const auto image = [](const std::string& name, const Damage& damage, int status,
                        const std::string& line) {
    return BadScene{"Image" + name, "abc-nef", kDetect, damage, status, line};
  };
  const auto mask = [](const std::string& name, const Damage& damage, const std::string& line) {
    return BadScene{"Mask" + name, "nerfstudio", kMasks, damage, 0, line};
  };
  const auto exr = [](const std::string& name, const Damage& damage, const std::string& line) {
    return BadScene{"Exr" + name, "abc-nef", kGeometry, maps(damage), 0, line};
  };
  const auto as_jpeg = [](const Damage& then) {
    return both(both(gone("color/0.png"), swap(kMeta, "0.png", "0.jpg")),
                jpeg("color/0.jpg", then));
  };
  const Damage as_tiff = both(gone("color/0.png"), swap(kMeta, "0.png", "0.tif"));
  return {
      image("Empty", put("color/0.png", ""), 0, "0.png: expected an image, found an empty file"),
      image("IsText", put("color/0.png", "hello"), 0, "0.png: expected an image, found"),
      image("CutOff", cut("color/0.png", 0.6), 0,
            "0.png: expected a whole PNG image, found a broken one"),
      image("HeaderAlone", cut("color/0.png", 0.1), 0,
            "0.png: expected a whole PNG image, found a broken one"),
      image("AnotherSize", swap(kMeta, "\"width\": 32", "\"width\": 33"), 3,
            "an image of 33 x 24 px, found 32 x 24"),
      image("ClaimsABillionPixels", png_claims("color/0.png", 32000, 32000), 0,
            "0.png: expected a whole PNG image, found a broken one \\(more pixels than the file "
            "can hold"),
      image("ClaimsNoPixels", png_claims("color/0.png", 0, 24), 0,
            "0.png: expected a whole PNG image, found a broken one"),
      image("OfTenGigabytes", blow_up("color/0.png"), 0,
            "0.png: expected an image of at most 1200 MB, found 10000 MB"),
      image("JpegCutOff", as_jpeg(cut("color/0.jpg", 0.6)), 0,
            "0.jpg: expected a whole JPEG image, found a broken one \\(no end\\)"),
      image("JpegClaimsFourBillionPixels", as_jpeg(jpeg_claims("color/0.jpg", 65500)), 0,
            "0.jpg: expected a whole JPEG image, found a broken one"),
      image("JpegOfTenGigabytes", as_jpeg(blow_up("color/0.jpg")), 0,
            "0.jpg: expected an image of at most 1200 MB, found 10000 MB"),
      image("TiffClaimsABillionPixels", both(as_tiff, put("color/0.tif", tiff(32000, 32000))), 0,
            "0.tif: expected an image, found "),
      image("TiffCutOff", both(as_tiff, put("color/0.tif", tiff(32, 24).substr(0, 60))), 0,
            "0.tif: expected an image, found "),
      mask(
          "Black",
          [](const std::string& folder) {
            write_png(folder + "/masks/0.png", Image<float>(32, 24, 0.0f));
          },
          "masks/0.png: expected a mask that is white where the object is, found nothing white"),
      mask(
          "OfAnotherSize",
          [](const std::string& folder) {
            write_png(folder + "/masks/0.png", Image<float>(16, 24, 1.0f));
          },
          "masks/0.png: expected a mask of 32 x 24 px, found 16 x 24"),
      mask("CutOff", cut("masks/0.png", 0.6),
           "masks/0.png: expected a whole PNG image, found a broken one"),
      {"NoMasks", "nerfstudio", kMasks, gone("masks"), 3,
       "masks: expected a folder of masks, found nothing"},
      exr("CutOff", cut("depth/0.exr", 0.6), "depth/0.exr: expected an OpenEXR image, found"),
      exr("IsText", put("depth/0.exr", "hello"), "depth/0.exr: expected an OpenEXR image, found"),
      exr("Gone", gone("depth/0.exr"), "depth: expected a map of 0.png \\(.exr\\), found none"),
      exr("ClaimsABillionPixels", exr_claims("depth/0.exr", 31999),
          "depth/0.exr: expected an OpenEXR image, found"),
      exr(
          "OfAnotherSize",
          [](const std::string& folder) {
            write_exr(folder + "/depth/0.exr", {{"R", Image<float>(8, 8, 1.0f)}}, false);
          },
          "depth/0.exr: expected a map of 32 x 24 px, found 8 x 8"),
  };
}

std::vector<BadScene> edges() {
  const auto row = [](const char* command, const std::string& file) {
    return [=](const std::string& name, const Damage& damage, const std::string& line) {
      return BadScene{name, "edges", command, damage, 3, file + ": expected " + line};
    };
  };
  const auto sketch = row(kSketch, "sketch.json"), emap = row(kEmap, "emap.json"),
             nef = row(kNef, "nef.json");
  const auto ply = row(kPly, "points.ply"), obj = row(kObj, "lines.obj"),
             truth = row(kEmap, "gt.json");
  const auto abc = row(kAbc, "a_features_0.yml");
  const std::string yml = "abc/a_features_0.yml";
  return {
      sketch("SketchEmpty", put("sketch.json", ""), "a sketch as JSON, found"),
      sketch("SketchWithoutVersion", swap("sketch.json", "format_version", "version"),
             "\"format_version\" in the file, found no such key"),
      sketch("SketchOfTheFuture", swap("sketch.json", ": 1,", ": 2,"), "format_version 1, found 2"),
      sketch("SketchNodesAreText", swap("sketch.json", "[[0,0,0],[1,0,0],[1,1,0]]", "\"three\""),
             "an array as \"nodes\" in the file, found string"),
      sketch("SketchNodeOfTwo", swap("sketch.json", "[1,1,0]", "[1,1]"),
             "three numbers as node 2, found \\[1,1\\]"),
      sketch("SketchKindUnknown", swap("sketch.json", "\"arc\"", "\"helix\""),
             "line, arc, .* of stroke 1, found \"helix\""),
      sketch("SketchNodeTooLarge", swap("sketch.json", "[0,1]", "[0,9]"),
             "an index of a node in stroke 0 below 3, found 9"),
      sketch("SketchNodeNegative", swap("sketch.json", "[0,1]", "[0,-1]"),
             "an index of a node in stroke 0, found -1"),
      sketch("SketchHandleMissing", swap("sketch.json", "[[1.2,0.5,0]]", "[]"),
             "1 handles in stroke 1, found 0"),
      sketch("SketchHandleOverflows", swap("sketch.json", "1.2", "1e999"),
             "a sketch as JSON, found"),
      sketch("SketchLineToItself", swap("sketch.json", "[0,1]", "[1,1]"), "a sound sketch, found"),
      sketch("SketchDeeplyNested", put("sketch.json", std::string(100000, '[')),
             "JSON with at most 100 arrays"),
      sketch("SketchTooLarge",
             swap("sketch.json", "[[0,0,0]", "[" + repeated("[0,0,0],", 50000) + "[0,0,0]"),
             "at most 50000 nodes in the file, found 50003"),
      sketch("SketchOfTenGigabytes", blow_up("sketch.json"),
             "a file of at most 250 MB, found 10000 MB"),
      emap("EmapFiveNumbers", swap("emap.json", "[0,0,0,1,0,0]", "[0,0,0,1,0]"),
           "6 numbers for each of \"lines_end_pts\", found 5 in all"),
      emap("EmapText", swap("emap.json", "0.5", "\"half\""), "finite coordinates, found \"half\""),
      emap("EmapHuge", swap("emap.json", "0.5", "1e308"), "coordinates below 1e100, found 1e.308"),
      emap("EmapMuchLargerThanTheTruth", swap("emap.json", "0.5", "1e7"),
           "edges of at most 10000 times the size of the true object in all, found"),
      emap("EmapArray", put("emap.json", "[]"), "a JSON object, found another value"),
      emap("EmapNothing", put("emap.json", "{}"),
           "lines_end_pts and curves_ctl_pts, points or strokes, found none of them"),
      emap("EmapEmpty", put("emap.json", ""), "predicted edges as JSON, found"),
      emap("EmapDeeplyNested", put("emap.json", "{\"lines\":" + std::string(100000, '[')),
           "JSON with at most 100 arrays"),
      nef("NefElevenNumbers", swap("nef.json", "[160,160,128]", "[160,160]"),
          "12 numbers for each of \"curves_ctl_pts\", found 11 in all"),
      nef("NefNumber", put("nef.json", "{\"scene_name\": 1, \"curves_ctl_pts\": 3}"),
          "12 numbers for each of"),
      ply("PlyEmpty", put("points.ply", ""), "a PLY file, found no line \"ply\""),
      ply("PlyBigEndian", swap("points.ply", "ascii", "binary_big_endian"),
          "PLY in ascii or binary_little_endian, found format binary_big_endian"),
      ply("PlyWithoutEnd", swap("points.ply", "end_header", "end"),
          "a PLY header, found no end_header"),
      ply("PlyWithoutX", swap("points.ply", "float x", "float u"),
          "vertex properties x, y and z, found a header without one of them"),
      ply("PlyLists", swap("points.ply", "property float x", "property list uchar int x"),
          "scalar vertex properties, found a property of type list"),
      ply("PlyCutOff", swap("points.ply", "vertex 3", "vertex 4"),
          "4 vertices, found the end of the file after 3"),
      ply("PlyOfTrillions", swap("points.ply", "vertex 3", "vertex 4000000000000"),
          "4000000000000 vertices, found the end of the file after 3"),
      ply("PlyNegative", swap("points.ply", "vertex 3", "vertex -3"),
          "element vertex N, found a header without it"),
      ply("PlyBinaryCutOff", swap("points.ply", "ascii", "binary_little_endian"),
          "3 vertices, found the end of the file after"),
      ply("PlyOfTenGigabytes", blow_up("points.ply"), "a file of at most 1000 MB, found 10000 MB"),
      obj("ObjWord", swap("lines.obj", "v 1 0 0", "v 1 a 0"),
          "three numbers after v, found v 1 a 0"),
      obj("ObjIndexZero", swap("lines.obj", "l 1 2", "l 0 2"),
          "an index of a vertex above it, found 0"),
      obj("ObjIndexTooLarge", swap("lines.obj", "l 1 2", "l 1 9"),
          "an index of a vertex above it, found 9"),
      obj("ObjHuge", swap("lines.obj", "v 1 0 0", "v 1e300 0 0"),
          "coordinates below 1e100, found v 1e300 0 0"),
      obj("ObjOfTenGigabytes", blow_up("lines.obj"), "a file of at most 1000 MB, found 10000 MB"),
      truth("TruthEmpty", put("gt.json", ""), "curves with type and points, found"),
      truth("TruthWithoutCurves", put("gt.json", "[]"), "curves, found none"),
      truth("TruthOfOnePoint", swap("gt.json", "[[0,0,0],[1,0,0]]", "[[0,0,0]]"),
            "curves of two points and more, found 1"),
      truth("TruthPointOfTwo", swap("gt.json", "[1,1,0]", "[1,1]"),
            "points of 3 numbers, found \\[1,1\\]"),
      truth("TruthHuge", swap("gt.json", "[1,1,0]", "[1e200,1,0]"),
            "coordinates below 1e100, found"),
      truth("TruthViewsMissing", swap("gt.json", "[3,2]", "[3]"),
            "2 visible_views, one a point, found 1"),
      truth("TruthNoSharp", swap_all("gt.json", "\"type\": ", "\"sharp\": false, \"type\": "),
            "at least one sharp curve, found none"),
      truth("TruthWithoutLength", put("gt.json", "[{\"points\": [[1,1,1],[1,1,1]]}]"),
            "edges with a length, found none"),
      abc("FeaturesEmpty", put(yml, ""), "(a list \"curves\", found none|curves with type)"),
      abc("FeaturesBroken", put(yml, "curves: [\n"),
          "curves with type, sharp and vert_indices, found"),
      abc("FeaturesDeeplyNested", put(yml, "curves: " + std::string(100000, '[')),
          "curves with type, sharp and vert_indices, found"),
      abc("FeaturesWithoutType", swap(yml, "type: Line", "kind: Line"),
          "curves with type, sharp and vert_indices, found"),
      abc("FeaturesIndexTooLarge", swap(yml, "[0, 1]", "[0, 77]"),
          "every vertex of a sharp line, found an index beyond the vertices"),
      {"FeaturesObjBroken", "edges", kAbc, put("abc/a_trimesh.obj", "v 0 zero 0\n"), 3,
       "a_trimesh.obj: expected three numbers after v, found v 0 zero 0"},
      {"FeaturesObjTooLarge", "edges", kAbc,
       put("abc/a_trimesh.obj", "v 0 0 0\nv 1e9 0 0\nv 1 1 0\n"), 3,
       "sharp curves of at most 100000 units in all, found"},
      {"FeaturesObjFlat", "edges", kAbc, put("abc/a_trimesh.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\n"), 3,
       "a box with a longest side above 0, found"},
      {"StepEmpty", "edges", kStep, put("part.step", ""), 3,
       "part.step: expected a STEP file, found too few bytes"},
      {"StepIsText", "edges", kStep, put("part.step", "solid of revolution"), 3,
       "part.step: expected a STEP file \\(ISO-10303-21\\), found another kind"},
      {"StepCutOff", "edges", kStep, cut("part.step", 0.6), 3,
       "part.step: expected (a STEP file|a shape with faces), found"},
      {"StepWithoutSolid", "edges", kStep, swap("part.step", "1.)", "2.)"), 3,
       "part.step: expected a shape with faces, found none"},
      {"StepRefersToNothing", "edges", kStep, swap("part.step", "#4,1.", "#99,1."), 3,
       "part.step: expected"},
      {"StepOfTenGigabytes", "edges", kStep, blow_up("part.step"), 3,
       "part.step: expected a file of at most 1000 MB, found 10000 MB"},
  };
}

std::vector<BadScene> all() {
  std::vector<BadScene> rows;
  for (const auto& some : {scene_files(), transforms(), colmap_files(), images(), edges()})
    rows.insert(rows.end(), some.begin(), some.end());
  return rows;
}

// ------------------------------------------------------------------------------------- run

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

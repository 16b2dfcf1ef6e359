// SPDX-License-Identifier: MIT
#include "datasets/readers/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/readers/far_views.h"
#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A camera at (1, 2, 3) that looks along -y of the world, its x axis along the world's -x: the
// columns are the camera's right, down and forward, respectively right, up and backward.
constexpr char kOpenCv[] = "[[-1,0,0,1],[0,0,-1,2],[0,-1,0,3],[0,0,0,1]]";
constexpr char kOpenGl[] = "[[-1,0,0,1],[0,0,1,2],[0,1,0,3],[0,0,0,1]]";
constexpr char kK3[] = "[[20,0,7.5],[0,21,5.5],[0,0,1]]";
constexpr char kK4[] = "[[20,0,7.5,0],[0,21,5.5,0],[0,0,1,0],[0,0,0,1]]";

void write_image(const TempFolder& folder, const std::string& name, float value = 0.2f) {
  write_png(folder.file(name), Image<float>(16, 12, value));
}

std::string abc_frame(const std::string& name, const std::string& pose = kOpenCv,
                      const std::string& K = kK3) {
  return R"({"rgb_path": ")" + name + R"(", "camtoworld": )" + pose + R"(, "intrinsics": )" + K +
         R"(, "comment": "nobody reads this"})";
}

std::string abc_scene(const std::string& frames, const std::string& more = "") {
  return R"({"camera_model": "OPENCV", "width": 16, "height": 12, )" + more + R"("frames": [)" +
         frames + "]}";
}

/// One good frame a.png, and one that is put to the test; its warning.
std::string warning_about(const std::string& frame) {
  const TempFolder folder;
  write_image(folder, "color/a.png");
  write_image(folder, "color/b.png");
  folder.write("meta_data.json", abc_scene(abc_frame("a.png") + "," + frame));
  const Scene scene = open_scene(folder.path());
  EXPECT_LE(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.views.size() + scene.warnings.size(), 2u);
  EXPECT_EQ(scene.views[0].name, "a.png");
  return scene.warnings.empty() ? "" : scene.warnings[0];
}

/// What open_scene complains about when a folder with one good image holds this scene file.
std::string error_of(const std::string& scene_file, const std::string& json) {
  const TempFolder folder;
  write_image(folder, "color/a.png");
  write_image(folder, "train/a.png");
  folder.write(scene_file, json);
  try {
    open_scene(folder.path());
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "";
}

TEST(OpenScene, BothFormatsGiveTheSameCameras) {
  const TempFolder abc, nerf, angle;
  write_image(abc, "color/a b.png");
  abc.write("meta_data.json",
            abc_scene(abc_frame("a b.png"),
                      R"("worldtogt": [[2,0,0,1],[0,2,0,0],[0,0,2,0],[0,0,0,1]],)"));
  write_image(nerf, "train/a b.png");
  nerf.write("transforms_train.json", std::string(R"({"frames": [{"file_path": "./train/a b", )") +
                                          R"("transform_matrix": )" + kOpenGl +
                                          R"(, "camera_intrinsics": )" + kK3 + "}]}");
  const Scene a = open_scene(abc.path()), b = open_scene(nerf.path());
  EXPECT_EQ(a.format, "abc-nef");
  EXPECT_EQ(b.format, "nerf");
  EXPECT_EQ(a.gt_from_world(0, 0), 2);
  EXPECT_EQ(a.gt_from_world(0, 3), 1);
  EXPECT_EQ(b.gt_from_world, Eigen::Matrix4d::Identity());
  for (const Scene* scene : {&a, &b}) {
    ASSERT_EQ(scene->views.size(), 1u);
    EXPECT_THAT(scene->warnings, IsEmpty());
    const View& view = scene->views[0];
    EXPECT_EQ(view.name, "a b.png");
    EXPECT_EQ(read_picture(view).width(), 16);
    EXPECT_EQ(view.camera.width, 16);
    EXPECT_EQ(view.camera.height, 12);
    EXPECT_EQ(view.camera.fx, 20);
    EXPECT_EQ(view.camera.fy, 21);
    EXPECT_EQ(view.camera.cx, 7.5);
    EXPECT_EQ(view.camera.cy, 5.5);
    EXPECT_TRUE(view.center_in_world().isApprox(Eigen::Vector3d(1, 2, 3), 1e-12));
    double depth = 0;
    // 4 in front of the camera, 1 to its right (world -x) and 2 below it (world -z).
    const Eigen::Vector2d pixel = view.project({0, -2, 1}, &depth);
    EXPECT_NEAR(depth, 4, 1e-12);
    EXPECT_NEAR(pixel.x(), 7.5 + 20 * 0.25, 1e-12);
    EXPECT_NEAR(pixel.y(), 5.5 + 21 * 0.5, 1e-12);
  }
}

TEST(OpenScene, FieldOfViewAloneCentresTheCameraOnTheImage) {
  const TempFolder folder;
  write_image(folder, "train/r_0.png");
  folder.write("transforms_train.json",
               std::string(R"({"camera_angle_x": 1.5707963267948966, "frames": [)") +
                   R"({"file_path": "./train/r_0", "transform_matrix": )" + kOpenGl + "}]}");
  const Camera camera = open_scene(folder.path()).views.at(0).camera;
  EXPECT_NEAR(camera.fx, 8, 1e-12);
  EXPECT_NEAR(camera.fy, 8, 1e-12);
  EXPECT_EQ(camera.cx, 7.5);
  EXPECT_EQ(camera.cy, 5.5);
}

TEST(OpenScene, NefPicturesAreNotItsEdgeMaps) {
  const TempFolder folder;
  write_image(folder, "train/0_colors.png", 0.0f);
  write_image(folder, "train/1_colors.png", 0.0f);
  write_image(folder, "train_img/0_colors.png", 1.0f);
  const auto frame = [](const std::string& name) {
    return R"({"file_path": "./train/)" + name + R"(", "transform_matrix": )" + kOpenGl +
           R"(, "camera_intrinsics": )" + kK3 + "}";
  };
  folder.write("transforms_train.json",
               R"({"frames": [)" + frame("0_colors") + "," + frame("1_colors") + "]}");
  const Scene scene = open_scene(folder.path());
  ASSERT_EQ(scene.views.size(), 1u) << "an edge map must not stand in for a missing picture";
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1_colors")));
  EXPECT_EQ(read_picture(scene.views[0]).red.at(3, 3), 1.0f);
  EXPECT_EQ(read_grey(edge_map_path(scene, scene.views[0], "pidinet")).at(3, 3), 0.0f);
  EXPECT_EQ(edge_map_path(scene, scene.views[0], "DexiNed"), "");
}

TEST(OpenScene, FilePathMayHaveItsExtension) {
  const TempFolder folder;
  write_image(folder, "images/v.1.png");
  folder.write("transforms_train.json",
               std::string(R"({"camera_angle_x": 1, "frames": [{"file_path": "images/v.1.png", )") +
                   R"("transform_matrix": )" + kOpenGl + R"(}, {"file_path": "images/v", )" +
                   R"("transform_matrix": )" + kOpenGl + "}]}");
  const Scene scene = open_scene(folder.path());
  ASSERT_EQ(scene.views.size(), 1u);
  EXPECT_EQ(scene.views[0].name, "v.1.png");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("images/v ")));
}

TEST(OpenScene, IntrinsicsMayBeFourByFour) {
  EXPECT_EQ(warning_about(abc_frame("b.png", kOpenCv, kK4)), "");
}

TEST(OpenScene, SizeIsThatOfTheImageIfTheSceneFileIsSilent) {
  const TempFolder folder;
  write_image(folder, "color/a.png");
  folder.write("meta_data.json", R"({"frames": [)" + abc_frame("a.png") + "]}");
  const Camera camera = open_scene(folder.path()).views.at(0).camera;
  EXPECT_EQ(camera.width, 16);
  EXPECT_EQ(camera.height, 12);
}

TEST(OpenScene, FramesThatCannotBeUsedAreNamed) {
  EXPECT_EQ(warning_about(abc_frame("b.png")), "");
  EXPECT_THAT(warning_about(abc_frame("no such.png")),
              AllOf(HasSubstr("no such.png"), HasSubstr("image is missing")));
  EXPECT_THAT(warning_about(abc_frame("a.png")), HasSubstr("that of another frame"));
  EXPECT_THAT(warning_about(abc_frame("b.png", "[[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]")),
              AllOf(HasSubstr("b.png"), HasSubstr("no rotation")));
  EXPECT_THAT(warning_about(abc_frame("b.png", "[[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,1]]")),
              HasSubstr("no rotation"));
  EXPECT_THAT(warning_about(abc_frame("b.png", "[[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]")),
              HasSubstr("reflection"));
  EXPECT_THAT(warning_about(abc_frame("b.png", "[[1,0,0,NaN],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              HasSubstr("not finite"));
  EXPECT_THAT(warning_about(abc_frame("b.png", "[[1,0,0,null],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              HasSubstr("not finite"));
  EXPECT_THAT(warning_about(abc_frame("b.png", "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]")),
              HasSubstr("last row"));
  for (const char* K :
       {"[[0,0,7],[0,20,5],[0,0,1]]", "[[20,0,7],[0,-20,5],[0,0,1]]", "[[20,5,7],[0,20,5],[0,0,1]]",
        "[[20,0,7],[0,20,5],[0,0,2]]", "[[20,0,Infinity],[0,20,5],[0,0,1]]"}) {
    EXPECT_THAT(warning_about(abc_frame("b.png", kOpenCv, K)), HasSubstr("b.png")) << K;
  }
}

TEST(OpenScene, FramesOutOfAllBoundsAreLeftOut) {
  EXPECT_THAT(warning_about(abc_frame("b.png", "[[1,0,0,1e308],[0,1,0,0],[0,0,1,0],[0,0,0,1]]")),
              AllOf(HasSubstr("b.png"), HasSubstr("too large")));
}

/// Four cameras one unit around the place, and a fifth: how many views are kept.
size_t views_kept(double fifth, double unit) {
  const TempFolder folder;
  std::string frames;
  const double x[] = {-1, 1, 0, 0, fifth}, y[] = {0, 0, -1, 1, 0};
  for (int k = 0; k < 5; ++k) {
    const std::string name = std::to_string(k) + ".png";
    write_image(folder, "color/" + name);
    frames += (k ? "," : "") +
              abc_frame(name, "[[1,0,0," + std::to_string(x[k] * unit) + "],[0,1,0," +
                                  std::to_string(y[k] * unit) + "],[0,0,1,0],[0,0,0,1]]");
  }
  folder.write("meta_data.json", abc_scene(frames));
  const Scene scene = open_scene(folder.path());
  EXPECT_EQ(scene.views.size() + scene.warnings.size(), 5u);
  for (const std::string& warning : scene.warnings)
    EXPECT_THAT(warning, AllOf(HasSubstr("4.png"), HasSubstr("too far away")));
  return scene.views.size();
}

TEST(OpenScene, ACameraThatIsTooFarAwayToSeeTheOthersIsLeftOutWhateverTheUnit) {
  for (const double unit : {1e-3, 1.0, 1e6}) {
    EXPECT_EQ(views_kept(15, unit), 5u);
    EXPECT_EQ(views_kept(25, unit), 4u) << "the others around one pixel of its image";
    EXPECT_EQ(views_kept(1e60, unit), 4u);
  }
}

TEST(LeaveOutFarViews, PointsKeepTheViewsThatStay) {
  Scene scene;
  for (const double x : {-1.0, 1e9, 1.0, 0.5, 2.0}) {
    View view;
    view.name = std::to_string(x);
    view.camera = {16, 12, 20, 20, 7.5, 5.5};
    view.cam_from_world.translation.x() = -x;
    scene.views.push_back(view);
  }
  scene.points = {{Eigen::Vector3d::Zero(), {{0, {5, 5}}, {1, {6, 6}}, {4, {7, 7}}}},
                  {Eigen::Vector3d::Zero(), {{1, {8, 8}}}}};
  leave_out_far_views(&scene);
  ASSERT_EQ(scene.views.size(), 4u);
  ASSERT_EQ(scene.points[0].sights.size(), 2u);
  EXPECT_EQ(scene.points[0].sights[0].view, 0);
  EXPECT_EQ(scene.points[0].sights[1].view, 3);
  EXPECT_EQ(scene.points[0].sights[1].pixel, Eigen::Vector2d(7, 7));
  EXPECT_THAT(scene.points[1].sights, IsEmpty());
}

TEST(OpenScene, PosesThatAreAlmostRotationsAreMadeRotations) {
  const TempFolder folder;
  write_image(folder, "color/a.png");
  folder.write("meta_data.json",
               abc_scene(abc_frame("a.png", "[[1,2e-4,0,4],[0,1,0,5],[0,0,1.0001,6],[0,0,0,1]]")));
  const View view = open_scene(folder.path()).views.at(0);
  const Eigen::Matrix3d R = view.cam_from_world.rotation;
  EXPECT_TRUE((R * R.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-14));
  EXPECT_TRUE(R.isApprox(Eigen::Matrix3d::Identity(), 2e-4));
  EXPECT_NEAR(R(0, 1), -1e-4, 1e-7) << "half of the shear is a turn";
  EXPECT_TRUE(view.center_in_world().isApprox(Eigen::Vector3d(4, 5, 6), 1e-12))
      << "the centre stays where it is";
}

TEST(OpenScene, BrokenImagesAreFoundWhenTheyAreReadAndNotBefore) {
  const TempFolder folder;
  write_image(folder, "color/a.png");
  folder.write("color/b.png", bytes_of(folder.file("color/a.png")).substr(0, 50));
  write_png(folder.file("color/c.png"), Image<float>(17, 12));
  folder.write("meta_data.json",
               abc_scene(abc_frame("a.png") + "," + abc_frame("b.png") + "," + abc_frame("c.png")));
  const Scene scene = open_scene(folder.path());
  ASSERT_EQ(scene.views.size(), 3u);
  EXPECT_NO_THROW(read_picture(scene.views[0]));
  EXPECT_THROW(read_picture(scene.views[1]), InputError);
  EXPECT_THROW(read_picture(scene.views[2]), InputError) << "not of the size of its camera";
}

TEST(OpenScene, EqualFileNamesInTwoFoldersStayApart) {
  const TempFolder folder;
  write_image(folder, "color/left/0.png");
  write_image(folder, "color/right/0.png");
  folder.write("meta_data.json",
               abc_scene(abc_frame("left/0.png") + "," + abc_frame("right/0.png")));
  const Scene scene = open_scene(folder.path());
  ASSERT_EQ(scene.views.size(), 2u);
  EXPECT_NE(scene.views[0].name, scene.views[1].name);
  EXPECT_EQ(scene.views[1].name.find('/'), std::string::npos);
}

TEST(OpenScene, MissingKeysAreNamed) {
  EXPECT_THAT(error_of("meta_data.json", "{}"), HasSubstr("\"frames\""));
  EXPECT_THAT(
      error_of("meta_data.json", R"({"frames": [{}]})"),
      AllOf(HasSubstr("\"rgb_path\""), HasSubstr("frames[0]"), HasSubstr("meta_data.json")));
  EXPECT_THAT(error_of("meta_data.json", R"({"frames": [{"rgb_path": "a.png"}]})"),
              HasSubstr("\"intrinsics\""));
  EXPECT_THAT(
      error_of("meta_data.json",
               std::string(R"({"frames": [{"rgb_path": "a.png", "intrinsics":)") + kK3 + "}]}"),
      HasSubstr("\"camtoworld\""));
  EXPECT_THAT(error_of("transforms_train.json", R"({"frames": [{}]})"), HasSubstr("\"file_path\""));
  EXPECT_THAT(error_of("transforms_train.json", R"({"frames": [{"file_path": "train/a"}]})"),
              HasSubstr("\"transform_matrix\""));
  EXPECT_THAT(error_of("transforms_train.json",
                       std::string(R"({"frames": [{"file_path": "train/a", "transform_matrix":)") +
                           kOpenGl + "}]}"),
              HasSubstr("\"camera_angle_x\""));
}

TEST(OpenScene, ValuesOfTheWrongKindAreNamed) {
  EXPECT_THAT(error_of("meta_data.json", "[]"), HasSubstr("\"frames\""));
  EXPECT_THAT(error_of("meta_data.json", R"({"frames": 3})"), HasSubstr("an array in frames"));
  EXPECT_THAT(error_of("meta_data.json", R"({"frames": [{"rgb_path": 7}]})"),
              HasSubstr("a text in frames[0].rgb_path, found 7"));
  EXPECT_THAT(error_of("meta_data.json", abc_scene(abc_frame("a.png", "[[1,0],[0,1]]"))),
              HasSubstr("a 4 x 4 matrix in frames[0].camtoworld"));
  EXPECT_THAT(error_of("meta_data.json", abc_scene(abc_frame("a.png", kOpenCv, "[[1,0,\"x\"]]"))),
              HasSubstr("a 3 x 3 matrix in frames[0].intrinsics"));
  EXPECT_THAT(error_of("meta_data.json", R"({"width": -4, "height": 3, "frames": []})"),
              HasSubstr("width, found -4"));
  EXPECT_THAT(
      error_of("meta_data.json", R"({"worldtogt": [[NaN,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})"),
      HasSubstr("finite numbers in worldtogt"));
}

TEST(OpenScene, WhatIsNoJsonIsSaidInOneLineWithItsPath) {
  EXPECT_THAT(error_of("meta_data.json", "{\"frames\": [\n\n{]}"),
              AllOf(HasSubstr("meta_data.json"), HasSubstr("a JSON file")));
  EXPECT_THAT(error_of("transforms_train.json", ""),
              AllOf(HasSubstr("transforms_train.json"), HasSubstr("a JSON file")));
  EXPECT_THAT(error_of("meta_data.json", "\xff\xfe binary \x01"), HasSubstr("a JSON file"));
}

TEST(OpenScene, BracketsByTheThousandAreSaidInOneLine) {
  const std::string open(200000, '['), close(200000, ']');
  for (const std::string& text : {open, open + close, "{\"frames\": " + open + close + "}",
                                  "{\"frames\": [{\"rgb_path\": " + open + close + "}]}"})
    EXPECT_THAT(error_of("meta_data.json", text),
                AllOf(HasSubstr("meta_data.json"), HasSubstr("at most 100 arrays"),
                      HasSubstr("found 20000")));
  EXPECT_THAT(error_of("meta_data.json", "{\"frames\": \"" + open + "\"}"),
              HasSubstr("an array in frames"))
      << "brackets in texts are harmless";
}

TEST(OpenScene, WordsLikeNanInsideOfTextAreLeftAlone) {
  const TempFolder folder;
  write_image(folder, "color/NaN \\\" NaN.png");
  folder.write("meta_data.json",
               abc_scene(abc_frame(R"(NaN \\\" NaN.png)"), R"("radius": -Infinity,)"));
  EXPECT_EQ(open_scene(folder.path()).views.at(0).name, "NaN \\\" NaN.png");
}

TEST(OpenScene, WithoutAnyUsableFrameThereIsNoScene) {
  EXPECT_THAT(error_of("meta_data.json", abc_scene("")), HasSubstr("no frame"));
  EXPECT_THAT(error_of("meta_data.json", abc_scene(abc_frame("none.png"))), HasSubstr("none.png"));
}

TEST(OpenScene, FoldersThatAreNoScenesAreRefused) {
  const TempFolder folder;
  EXPECT_THROW(open_scene(folder.path() + "/none"), InputError);
  EXPECT_THROW(open_scene(folder.path()), InputError);
  EXPECT_THROW(open_scene(folder.write("file", "x")), InputError);
  EXPECT_THROW(open_scene(""), InputError);
  EXPECT_THROW(open_scene(folder.path(), "abc-nef"), InputError);
  EXPECT_THROW(open_scene(folder.path(), "no such format"), InputError);
}

TEST(OpenScene, TheFormatCanBeForced) {
  const TempFolder folder;
  write_image(folder, "color/a.png");
  write_image(folder, "train/b.png");
  folder.write("meta_data.json", abc_scene(abc_frame("a.png")));
  folder.write("transforms_train.json",
               std::string(R"({"camera_angle_x": 1, "frames": [{"file_path": "train/b", )") +
                   R"("transform_matrix": )" + kOpenGl + "}]}");
  EXPECT_EQ(open_scene(folder.path()).views.at(0).name, "a.png");
  EXPECT_EQ(open_scene(folder.path(), "nerf").views.at(0).name, "b.png");
  EXPECT_THAT(scene_formats(), ::testing::IsSupersetOf({"abc-nef", "nerf"}));
}

TEST(EdgeMapPath, IgnoresTheCaseOfTheDetector) {
  const TempFolder folder;
  write_image(folder, "color/a b.png");
  write_image(folder, "edge_PidiNet/a b.png");
  folder.write("meta_data.json", abc_scene(abc_frame("a b.png")));
  const Scene scene = open_scene(folder.path());
  EXPECT_EQ(edge_map_path(scene, scene.views[0], "PiDiNet"), folder.file("edge_PidiNet/a b.png"));
  EXPECT_EQ(edge_map_path(scene, scene.views[0], "pidi"), "");
  EXPECT_EQ(edge_map_path(scene, scene.views[0], ""), "");
}

TEST(EdgeMapPath, IsPngEvenIfTheImageIsNot) {
  const TempFolder folder;
  folder.write("color/a.jpg", "not looked at");
  write_image(folder, "edge_x/a.png");
  folder.write("meta_data.json", abc_scene(abc_frame("a.jpg")));
  const Scene scene = open_scene(folder.path());
  EXPECT_EQ(edge_map_path(scene, scene.views[0], "x"), folder.file("edge_x/a.png"));
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/results/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>

#include "pipelines/pages/overlay.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::ElementsAre;

// Looks along +z at the origin from a distance.
View view_from(double distance) {
  View view;
  view.name = "front.png";
  view.camera = {200, 100, 100, 100, 99.5, 49.5};
  view.cam_from_world.translation = {0, 0, distance};
  return view;
}

View view_towards(const Eigen::Vector3d& center) {
  View view = view_from(1);
  view.cam_from_world.translation = -center;  // the rotation does not matter here
  return view;
}

// A line along x through the origin, half a unit to both sides, and a circle above it.
Sketch line_and_circle() {
  Sketch sketch;
  const int a = sketch.add_node({-0.5, 0, 0}), b = sketch.add_node({0.5, 0, 0});
  sketch.add_stroke(StrokeKind::kLine, a, b, {}, {0.9, 12, 0.25, 1e-4});
  sketch.add_stroke(StrokeKind::kCircle, -1, -1, {{0, -0.2, 0}, {0, 0, 0.1}});
  return sketch;
}

json data_of(const std::string& html) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const size_t at = html.find(begin) + begin.size();
  return json::parse(html.substr(at, html.find("</script>", at) - at));
}

struct ExampleRun {
  Reconstruction reconstruction;
  Scene scene;
  json report() const {
    return json::parse(report_json({&reconstruction, &scene, R"({"rounds": 3})"}));
  }
};

TEST(Report, TellsWhatWasDone) {
  ExampleRun run;
  run.reconstruction.sketch = line_and_circle();
  run.scene.views = {view_from(2)};
  run.reconstruction.report.stages = {{"lift", 1.5, 80, "12 points"}};
  run.reconstruction.report.counts = {{"edgels", 4000}};
  run.reconstruction.report.rounds = {{{"strokes", 9}, {"rms_px", 0.5}}, {{"strokes", 2}}};
  run.reconstruction.report.warnings = {"few views"};
  const json report = run.report();
  EXPECT_EQ(report["counts"]["edgels"], 4000);
  EXPECT_EQ(report["counts"]["curves"], 2);
  EXPECT_EQ(report["counts"]["circles"], 1);
  EXPECT_EQ(report["counts"]["junctions"], 2);
  EXPECT_EQ(report["stages"][0],
            json::parse(R"({"name":"lift","seconds":1.5,"peak_mb":80.0,"result":"12 points"})"));
  EXPECT_EQ(report["rounds"], json::parse(R"([{"strokes":9,"rms_px":0.5},{"strokes":2}])"));
  EXPECT_EQ(report["warnings"], json::parse(R"(["few views"])"));
  EXPECT_EQ(report["options"], json::parse(R"({"rounds": 3})"));
  EXPECT_GE(report["threads"], 1);
  EXPECT_GT(report["peak_mb"], 1);
  EXPECT_GE(report["seconds"], 0);
}

TEST(Report, EmptySketchStillHasAReportAndAPage) {
  ExampleRun run;
  const Sketch none;
  const json report = run.report();
  EXPECT_EQ(report["counts"]["curves"], 0);
  EXPECT_TRUE(data_of(report_html(report.dump(), {&none}))["curves"].empty());
}

TEST(Report, NamesThatAreNoUtf8AreShownAnyway) {
  ExampleRun run;
  run.scene.folder = "part\xff";
  EXPECT_EQ(run.report()["scene"]["folder"], "part\xEF\xBF\xBD");
}

TEST(ReportPage, NoTextOfTheSceneEndsTheScript) {
  ExampleRun run;
  run.scene.folder = "</script><script>alert(1)</script><!--";
  const Sketch none;
  View view = view_from(2);
  view.name = "</SCRIPT>";
  const std::string html = report_html(run.report().dump(), {&none, {{view, "jpeg"}}});
  EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(html.find("</SCRIPT>"), std::string::npos);
  EXPECT_EQ(data_of(html)["report"]["scene"]["folder"], run.scene.folder);
}

TEST(ReportPage, NeedsNothingButItself) {
  ExampleRun run;
  const Sketch sketch = line_and_circle();
  const std::string html = report_html(run.report().dump(), {&sketch});
  EXPECT_FALSE(std::regex_search(html, std::regex("https?://|src=\"|<link|@import|@DATA@")));
}

TEST(ReportPage, ImagesAreEmbeddedAsBase64) {
  ExampleRun run;
  const auto encoded = [&](const std::string& bytes) {
    const Sketch none;
    const json data = data_of(report_html(run.report().dump(), {&none, {{view_from(2), bytes}}}));
    return data["photos"][0]["jpeg"];
  };
  EXPECT_EQ(encoded(""), "");  // RFC 4648, section 10
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded(std::string("\x00\xff", 2)), "AP8=");
}

TEST(ReportPage, CurvesFillTheUnitBoxWhateverTheUnits) {
  for (const double unit : {1e-3, 1.0, 1e3}) {
    Sketch sketch = line_and_circle();
    sketch.nodes = (sketch.nodes * unit).colwise() + Eigen::Vector3d(7, 8, 9) * unit;
    sketch.handles *= unit;
    sketch.handles.col(0) += Eigen::Vector3d(7, 8, 9) * unit;
    ExampleRun run;
    const json curves = data_of(report_html(run.report().dump(), {&sketch}))["curves"];
    ASSERT_EQ(curves.size(), 2u);
    const std::vector<double> line = curves[0]["points"];
    ASSERT_EQ(line.size(), 6u);
    EXPECT_NEAR(line[0], -0.5, 1e-6);
    EXPECT_NEAR(line[3], 0.5, 1e-6);
    EXPECT_EQ(curves[0]["support_views"], 12);
    EXPECT_NEAR(curves[0]["length"], unit, 1e-9 * unit);
  }
}

TEST(ReportPage, TellsHowTheCameraAndItsLensSee) {
  ExampleRun run;
  const Sketch sketch = line_and_circle();
  View view = view_from(2);
  Lens::Terms terms;
  terms.k1 = 0.1, terms.p2 = 0.02;
  view.lens = Lens(LensModel::kOpencv, terms);
  const json data = data_of(report_html(run.report().dump(), {&sketch, {{view, ""}}}));
  const json& photo = data["photos"][0];
  EXPECT_EQ(photo["size"], json::parse("[200, 100]"));
  EXPECT_EQ(photo["camera"], json::parse("[100.0, 100.0, 99.5, 49.5]"));
  EXPECT_EQ(photo["translation"], json::parse("[0.0, 0.0, 2.0]"));
  EXPECT_EQ(photo["lens"], json::parse("[0.1, 0.0, 0.0, 0.02, 0.0, 0.0, 0.0, 0.0]"));
  EXPECT_EQ(photo["fisheye"], false);
  EXPECT_NEAR(data["extent"]["size"].get<double>(), 1, 1e-6);
}

// Views all around the origin, of pictures that JPEG can hardly shrink.
TEST(PagePhotos, FitIntoAPageHoweverManyThereAre) {
  const TempFolder folder;
  Picture noise;
  noise.red = noise.green = noise.blue = Image<float>(320, 200);
  std::mt19937 random(1);
  for (float& v : noise.red.data) v = float(random() % 256) / 255;
  noise.green.data.assign(noise.red.data.rbegin(), noise.red.data.rend());
  write_png(folder.file("noise.png"), noise);
  Scene scene;
  for (int k = 0; k < 150; ++k) {
    scene.views.push_back(view_towards({std::cos(k), std::sin(k), 0.1}));
    scene.views.back().image_path = folder.file("noise.png");
    scene.views.back().camera = {320, 200, 100, 100, 159.5, 99.5};
  }
  scene.views[7].image_path = folder.file("missing.png");
  const std::vector<PagePhoto> photos = PhotoAlbum(scene, {0, 0, 0}).photos(scene.views);
  size_t bytes = 0;
  for (const PagePhoto& photo : photos) bytes += photo.jpeg.size();
  EXPECT_GT(photos.size(), 20u);
  EXPECT_LE(photos.size(), 100u);
  EXPECT_LE(bytes, kMostPhotoBytes);
  const std::string path = folder.write("photo.jpg", photos[0].jpeg);
  EXPECT_NEAR(double(read_image_size(path).width) / read_image_size(path).height, 1.6, 0.05);
}

TEST(PagePhotos, ShowThePictureOnWhite) {
  const TempFolder folder;
  Picture picture;
  picture.red = picture.green = picture.blue = Image<float>(64, 32, 0.2f);
  picture.alpha = Image<float>(64, 32, 0.0f);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) picture.alpha.at(x, y) = 1;
  write_png(folder.file("a.png"), picture);
  Scene scene;
  scene.views = {view_from(2)};
  scene.views[0].image_path = folder.file("a.png");
  scene.views[0].camera = {64, 32, 50, 50, 31.5, 15.5};
  const std::vector<PagePhoto> photos = PhotoAlbum(scene, {0, 0, 0}).photos(scene.views);
  ASSERT_EQ(photos.size(), 1u);
  const Picture back = read_picture(folder.write("a.jpg", photos[0].jpeg));
  ASSERT_EQ(back.width(), 64);
  EXPECT_NEAR(back.red.at(8, 16), 0.2, 0.05);
  EXPECT_NEAR(back.red.at(56, 16), 1, 0.05);
}

TEST(PagePhotos, AreCopiesOfWhatOthersRead) {
  const TempFolder folder;
  Picture picture;
  picture.red = picture.green = picture.blue = Image<float>(64, 32, 0.2f);
  write_png(folder.file("a.png"), picture);
  Scene scene;
  scene.views = {view_from(2), view_from(3), view_from(4)};
  for (View& view : scene.views) {
    view.image_path = folder.file("a.png");
    view.camera = {64, 32, 50, 50, 31.5, 15.5};
  }
  for (int k = 0; k < 3; ++k) scene.views[k].name = std::to_string(k);
  const PhotoAlbum album(scene, {0, 0, 0});
  const Scene watched = album.watched();
  read_picture(watched.views[0], 2);  // too small for a photograph
  read_picture(watched.views[1]);
  picture.red = picture.green = picture.blue = Image<float>(64, 32, 0.8f);
  write_png(folder.file("a.png"), picture);
  read_picture(watched.views[1]);  // once is enough
  std::vector<View> known = {scene.views[0], scene.views[1]};
  known[1].camera.fx = 51;
  const std::vector<PagePhoto> photos = album.photos(known);
  ASSERT_EQ(photos.size(), 2u);
  const auto brightness = [&](const PagePhoto& photo) {
    return read_picture(folder.write("a.jpg", photo.jpeg)).red.at(8, 16);
  };
  EXPECT_NEAR(brightness(photos[0]), 0.8, 0.05);  // read late
  EXPECT_NEAR(brightness(photos[1]), 0.2, 0.05);
  EXPECT_EQ(photos[1].view.camera.fx, 51);
}

TEST(Extent, LooksAtTheCurveAndNotAtItsControlPoints) {
  Sketch sketch;
  const int a = sketch.add_node({0, 0, 0}), b = sketch.add_node({1, 0, 0});
  sketch.add_stroke(StrokeKind::kBezier, a, b, {{0, 4, 0}, {1, 4, 0}});
  EXPECT_NEAR(sketch_extent(sketch).size, 3, 0.01);  // the apex is at 3/4 of the handles
  EXPECT_EQ(sketch_extent({}).size, 0);
}

TEST(Overlay, LineIsDrawnWhereTheCameraSeesIt) {
  const View view = view_from(2);  // 50 px per unit: x from 74.5 to 124.5 on row 49.5
  const Picture overlay = draw_overlay(painted_curves(line_and_circle()), view, {});
  ASSERT_EQ(overlay.width(), 200);
  ASSERT_EQ(overlay.height(), 100);
  const auto is_blue = [&](int x, int y) {
    return overlay.blue.at(x, y) > overlay.red.at(x, y) + 0.3f;
  };
  EXPECT_TRUE(is_blue(100, 49) && is_blue(100, 50));
  EXPECT_TRUE(is_blue(77, 49) && is_blue(122, 50));
  EXPECT_FALSE(is_blue(70, 49) || is_blue(129, 50) || is_blue(100, 46) || is_blue(100, 53));
}

TEST(Overlay, PictureIsPaledAndItsAlphaBecomesWhite) {
  Picture picture;
  picture.red = picture.green = picture.blue = Image<float>(200, 100, 0.0f);
  picture.alpha = Image<float>(200, 100, 1.0f);
  picture.alpha.at(5, 5) = 0;
  const Picture overlay = draw_overlay({}, view_from(2), picture);
  EXPECT_NEAR(overlay.red.at(0, 0), 0.45, 0.01);
  EXPECT_NEAR(overlay.red.at(5, 5), 1, 0.01);
}

TEST(Overlay, CurvesAreDrawnWhereTheLensShowsThem) {
  View view = view_from(2);
  Lens::Terms terms;
  terms.k1 = 0.8, terms.p1 = 0.4;  // 12.5 pixels down at the ends, none in the middle
  view.lens = Lens(LensModel::kOpencv, terms);
  Sketch sketch;
  const int a = sketch.add_node({-1, 0, 0}), b = sketch.add_node({1, 0, 0});
  sketch.add_stroke(StrokeKind::kLine, a, b, {});
  const Picture overlay = draw_overlay(painted_curves(sketch), view, {});
  const auto is_blue = [&](double x, double y) {
    const int u = int(std::lround(x)), v = int(std::lround(y));
    return overlay.blue.at(u, v) > overlay.red.at(u, v) + 0.3f;
  };
  for (double x = -0.9; x < 0.95; x += 0.1) {
    double depth;
    Eigen::Vector2d ideal = view.project({x, 0, 0}, &depth), image;
    ASSERT_TRUE(view.image_pixel(ideal, &image));
    EXPECT_TRUE(is_blue(image.x(), image.y())) << x;
    if (std::abs(x) < 0.6) continue;
    EXPECT_FALSE(is_blue(ideal.x(), ideal.y())) << x;
  }
}

TEST(Overlay, CurvesBehindTheCameraAreLeftOut) {
  const Picture behind = draw_overlay(painted_curves(line_and_circle()), view_from(-2), {});
  EXPECT_THAT(behind.red.data, testing::Each(testing::FloatEq(1)));
  Sketch through;  // from far behind the camera to in front of it
  const int a = through.add_node({0.1, 0.1, -1e6}), b = through.add_node({0, 0, 2});
  through.add_stroke(StrokeKind::kLine, a, b, {});
  EXPECT_NO_THROW(draw_overlay(painted_curves(through), view_from(0), {}));
}

TEST(SpreadViews, PicksOppositeDirectionsFirst) {
  const std::vector<View> views = {view_towards({1, 0, 0}), view_towards({0.9, 0.1, 0}),
                                   view_towards({0, 1, 0}), view_towards({-1, 0, 0})};
  EXPECT_THAT(spread_views(views, {0, 0, 0}, 2), ElementsAre(0, 3));
  EXPECT_THAT(spread_views(views, {0, 0, 0}, 3), ElementsAre(0, 2, 3));
  EXPECT_THAT(spread_views(views, {0, 0, 0}, 9), ElementsAre(0, 1, 2, 3));
  EXPECT_TRUE(spread_views(views, {0, 0, 0}, 0).empty());
  EXPECT_TRUE(spread_views({}, {0, 0, 0}, 4).empty());
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "pipelines/overlay.h"

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
  const json report = run.report();
  EXPECT_EQ(report["counts"]["curves"], 0);
  EXPECT_TRUE(data_of(report_html(report.dump(), {}, {}))["curves"].empty());
}

TEST(Report, NamesThatAreNoUtf8AreShownAnyway) {
  ExampleRun run;
  run.scene.folder = "part\xff";
  EXPECT_EQ(run.report()["scene"]["folder"], "part\xEF\xBF\xBD");
}

TEST(ReportPage, NoTextOfTheSceneEndsTheScript) {
  ExampleRun run;
  run.scene.folder = "</script><script>alert(1)</script><!--";
  const std::string html = report_html(run.report().dump(), {}, {{"</SCRIPT>", "png"}});
  EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(html.find("</SCRIPT>"), std::string::npos);
  EXPECT_EQ(data_of(html)["report"]["scene"]["folder"], run.scene.folder);
}

TEST(ReportPage, NeedsNothingButItself) {
  ExampleRun run;
  const std::string html = report_html(run.report().dump(), line_and_circle(), {});
  EXPECT_FALSE(std::regex_search(html, std::regex("https?://|src=\"|<link|@import|@DATA@")));
}

TEST(ReportPage, ImagesAreEmbeddedAsBase64) {
  ExampleRun run;
  const auto encoded = [&](const std::string& bytes) {
    return data_of(report_html(run.report().dump(), {}, {{"a", bytes}}))["overlays"][0]["png"];
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
    const json curves = data_of(report_html(run.report().dump(), sketch, {}))["curves"];
    ASSERT_EQ(curves.size(), 2u);
    const std::vector<double> line = curves[0]["points"];
    ASSERT_EQ(line.size(), 6u);
    EXPECT_NEAR(line[0], -0.5, 1e-6);
    EXPECT_NEAR(line[3], 0.5, 1e-6);
    EXPECT_EQ(curves[0]["support_views"], 12);
    EXPECT_NEAR(curves[0]["length"], unit, 1e-9 * unit);
  }
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
  const Picture overlay = draw_overlay(line_and_circle(), view, {});
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
  const Picture overlay = draw_overlay(Sketch(), view_from(2), picture);
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
  const Picture overlay = draw_overlay(sketch, view, {});
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

TEST(Overlay, LargePicturesAreReduced) {
  const Picture overlay = draw_overlay(line_and_circle(), view_from(2), {}, 50);
  EXPECT_EQ(overlay.width(), 50);
  EXPECT_EQ(overlay.height(), 25);
  EXPECT_GT(overlay.blue.at(20, 12), overlay.red.at(20, 12) + 0.1f);
}

TEST(Overlay, CurvesBehindTheCameraAreLeftOut) {
  const Picture behind = draw_overlay(line_and_circle(), view_from(-2), {});
  EXPECT_THAT(behind.red.data, testing::Each(testing::FloatEq(1)));
  Sketch through;  // from far behind the camera to in front of it
  const int a = through.add_node({0.1, 0.1, -1e6}), b = through.add_node({0, 0, 2});
  through.add_stroke(StrokeKind::kLine, a, b, {});
  EXPECT_NO_THROW(draw_overlay(through, view_from(0), {}));
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

TEST(SpreadViews, AViewAtTheTargetDoesNoHarm) {
  const std::vector<View> views = {view_towards({0, 0, 0}), view_towards({0, 0, 0})};
  EXPECT_THAT(spread_views(views, {0, 0, 0}, 2), ElementsAre(0, 1));
}

}  // namespace
}  // namespace sketchsplat

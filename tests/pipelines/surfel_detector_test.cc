// SPDX-License-Identifier: MIT
#include "pipelines/detectors/surfel_detector.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <filesystem>

#include "datasets/types/errors.h"
#include "datasets/types/geometry_maps.h"
#include "eval/metrics/edge_maps.h"
#include "eval/metrics/map_errors.h"
#include "pipelines/method/leave_out.h"
#include "tests/pipelines/rendered_part.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

// A part (a plate with a round hole), with its truth; small.
struct Rendered {
  TempFolder folder;
  Scene scene;
  Rendered(Style style, int views, int resolution, const std::string& part = "box-hole") {
    SynthesizeOptions options;
    options.part = part;
    options.seed = 2;
    options.rig.views = views;
    options.rig.resolution = resolution;
    options.rig.object_size = 0.6;
    options.render.style = style;
    options.render.noise = 2;
    options.outputs = "all";
    write_scene(synthesize(options), folder.path());
    scene = open_scene(folder.path());
  }
};

DetectionOptions small_options(int renderings) {
  DetectionOptions options;
  options.detector = "2dgs-sn";
  options.surfels.renderings = renderings;
  options.surfels.surfels = 700;
  options.surfels.most_surfels = 1200;
  options.surfels.batch = 2;  // more steps for the same time
  options.surfels.hull.cells = 64;
  return options;
}

// Means over the views.
struct Worth {
  EdgeMapScore edges;
  MapErrors maps;
};

Worth worth(const Scene& scene, const DetectionOptions& options) {
  const std::unique_ptr<Detector> detector = make_detector(options);
  const std::vector<Detection> found = detect_all(scene, detector.get(), {});
  Worth sum;
  const double n = double(found.size());
  for (size_t v = 0; v < found.size(); ++v) {
    const View& view = scene.views[v];
    const std::vector<Edgel>& edgels = found[v].map.edgels;
    Eigen::Matrix2Xd points(2, edgels.size());
    for (size_t k = 0; k < edgels.size(); ++k) points.col(k) << edgels[k].x, edgels[k].y;
    const EdgeMapScore s = score_edge_points(
        points, read_edge_polylines(file_of_view(scene.folder + "/edges_visible", view, ".json")),
        1.5);
    sum.edges.precision += s.precision / n, sum.edges.f += s.f / n;
    GeometryMaps maps;
    if (!detector->geometry(scene, view, &maps)) continue;
    const MapErrors e = score_geometry(maps, read_geometry_maps(scene, view), view.camera);
    sum.maps.normal_deg += e.normal_deg / n, sum.maps.depth_px += e.depth_px / n;
    sum.maps.covered += e.covered / n;
  }
  return sum;
}

TEST(SurfelDetector, FindsEdgesOfTheShapeBelowItsPrint) {
  const Rendered part(Style::kTextured, 16, 160);
  const Worth surfels = worth(part.scene, small_options(300));
  DetectionOptions image;
  const Worth pictures = worth(part.scene, image);
  RecordProperty("normal_deg", std::to_string(surfels.maps.normal_deg));
  RecordProperty("depth_px", std::to_string(surfels.maps.depth_px));
  RecordProperty("f", std::to_string(surfels.edges.f));
  RecordProperty("precision", std::to_string(surfels.edges.precision));
  EXPECT_LT(surfels.maps.normal_deg, 12);
  EXPECT_LT(surfels.maps.depth_px, 1.5);
  EXPECT_GT(surfels.maps.covered, 0.95);
  EXPECT_GT(surfels.edges.f, 0.75);
  EXPECT_GT(surfels.edges.precision, pictures.edges.precision + 0.25);
}

TEST(SurfelDetector, TheWholeMethodFindsTheCurvesOfAPrintedPart) {
  const Rendered part(Style::kTextured, 16, 160);
  const DetectionOptions small = small_options(300);
  ReconstructOptions options;
  static_cast<DetectionOptions&>(options) = small;
  options.solid = "off";
  const Sketch sketch = reconstruct(part.scene, options, nullptr).sketch;
  const double f5 = test::f_at(test::score(sketch, part.scene.folder).fine, 0.005);
  RecordProperty("f5", std::to_string(f5));
  EXPECT_GT(f5, 82) << "87.5 when this was written";
}

TEST(SurfelDetector, FindsTheShapeOfPlainFaces) {
  const Rendered part(Style::kPlain, 16, 160);
  const Worth plain = worth(part.scene, small_options(300));
  RecordProperty("normal_deg", std::to_string(plain.maps.normal_deg));
  RecordProperty("f", std::to_string(plain.edges.f));
  EXPECT_LT(plain.maps.normal_deg, 12.5);
  EXPECT_GT(plain.edges.f, 0.85);
}

// Nothing but its edges tells how deep the floor lies: no mask shows it, all of it has one grey.
TEST(SurfelDetector, StartsOnTheFloorOfAPlainPocket) {
  const Rendered part(Style::kPlain, 60, 240, "tray");
  DetectionOptions with;
  with.detector = "2dgs-sn";
  with.surfels.renderings = 2;
  with.surfels.surfels = 3000;
  DetectionOptions without = with;
  without.surfels.hull.sights = 0;
  const Worth seen = worth(part.scene, with), blind = worth(part.scene, without);
  RecordProperty("depth_px", std::to_string(seen.maps.depth_px));
  RecordProperty("depth_px_without", std::to_string(blind.maps.depth_px));
  EXPECT_LT(seen.maps.depth_px, 0.5);
  EXPECT_LT(seen.maps.normal_deg, 0.75 * blind.maps.normal_deg);
}

TEST(SurfelDetector, GivesTheSameBytesForAnyNumberOfThreads) {
  const Rendered part(Style::kTextured, 8, 120);
  std::string bytes[2];
  std::vector<float> edges[2];
  const int before = omp_get_max_threads();
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    const std::unique_ptr<Detector> detector = make_detector(small_options(40));
    for (const Detection& d : detect_all(part.scene, detector.get(), {}))
      for (const Edgel& e : d.map.edgels)
        edges[threads / 2].insert(edges[threads / 2].end(), {e.x, e.y, e.nx, e.ny});
    bytes[threads / 2] = detector->surfels();
  }
  omp_set_num_threads(before);
  EXPECT_FALSE(bytes[0].empty());
  EXPECT_TRUE(bytes[0] == bytes[1]);
  EXPECT_FALSE(edges[0].empty());
  EXPECT_TRUE(edges[0] == edges[1]);
}

TEST(SurfelDetector, SaysWhatIsMissing) {
  const Rendered part(Style::kPlain, 4, 100);
  for (const View& v : part.scene.views) std::filesystem::remove(v.image_path);
  EXPECT_THROW(make_detector(small_options(8))->prepare(part.scene, {}), InputError);
}

EdgelMap line_at(float y, int from, int to) {
  EdgelMap map;
  map.width = map.height = 100;
  map.chain = {0, to - from};
  for (int x = from; x < to; ++x) {
    Edgel e;
    e.x = float(x), e.y = y, e.nx = 0, e.ny = 1;
    map.edgels.push_back(e);
  }
  build_lookup(&map, 4);
  return map;
}

TEST(SnapEdgels, PictureSaysWhereAndGeometryWhether) {
  const EdgelMap picture = line_at(50, 10, 40), geometry = line_at(51.5f, 20, 80);
  const EdgelMap both = snap_edgels(geometry, picture, {}, false, 3);
  int of_picture = 0, of_geometry = 0;
  for (const Edgel& e : both.edgels) {
    of_picture += e.y == 50;
    of_geometry += e.y == 51.5f && e.x > 39;
  }
  EXPECT_NEAR(of_picture, 22, 2);  // not 10..17, where there is no geometry
  EXPECT_NEAR(of_geometry, 39, 3);
  EXPECT_EQ(of_picture + of_geometry, int(both.edgels.size()));
  EXPECT_TRUE(snap_edgels(line_at(80, 0, 0), picture, {}, false, 3).edgels.empty());
}

TEST(SnapEdgels, WhatTracksTellCountsMore) {
  const EdgelMap picture = line_at(50, 10, 80), geometry = line_at(51.5f, 20, 80);
  std::vector<EdgeKind> kinds(70, EdgeKind::kUnknown);
  std::fill(kinds.begin(), kinds.begin() + 6, EdgeKind::kShape);        // 10..15
  std::fill(kinds.begin() + 30, kinds.begin() + 50, EdgeKind::kPrint);  // 40..59
  for (const bool even : {false, true}) {
    int known = 0, unknown = 0, print = 0;
    for (const Edgel& e : snap_edgels(geometry, picture, kinds, even, 3).edgels) {
      known += e.y == 50 && e.x < 16;
      unknown += e.y == 50 && e.x >= 16 && e.x < 17;  // no geometry within three pixels
      print += e.y == 50 && e.x >= 40 && e.x < 60;
    }
    EXPECT_EQ(known, 6);
    EXPECT_EQ(unknown, even);
    EXPECT_EQ(print, 0);
  }
}

// Knows that there is print beyond x = 0.3 and edges up to 0.1, and nothing of what is between.
class Knowing : public Detector {
 public:
  EdgelMap detect(const Scene&, const View&) const override { return {}; }
  std::vector<EdgeKind> judge(const CurvePoints& curves) const override {
    std::vector<EdgeKind> kinds;
    for (int i = 0; i < curves.position.cols(); ++i) {
      const double x = curves.position(0, i);
      kinds.push_back(x > 0.3 ? EdgeKind::kPrint : x < 0.1 ? EdgeKind::kShape : EdgeKind::kUnknown);
    }
    return kinds;
  }
};

TEST(DropPrint, StrokesGoOfWhichMostThatIsKnownIsPrint) {
  Sketch sketch;
  const int edge = test::add_line(&sketch, {0, 0, 0}, {0.35, 0, 0});
  test::add_line(&sketch, {0.05, 1, 0}, {1, 1, 0});
  const int unknown = test::add_line(&sketch, {0.15, 2, 0}, {0.25, 2, 0});
  EdgeWorld world;
  world.footprint = 0.01;
  RunReport report;
  const Sketch left = drop_print(sketch, world, Knowing(), {&report});
  ASSERT_EQ(left.size(), 2);
  EXPECT_NEAR(test::point_at(left, 0, 0.5).y(), test::point_at(sketch, edge, 0.5).y(), 1e-9);
  EXPECT_NEAR(test::point_at(left, 1, 0.5).y(), test::point_at(sketch, unknown, 0.5).y(), 1e-9);
  ASSERT_EQ(report.counts.size(), 1u);
  EXPECT_EQ(report.counts[0].second, 1);
  EXPECT_EQ(drop_print(left, world, Knowing(), {&report}).size(), 2);
  EXPECT_EQ(drop_print({}, world, Knowing(), {&report}).size(), 0);
}

}  // namespace
}  // namespace sketchsplat

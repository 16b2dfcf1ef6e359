// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "datasets/synthetic/render/visibility.h"
#include "edges/depth/geometry_edges.h"
#include "eval/metrics/edge_maps.h"
#include "tests/support/geometry_truth.h"

namespace sketchsplat {
namespace {

SyntheticScene scene_of(const std::string& part) {
  SynthesizeOptions options;
  options.part = part;
  options.seed = 2;
  options.rig.views = 3;
  options.rig.resolution = 480;
  return synthesize(options);
}

// Mean over the views, within 1.5 px of the visible true edges.
EdgeMapScore score(const SyntheticScene& scene, const test::Degradation* degradation) {
  EdgeMapScore mean;
  const int n = int(scene.views.size());
  for (int k = 0; k < n; ++k) {
    const View& view = scene.unit_views[k];
    GeometryMaps maps = test::exact_maps(scene, k);
    if (degradation) maps = test::degraded(maps, view.camera, *degradation, 7 + k);
    const EdgelMap map = geometry_edges(maps, view.camera, {});
    Eigen::Matrix2Xd points(2, map.edgels.size());
    for (size_t i = 0; i < map.edgels.size(); ++i)
      points.col(i) << map.edgels[i].x, map.edgels[i].y;
    const EdgeMapScore s = score_edge_points(
        points, visible_edges(view, scene.tracer, scene.unit_curves, scene.lift).polylines, 1.5);
    mean.precision += s.precision / n, mean.recall += s.recall / n;
    mean.f += s.f / n, mean.rms_px += s.rms_px / n;
  }
  return mean;
}

TEST(GeometryEdges, OfExactMapsAreTheVisibleEdgesOfPlanarAndRoundParts) {
  for (const char* part : {"box-hole", "cut-cylinder", "dome-plate"}) {
    const EdgeMapScore s = score(scene_of(part), nullptr);
    EXPECT_GT(s.f, 0.94) << part << " " << s.precision << " " << s.recall;
    EXPECT_LT(s.rms_px, 0.25) << part;
  }
}

TEST(GeometryEdges, OfBlurredAndNoisyMapsAreNearlyTheSame) {
  const test::Degradation splat;
  for (const char* part : {"box-hole", "u-channel", "dome-plate"}) {
    const EdgeMapScore s = score(scene_of(part), &splat);
    EXPECT_GT(s.f, 0.90) << part << " " << s.precision << " " << s.recall;
    EXPECT_LT(s.rms_px, 0.3) << part;
  }
}

}  // namespace
}  // namespace sketchsplat

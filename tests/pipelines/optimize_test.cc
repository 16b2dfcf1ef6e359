// SPDX-License-Identifier: MIT
#include "pipelines/adjust/optimize.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "tests/raster/reference.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

// A line, an arc and a cubic that share their ends, a circle, an ellipse and an elliptic arc.
Sketch every_kind() {
  Sketch s;
  const int a = s.add_node({0.1, 0.2, 0.5}), b = s.add_node({0.8, 0.25, 0.45});
  const int c = s.add_node({0.7, 0.8, 0.6});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  s.add_stroke(StrokeKind::kArc, b, c, {{0.95, 0.5, 0.55}});
  s.add_stroke(StrokeKind::kBezier, c, a, {{0.5, 0.5, 0.9}, {0.1, 0.7, 0.2}});
  add_circle(&s, {0.4, 0.5, 0.3}, {0.02, 0.05, 0.2});
  s.add_stroke(StrokeKind::kEllipse, -1, -1, {{0.6, 0.5, 0.7}, {0.2, 0.02, 0}, {0, 0.02, 0.1}});
  add_elliptic_arc(&s, {0.3, 0.6, 0.6}, {0.2, 0.05, 0}, {0, 0.02, 0.12}, 0.4, 3.0);
  return s;
}

// Small pictures, so that the plain renderer can be asked for every number.
struct SmallWorld {
  std::vector<View> views;
  std::vector<Image<float>> edges;
  std::vector<EdgeTarget> targets;
  SampleLayout layout;
  Eigen::MatrixXf visibility;
  Drawing drawing;

  SmallWorld() {
    const Sketch truth = moved(every_kind(), {0.015, -0.02, 0.01});
    for (const View& v : ring_of_views(3, kMiddle, 3)) {
      views.push_back(smaller(v, 40));
      edges.push_back(draw_edge_map(ideal_edgels(views.back(), polylines_of(truth)), 1.0));
      targets.push_back(make_edge_target(edges.back()));
    }
    drawing.sketch = every_kind();
    drawing.width = Eigen::VectorXd::LinSpaced(6, 0.03, 0.05);
    drawing.depth = Eigen::VectorXd::LinSpaced(6, 1.4, 0.7);
    layout = plan_samples(drawing.sketch, 0.1);
    visibility = Eigen::MatrixXf::Ones(layout.size(), views.size());
    for (int i = 0; i < layout.size(); ++i) visibility(i, i % 3) = 0.25f * float(i % 4);
  }
  double plain_loss(const Drawing& d) const {
    double sum = 0;
    for (size_t v = 0; v < views.size(); ++v)
      sum += reference_loss(draw_splats(d, layout), visibility.col(v), views[v], edges[v],
                            RasterOptions(), nullptr);
    return sum;
  }
};

TEST(EdgeLoss, IsThatOfThePlainRenderer) {
  const SmallWorld w;
  const double expected = w.plain_loss(w.drawing);
  EXPECT_GT(expected, 5);
  EXPECT_NEAR(edge_loss(w.drawing, w.layout, w.visibility, w.views, w.targets, nullptr), expected,
              1e-4 * expected);
}

// Central differences of the plain renderer against the whole chain backwards: pixels, pictures,
// splats, samples, nodes and handles.
TEST(EdgeLoss, GradientByNodesHandlesWidthsAndDepthsIsThatOfCentralDifferences) {
  const SmallWorld w;
  DrawingGradient g;
  edge_loss(w.drawing, w.layout, w.visibility, w.views, w.targets, &g);
  const auto check = [&](double* x, Drawing* d, double h, double found, double scale,
                         const std::string& what) {
    const double x0 = *x;
    *x = x0 + h;
    const double up = w.plain_loss(*d);
    *x = x0 - h;
    const double down = w.plain_loss(*d);
    *x = x0;
    EXPECT_NEAR(found, (up - down) / (2 * h), 2e-3 * scale + 2e-3 * std::abs(found)) << what;
  };
  Drawing d = w.drawing;
  const double node_scale = g.sketch.nodes.cwiseAbs().maxCoeff();
  const double handle_scale = g.sketch.handles.cwiseAbs().maxCoeff();
  ASSERT_GT(node_scale, 1);
  ASSERT_GT(handle_scale, 1);
  for (int i = 0; i < d.sketch.nodes.size(); ++i)
    check(d.sketch.nodes.data() + i, &d, 1e-5, g.sketch.nodes.data()[i], node_scale,
          "node " + std::to_string(i));
  for (int i = 0; i < d.sketch.handles.size(); ++i)
    check(d.sketch.handles.data() + i, &d, 1e-5, g.sketch.handles.data()[i], handle_scale,
          "handle " + std::to_string(i));
  for (int s = 0; s < d.sketch.size(); ++s) {  // x d/dx = d / d log x
    check(&d.width[s], &d, 1e-6, g.log_width[s] / d.width[s],
          g.log_width.cwiseAbs().maxCoeff() / d.width[s], "width " + std::to_string(s));
    check(&d.depth[s], &d, 1e-5, g.log_depth[s] / d.depth[s],
          g.log_depth.cwiseAbs().maxCoeff() / d.depth[s], "depth " + std::to_string(s));
  }
}

TEST(EdgeLoss, SameForOneAndTwoThreads) {
  const SmallWorld w;
  const int before = omp_get_max_threads();
  DrawingGradient one, two;
  omp_set_num_threads(1);
  const double a = edge_loss(w.drawing, w.layout, w.visibility, w.views, w.targets, &one);
  omp_set_num_threads(2);
  const double b = edge_loss(w.drawing, w.layout, w.visibility, w.views, w.targets, &two);
  omp_set_num_threads(before);
  EXPECT_EQ(a, b);
  EXPECT_EQ(one.sketch.nodes, two.sketch.nodes);
  EXPECT_EQ(one.sketch.handles, two.sketch.handles);
  EXPECT_EQ(one.log_width, two.log_width);
}

TEST(Optimize, LowersTheLossAndBringsALineBackThatIsOnePixelOff) {
  Sketch truth;
  add_line(&truth, {0.2, 0.3, 0.4}, {0.8, 0.4, 0.6});
  const EdgeWorld w = ideal_world(ring_of_views(10, kMiddle, 3), polylines_of(truth));
  OptimizeOptions options;
  options.steps = 40;
  const std::vector<EdgeTarget> targets = make_targets(w, options);
  const Sketch off = moved(truth, w.footprint * Vector3d(0, 0.8, 0.6));
  ASSERT_GT(farthest(off, 0, polylines_of(truth), 0.1), 0.9 * w.footprint);
  const OptimizeResult r = optimize(off, w, targets, options);
  EXPECT_LT(r.final_loss, 0.5 * r.initial_loss);
  EXPECT_GT(r.splats, 30);
  EXPECT_LT(farthest(r.sketch, 0, polylines_of(truth), 0.1), 0.1 * w.footprint);
  EXPECT_GT(r.sketch.evidence[0].opacity, 0.5);
  options.steps = 1;
  const OptimizeResult one = optimize(off, w, targets, options);
  EXPECT_LT(one.final_loss, one.initial_loss) << "the last step counts";
}

// Otherwise the steps go into widths and depths, which are the same for all edges.
TEST(Optimize, ALineThatIsWhereItShouldBeStartsNearTheLeastLoss) {
  Sketch truth;
  add_line(&truth, {0.2, 0.3, 0.4}, {0.8, 0.4, 0.6});
  const EdgeWorld w = ideal_world(ring_of_views(4, kMiddle, 3), polylines_of(truth));
  OptimizeOptions options;
  options.steps = 30;
  const OptimizeResult r = optimize(truth, w, make_targets(w, options), options);
  EXPECT_GT(r.final_loss, 0.5 * r.initial_loss);
}

// A back edge is seen in every other view; in the rest it is hidden and another edge passes beside
// its projection, always on the same side.
struct HiddenEdge {
  Sketch truth;
  EdgeWorld world;

  explicit HiddenEdge(double aside_px) {
    const Vector3d side(0, 0, 1);
    add_line(&truth, {0.2, 0.5, 0.5}, {0.8, 0.5, 0.5});
    const std::vector<View> views = ring_of_views(16, kMiddle, 3);
    std::vector<EdgelMap> maps;
    for (size_t v = 0; v < views.size(); ++v) {
      maps.push_back(ideal_edgels(views[v], polylines_of(truth)));
      if (v % 2 == 0) continue;
      double z;
      const Eigen::Vector2d way =
          views[v].project(kMiddle + 0.1 * side, &z) - views[v].project(kMiddle, &z);
      for (Edgel& e : maps.back().edgels) {
        const float sign = way.x() * e.nx + way.y() * e.ny < 0 ? -1.f : 1.f;
        e.x += sign * float(aside_px) * e.nx;
        e.y += sign * float(aside_px) * e.ny;
      }
      build_lookup(&maps.back(), 4.0);
    }
    world = make_edge_world(views, maps);
  }
  double error_px(bool visibility) const {
    OptimizeOptions options;
    options.steps = 8;
    options.visibility = visibility;
    Sketch s = truth;
    for (int round = 0; round < 3; ++round)
      s = optimize(s, world, make_targets(world, options), options).sketch;
    return farthest(s, 0, polylines_of(truth), 0.1) / world.footprint;
  }
};

TEST(Optimize, AHiddenEdgeIsNotPulledByTheEdgeInFrontOfIt) {
  const HiddenEdge scene(1.7);
  EXPECT_LT(scene.error_px(true), 0.1);
  EXPECT_GT(scene.error_px(false), 0.3) << "nothing pulls: this test shows nothing";
}

TEST(Optimize, LeavesAloneWhatItIsNotAskedOrNotAbleToMove) {
  Sketch truth;
  add_line(&truth, {0.2, 0.3, 0.4}, {0.8, 0.4, 0.6});
  const EdgeWorld w = ideal_world(ring_of_views(6, kMiddle, 3), polylines_of(truth));
  OptimizeOptions options;
  options.steps = 8;
  const std::vector<EdgeTarget> targets = make_targets(w, options);
  EXPECT_EQ(optimize(Sketch(), w, targets, options).sketch.size(), 0);
  Sketch far;
  add_line(&far, {90, 90, 90}, {91, 90, 90});
  EXPECT_EQ(optimize(far, w, targets, options).sketch.nodes, far.nodes);
  options.steps = 0;
  const Sketch off = moved(truth, {0, 0.003, 0});
  EXPECT_EQ(optimize(off, w, targets, options).sketch.nodes, off.nodes);
}

TEST(SampleVisibility, ShortGapsBetweenSightingsAreSeenAndLongOnesAreHidden) {
  Observation o;
  o.layout.first = {0, 12, 14};
  for (int i = 0; i < 14; ++i) o.layout.stroke.push_back(i >= 12), o.layout.t.push_back(0.5);
  for (int i : {1, 4, 9, 13}) o.matches.matches.push_back({i, 1, 0, 0.f, 1.f});
  const Eigen::MatrixXf seen = sample_visibility(o, 2, 2);
  ASSERT_EQ(seen.rows(), 14);
  EXPECT_EQ(seen.col(0).sum(), 0) << "no sighting in the first view";
  Eigen::VectorXf expected = Eigen::VectorXf::Zero(14);
  for (int i : {1, 2, 3, 4, 9, 13}) expected[i] = 1;
  EXPECT_EQ(seen.col(1), expected);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/survey/confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/types/dense.h"
#include "pipelines/adjust/polish.h"
#include "sketches/solve/covariance.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::Matrix3d;
using Eigen::Vector3d;
const Vector3d kMiddle(0.5, 0.5, 0.5);

Sketch line_circle_cubic() {
  Sketch s;
  add_line(&s, {0.3, 0.3, 0.45}, {0.65, 0.27, 0.5});
  // Seen edge-on by none of ten views: both sides would be the nearest edge there.
  add_circle(&s, {0.45, 0.6, 0.5}, {0.094, -0.019, 0.029});
  add_bezier(&s, {0.6, 0.4, 0.4}, {0.65, 0.65, 0.45}, {0.7, 0.5, 0.65}, {0.8, 0.65, 0.6});
  return s;
}

void observed(const EdgeWorld& world, Sketch* sketch) {
  MatchOptions match;
  match.reach_px = 1;
  record_evidence(with_strokes(observe(*sketch, world, match, 3), world, 4), world, match.reach_px,
                  sketch);
}

// Moves every edgel along its normal by chance; the look-up by pixel stays right enough.
EdgeWorld shaken(EdgeWorld world, double sigma_px, std::mt19937* random) {
  std::normal_distribution<double> error(0, sigma_px);
  for (EdgelMap& map : world.maps) {
    for (Edgel& e : map.edgels) {
      const double d = error(*random);
      e.x += float(d * e.nx), e.y += float(d * e.ny);
    }
  }
  return world;
}

// Covariance of the point of a stroke at t, across the stroke.
Matrix3d covariance_at(const Sketch& s, int stroke, double t) {
  const Eigen::MatrixXd C = from_upper_triangle(s.evidence[stroke].covariance);
  const ControlPoints c = control_points(s, stroke);
  Eigen::MatrixXd J(3, 3 * c.count);
  const double h = 1e-6;
  for (int k = 0; k < 3 * c.count; ++k) {
    ControlPoints up = c, down = c;
    up.p[k / 3][k % 3] += h, down.p[k / 3][k % 3] -= h;
    Vector3d p, q, d;
    evaluate_curve<double>(s.strokes[stroke].kind, up.p.data(), t, &p, &d);
    evaluate_curve<double>(s.strokes[stroke].kind, down.p.data(), t, &q, &d);
    J.col(k) = (p - q) / (2 * h);
  }
  Vector3d p, d;
  evaluate_stroke(s, stroke, t, &p, &d);
  d.normalize();
  const Matrix3d across = Matrix3d::Identity() - d * d.transpose();
  return across * J * C * J.transpose() * across;
}

// The claim of the covariance, put to the test: polish again and again under new noise.
TEST(Evidence, CovarianceForetellsTheScatterOfPolishingUnderNoise) {
  const Sketch truth = line_circle_cubic();
  const EdgeWorld clean = ideal_world(ring_of_views(10, kMiddle, 3), polylines_of(truth));
  constexpr int kDraws = 200;
  constexpr double kSigma = 0.15;
  const std::vector<double> places = {0.02, 0.3, 0.5, 0.8, 0.98};
  std::vector<std::vector<Matrix3d>> scatter(3), foretold(3);
  for (auto* m : {&scatter, &foretold})
    for (auto& list : *m) list.assign(places.size(), Matrix3d::Zero());
  std::mt19937 random(7);
  PolishOptions options;
  options.rounds = 2;
  for (int draw = 0; draw < kDraws; ++draw) {
    const EdgeWorld world = shaken(clean, kSigma, &random);
    Sketch s = polish(truth, world, options);
    observed(world, &s);
    for (int i = 0; i < 3; ++i)
      for (size_t k = 0; k < places.size(); ++k) {
        Vector3d p, d, q;
        evaluate_stroke(truth, i, places[k], &p, &d);
        evaluate_stroke(s, i, places[k], &q, &d);
        d.normalize();
        const Vector3d off = q - p - d * d.dot(q - p);
        scatter[i][k] += off * off.transpose() / kDraws;
        foretold[i][k] += covariance_at(s, i, places[k]) / kDraws;
      }
  }
  for (int i = 0; i < 3; ++i)
    for (size_t k = 0; k < places.size(); ++k) {
      const auto is = eigen_symmetric(scatter[i][k]);
      for (int way : {1, 2}) {  // 0 is along the curve
        const Vector3d u = is.vectors.col(way);
        const double ratio = std::sqrt(u.dot(foretold[i][k] * u) / is.values[way]);
        EXPECT_GT(ratio, 0.7) << kind_name(truth.strokes[i].kind) << " at " << places[k];
        EXPECT_LT(ratio, 1.4) << kind_name(truth.strokes[i].kind) << " at " << places[k];
      }
    }
}

TEST(Confidence, IsHighOfWhatTheImagesShowAndLowOfWhatTheyDoNot) {
  const Sketch truth = line_circle_cubic();
  const EdgeWorld world = ideal_world(ring_of_views(10, kMiddle, 3), polylines_of(truth));
  Sketch s = truth;
  add_line(&s, {0.2, 0.2, 0.8}, {0.5, 0.8, 0.8});
  MatchOptions match;
  match.reach_px = 1;
  const StrokeObservation o = with_strokes(observe(s, world, match, 3), world, 4);
  record_evidence(o, world, 1, &s);
  record_confidence(stroke_features(s, world, o), &s);
  for (int i = 0; i < 3; ++i) EXPECT_GT(s.evidence[i].confidence, 0.9) << i;
  EXPECT_LT(s.evidence[3].confidence, 0.1);
  const Sketch sure = keep_confident(s, 0.5);
  EXPECT_EQ(sure.size(), 3);
  EXPECT_EQ(sure.nodes.cols(), truth.nodes.cols());
  s.evidence[3].confidence = std::nan("");
  EXPECT_EQ(keep_confident(s, 0.5).size(), 4) << "unknown stays";
}

TEST(Confidence, RisesWithTheEvidence) {
  StrokeFeatures f;
  f.view_share = 0.6, f.support = 0.7, f.outline = 0.3, f.sigma = 0.5, f.determined = 1;
  f.contrast = 1, f.rms_px = 0.2, f.joined = 0.5;
  for (bool outlines : {false, true}) {
    const double p = probability_of_edge(f, outlines);
    EXPECT_GT(p, 0);
    EXPECT_LT(p, 1);
    for (double StrokeFeatures::*more : {&StrokeFeatures::support, &StrokeFeatures::joined}) {
      StrokeFeatures better = f;
      better.*more += 0.2;
      EXPECT_GT(probability_of_edge(better, outlines), p);
    }
    StrokeFeatures worse = f;
    worse.sigma = 3, worse.rms_px = 0.5;
    EXPECT_LT(probability_of_edge(worse, outlines), p);
    worse = f;
    worse.determined = worse.sigma = worse.support = worse.view_share = 0;
    EXPECT_LT(probability_of_edge(worse, outlines), 0.05) << "no covariance is no certainty";
  }
}

// What calibration gave, for strokes by which every coefficient counts: one that is off by a third
// is off by more than this in one of them. Whoever calibrates anew writes anew.
TEST(Confidence, IsAsItWasCalibrated) {
  StrokeFeatures f;
  f.outline = 0.25, f.sigma = 0.5, f.determined = 1, f.contrast = 2, f.joined = 1, f.support = 0.5;
  f.view_share = 0.6, f.rms_px = 0.25;
  const auto odds = [&](bool outlines) {
    const double p = probability_of_edge(f, outlines);
    return std::log(p / (1 - p));
  };
  EXPECT_NEAR(odds(true), 0.210, 0.01);
  EXPECT_NEAR(odds(false), -2.2406, 0.01);
  f.contrast = 0.25, f.joined = 0.5, f.sigma = 4;
  EXPECT_NEAR(odds(true), -2.761, 0.01);
  EXPECT_NEAR(odds(false), -1.7656, 0.01);
}

TEST(Evidence, NamesTheViewsThatSeeAStroke) {
  const Sketch truth = line_circle_cubic();
  const std::vector<View> views = ring_of_views(8, kMiddle, 3);
  std::vector<EdgelMap> maps;
  for (size_t v = 0; v < views.size(); ++v)
    maps.push_back(ideal_edgels(views[v], v == 2 || v == 5
                                              ? std::vector<Polyline>{polyline_of(truth, 0)}
                                              : polylines_of(truth)));
  Sketch s = truth;
  observed(make_edge_world(views, maps), &s);
  EXPECT_EQ(s.evidence[0].views, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(s.evidence[1].views, (std::vector<int>{0, 1, 3, 4, 6, 7}));
  EXPECT_EQ(s.evidence[1].support_views, 6);
  EXPECT_TRUE(validate(s).empty());
}

}  // namespace
}  // namespace sketchsplat

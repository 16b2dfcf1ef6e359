// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>

#include "datasets/synthetic/cad/curve_kind.h"
#include "datasets/synthetic/cad/parts.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/types/errors.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

Truth truth_of(const std::string& part, std::uint64_t seed = 1) {
  const Brep brep = make_part(part, seed);
  return sharp_edges(brep, unit_frame(brep, part), 1.0);
}

int count(const Sketch& sketch, StrokeKind kind) {
  int n = 0;
  for (const Stroke& s : sketch.strokes) n += s.kind == kind;
  return n;
}

TEST(Truth, BoxHasTwelveLinesOverEightNodesOfThreeEach) {
  const Sketch sketch = truth_of("box").sketch;
  EXPECT_EQ(sketch.size(), 12);
  EXPECT_EQ(count(sketch, StrokeKind::kLine), 12);
  ASSERT_EQ(sketch.nodes.cols(), 8);
  std::vector<int> valence(8);
  for (const Stroke& s : sketch.strokes) ++valence[s.begin], ++valence[s.end];
  EXPECT_THAT(valence, testing::Each(3));
}

TEST(Truth, LongestSideIsOneAndTheBoxIsCentred) {
  for (const char* part : {"box", "cut-cylinder", "tee"}) {
    const Truth truth = truth_of(part);
    Eigen::AlignedBox3d box;
    for (const TruthCurve& curve : truth.curves)
      for (int i = 0; i < curve.points.cols(); ++i) box.extend(Vector3d(curve.points.col(i)));
    if (part == std::string("box")) {
      EXPECT_NEAR(box.sizes().maxCoeff(), 1, 1e-12);
      EXPECT_LT(box.center().norm(), 1e-12);
    }
    EXPECT_LT(box.max().maxCoeff(), 0.5 + 1e-6) << part;
    EXPECT_GT(box.min().minCoeff(), -0.5 - 1e-6) << part;
  }
}

TEST(Truth, ThroughHoleAddsTwoCirclesOfOneAxis) {
  const Truth truth = truth_of("box-hole");
  EXPECT_EQ(count(truth.sketch, StrokeKind::kLine), 12);
  ASSERT_EQ(count(truth.sketch, StrokeKind::kCircle), 2);
  EXPECT_EQ(truth.sketch.size(), 14);
  std::vector<ControlPoints> circles;
  for (int s = 0; s < truth.sketch.size(); ++s)
    if (truth.sketch.strokes[s].kind == StrokeKind::kCircle)
      circles.push_back(control_points(truth.sketch, s));
  const Vector3d between = circles[1].p[0] - circles[0].p[0];
  EXPECT_LT(between.head<2>().norm(), 1e-9);
  EXPECT_NEAR(circles[0].p[1].norm(), circles[1].p[1].norm(), 1e-9);
}

TEST(Truth, FilletsLeaveNoEdgeAlongTheirTangentSeams) {
  const Truth truth = truth_of("box-fillet");
  EXPECT_EQ(count(truth.sketch, StrokeKind::kLine), 8);
  EXPECT_EQ(count(truth.sketch, StrokeKind::kArc), 8);
  EXPECT_EQ(truth.sketch.nodes.cols(), 16);
  for (const TruthCurve& curve : truth.curves)
    EXPECT_LT((curve.points.colwise() - curve.points.col(0)).row(2).cwiseAbs().maxCoeff(), 1e-9)
        << "a vertical edge is left";
}

TEST(Truth, ArcsOfEllipsesAreStrokesOfTheirKindOnTheTrueCurve) {
  for (const char* part : {"ridge-cylinder", "ellipse-plate"}) {
    const Truth truth = truth_of(part);
    EXPECT_TRUE(validate(truth.sketch).empty()) << part;
    int arcs = 0;
    for (int i = 0; i < truth.sketch.size(); ++i) {
      if (truth.sketch.strokes[i].kind != StrokeKind::kEllipticArc) continue;
      ++arcs;
      const TruthCurve& curve = truth.curves[truth.curve_of_stroke[i]];
      EXPECT_EQ(curve.type, "Ellipse");
      for (int k = 0; k < curve.points.cols(); ++k)
        EXPECT_LT(distance_to_stroke(truth.sketch, i, curve.points.col(k)).distance, 1e-5) << part;
    }
    EXPECT_GE(arcs, 2) << part;
  }
}

TEST(Truth, SeamOfACylinderIsNoEdgeAndAnObliqueCutIsAnEllipse) {
  const Truth truth = truth_of("cut-cylinder");
  EXPECT_EQ(count(truth.sketch, StrokeKind::kCircle), 1);
  EXPECT_EQ(count(truth.sketch, StrokeKind::kEllipse), 1);
  EXPECT_EQ(truth.sketch.size(), 2);
}

// Distance of a point from the strokes of one curve.
double distance_to_curve(const Truth& truth, const std::vector<Eigen::Matrix3Xd>& lines, int curve,
                         const Vector3d& x) {
  double best = 1e9;
  for (int s = 0; s < truth.sketch.size(); ++s) {
    if (truth.curve_of_stroke[s] != curve) continue;
    const Eigen::Matrix3Xd& p = lines[s];
    for (int i = 0; i + 1 < p.cols(); ++i) {
      const Vector3d a = p.col(i), d = p.col(i + 1) - a;
      const double t = std::clamp((x - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
      best = std::min(best, (x - a - t * d).norm());
    }
  }
  return best;
}

TEST(Truth, StrokesRunThroughThePointsOfTheirCurves) {
  for (const char* part : {"box-fillet", "cut-cylinder", "tee"}) {
    const Truth truth = truth_of(part);
    std::vector<Eigen::Matrix3Xd> lines;
    for (int s = 0; s < truth.sketch.size(); ++s)
      lines.push_back(sample_stroke(truth.sketch, s, 2e-3));
    ASSERT_EQ(truth.curve_of_stroke.size(), lines.size());
    double worst = 0;
    for (int c = 0; c < int(truth.curves.size()); ++c)
      for (int i = 0; i < truth.curves[c].points.cols(); i += 7)
        worst = std::max(worst, distance_to_curve(truth, lines, c, truth.curves[c].points.col(i)));
    EXPECT_LT(worst, 2e-5) << part;
  }
}

TEST(Truth, MovingItMovesPointsAndTurnsNoAxisIntoAPoint) {
  const Truth before = truth_of("cut-cylinder");
  const Truth after = transformed(before, 100, Vector3d(7, 8, 9));
  for (int s = 0; s < before.sketch.size(); ++s)
    for (double t : {0.0, 0.3, 0.8}) {
      Vector3d p, q, d;
      evaluate_stroke(before.sketch, s, t, &p, &d);
      evaluate_stroke(after.sketch, s, t, &q, &d);
      EXPECT_LT((p * 100 + Vector3d(7, 8, 9) - q).norm(), 1e-9);
    }
}

ParametricCurve turning(double radius, double angle, double rise) {
  ParametricCurve curve;
  curve.last = angle;
  curve.evaluate = [=](double t, Vector3d* p, Vector3d* d) {
    *p = {radius * std::cos(t), radius * std::sin(t), rise * t};
    *d = {-radius * std::sin(t), radius * std::cos(t), rise};
  };
  return curve;
}

TEST(CurveKind, CirclesAreRecognisedHoweverTheyAreStored) {
  const CurveShape arc = recognise(turning(0.3, 1.0, 0), 1e-6);
  ASSERT_EQ(arc.kind, CurveShape::kCircular);
  EXPECT_LT(arc.centre.norm(), 1e-12);
  EXPECT_NEAR(arc.u.cross(arc.v).z(), 0.09, 1e-12);
  EXPECT_NEAR(arc.turn, 1.0, 1e-12);
  EXPECT_NEAR(recognise(turning(0.3, 2 * M_PI, 0), 1e-6).turn, 2 * M_PI, 1e-9);
}

ParametricCurve elliptic(double angle, double rise) {
  ParametricCurve curve;
  curve.last = angle;
  curve.evaluate = [=](double t, Vector3d* p, Vector3d* d) {
    *p = {1 + 0.4 * std::cos(t), 0.1 * std::sin(t), 2 + rise * t};
    *d = {-0.4 * std::sin(t), 0.1 * std::cos(t), rise};
  };
  return curve;
}

TEST(CurveKind, EllipsesAndTheirArcsAreRecognisedHoweverTheyAreStored) {
  for (double angle : {0.8, 3.0, 2 * M_PI}) {
    const CurveShape shape = recognise(elliptic(angle, 0), 1e-6);
    ASSERT_EQ(shape.kind, CurveShape::kElliptic) << angle;
    EXPECT_LT((shape.centre - Vector3d(1, 0, 2)).norm(), 1e-8) << angle;
    EXPECT_NEAR(shape.u.norm(), 0.4, 1e-8) << angle;
    EXPECT_NEAR(shape.v.norm(), 0.1, 1e-8) << angle;
    EXPECT_NEAR(shape.turn, angle, 1e-6) << angle;
  }
  EXPECT_EQ(recognise(elliptic(3.0, 1e-4), 1e-6).kind, CurveShape::kOther);
  EXPECT_EQ(recognise(elliptic(0.3, 0), 1e-7).kind, CurveShape::kOther) << "too short to tell";
}

TEST(CurveKind, ParabolasAndWavesAreNoEllipses) {
  ParametricCurve curve;
  curve.last = 1;
  for (bool wave : {false, true}) {
    curve.evaluate = [=](double t, Vector3d* p, Vector3d* d) {
      *p = {t, wave ? 0.1 * std::sin(7 * t) : t * t, 0};
      *d = {1, wave ? 0.7 * std::cos(7 * t) : 2 * t, 0};
    };
    EXPECT_EQ(recognise(curve, 1e-6).kind, CurveShape::kOther) << wave;
  }
}

TEST(CurveKind, HelixIsNoCircleAndARunOnTheSpotIsNoLine) {
  EXPECT_EQ(recognise(turning(0.3, 2, 0.01), 1e-6).kind, CurveShape::kOther);
  EXPECT_EQ(recognise(turning(0, 1, 0), 1e-6).kind, CurveShape::kOther);
  EXPECT_EQ(recognise(turning(0, 1, 0.2), 1e-6).kind, CurveShape::kLine);
}

TEST(CurveKind, CubicsStayWithinTheToleranceOfAHelix) {
  const ParametricCurve helix = turning(0.4, 6, 0.05);
  const std::vector<double> knots = hermite_knots(helix, {}, 1e-6);
  EXPECT_GT(knots.size(), 4u);
  EXPECT_LT(knots.size(), 80u);
  for (size_t i = 1; i < knots.size(); ++i) {
    Vector3d c[4] = {helix.point(knots[i - 1]), {}, {}, helix.point(knots[i])}, p, d;
    hermite_handles(helix, knots[i - 1], knots[i], &c[1], &c[2]);
    for (double t : {0.2, 0.5, 0.7}) {
      evaluate_curve<double>(StrokeKind::kBezier, c, t, &p, &d);
      EXPECT_LT((p - helix.point(knots[i - 1] * (1 - t) + knots[i] * t)).norm(), 1.1e-6);
    }
  }
}

TEST(Parts, SameSeedSamePartAndOtherSeedOtherPart) {
  const Truth a = truth_of("box", 5), b = truth_of("box", 5), c = truth_of("box", 6);
  EXPECT_EQ(a.sketch.nodes, b.sketch.nodes);
  EXPECT_GT((a.sketch.nodes - c.sketch.nodes).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Parts, UnknownNameIsToldTheKnownOnes) {
  try {
    make_part("teapot", 1);
    FAIL() << "no exception";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("teapot"));
    EXPECT_THAT(error.what(), HasSubstr("box-hole"));
  }
}

TEST(Step, UnreadableFilesAreInputErrors) {
  const std::string path = testing::TempDir() + "/broken.step";
  EXPECT_THROW(read_step(testing::TempDir() + "/no_such.step"), InputError);
  EXPECT_THROW(read_step(testing::TempDir()), InputError);
  for (const char* text :
       {"", "ISO", "solid cube\nfacet", "ISO-10303-21;\nHEADER;\n",
        "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"}) {
    std::ofstream(path) << text;
    EXPECT_THROW(read_step(path), InputError) << '"' << text << '"';
  }
  std::filesystem::remove(path);
}

TEST(Options, OutOfRangeIsRefused) {
  SynthesizeOptions options;
  options.part = "box";
  options.extent = 0;
  EXPECT_THROW(synthesize(options), InputError);
  options.extent = std::nan("");
  EXPECT_THROW(synthesize(options), InputError);
  options.extent = 1;
  options.rig.views = 0;
  EXPECT_THROW(synthesize(options), InputError);
}

TEST(Rig, CamerasAreFourFromTheWorldOriginAndLookAtTheObject) {
  for (RigKind kind : {RigKind::kSphere, RigKind::kUpper, RigKind::kRing}) {
    RigOptions options;
    options.kind = kind;
    for (const View& view : make_rig(options, 3)) {
      const Eigen::Matrix3d& R = view.cam_from_world.rotation;
      EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_NEAR(R.determinant(), 1, 1e-12);
      const Vector3d centre = view.center_in_world();
      EXPECT_NEAR((centre + Vector3d::Constant(0.5)).norm(), 4, 1e-12);
      EXPECT_TRUE(kind == RigKind::kSphere || centre.z() > 0);
      double depth;
      const Eigen::Vector2d pixel = view.project(Vector3d::Zero(), &depth);
      EXPECT_GT(depth, 3.1);
      EXPECT_LT(depth, 4.9);
      EXPECT_LT((pixel - Eigen::Vector2d(399.5, 399.5)).norm(), 1e-9);
      EXPECT_LE(view.project(Vector3d(0, 0, 0.1), &depth).y(), 399.5) << "z is not up";
    }
  }
}

TEST(Rig, WorldOfAnotherScaleSeesTheSamePixels) {
  const std::vector<View> unit = make_rig({}, 1);
  const std::vector<View> world = transformed(unit, 1e3, Vector3d(1, 2, 3));
  const Vector3d p(0.2, -0.3, 0.1);
  double depth;
  for (size_t k = 0; k < unit.size(); ++k)
    EXPECT_LT(
        (unit[k].project(p, &depth) - world[k].project(p * 1e3 + Vector3d(1, 2, 3), &depth)).norm(),
        1e-9);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/mesh_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>

#include "datasets/synthetic/cad/mesh_runs.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/types/errors.h"
#include "sketches/io/io.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

std::string write(const std::string& name, const std::string& text) {
  const std::string folder = testing::TempDir() + "mesh_part_test/";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + name, std::ios::binary) << text;
  return folder + name;
}

MeshPart part_of(const std::string& path, double crease_deg = 30) {
  return make_mesh_part(read_mesh(path), crease_deg, path);
}

int count(const Sketch& sketch, StrokeKind kind) {
  int n = 0;
  for (const Stroke& s : sketch.strokes) n += s.kind == kind;
  return n;
}

const char* const kCube =
    "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

void facet(const Vector3d& a, const Vector3d& b, const Vector3d& c, std::ostream* out) {
  *out << "facet normal 0 0 0\nouter loop\n";
  for (const Vector3d& p : {a, b, c}) *out << "vertex " << p.transpose() << "\n";
  *out << "endloop\nendfacet\n";
}

// A prism over a closed outline, with fans as lids.
std::string prism(const std::vector<Vector3d>& outline, const Vector3d& height) {
  std::ostringstream out;
  out << std::setprecision(8) << "solid prism\n";
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : outline) middle += p / double(outline.size());
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vector3d a = outline[i], b = outline[(i + 1) % outline.size()];
    facet(a, b, b + height, &out);
    facet(a, b + height, a + height, &out);
    facet(middle, b, a, &out);
    facet(middle + height, a + height, b + height, &out);
  }
  out << "endsolid prism\n";
  return out.str();
}

std::vector<Vector3d> ellipse(int n, double u, double v) {
  std::vector<Vector3d> points;
  for (int i = 0; i < n; ++i)
    points.emplace_back(u * std::cos(2 * M_PI * i / n), v * std::sin(2 * M_PI * i / n), 0);
  return points;
}

TEST(MeshPart, CubeOfAnObjFileHasTwelveLinesOverEightNodes) {
  const MeshPart part = part_of(write("cube.obj", kCube));
  EXPECT_EQ(part.truth.sketch.size(), 12);
  EXPECT_EQ(count(part.truth.sketch, StrokeKind::kLine), 12);
  EXPECT_EQ(part.truth.sketch.nodes.cols(), 8);
  EXPECT_NEAR(part.truth.sketch.nodes.cwiseAbs().minCoeff(), 0.5, 1e-12);
  EXPECT_NEAR(part.truth.sketch.nodes.cwiseAbs().maxCoeff(), 0.5, 1e-12);
  EXPECT_EQ(part.surface.corners.size(), 12u);
  EXPECT_EQ(part.surface.points.size(), 24u);  // three normals at each corner
  for (const TruthCurve& curve : part.truth.curves) {
    EXPECT_NEAR(curve.dihedral_deg, 90, 1e-9);
    EXPECT_GT(curve.outward.col(0).dot(curve.points.col(0)), 0);
  }
}

TEST(MeshPart, FacesTurnedInsideOutAndSplitVerticesChangeNothing) {
  std::string text = kCube;
  text.replace(text.find("f 5 6 7 8"), 9, "f 8 7 6 5");
  text += "v 2 2 2\n";  // a second point at the place of the seventh
  text.replace(text.find("f 2 3 7 6"), 9, "f 2 3 9 6");
  const Truth truth = part_of(write("turned.obj", text)).truth;
  EXPECT_EQ(truth.sketch.size(), 12);
  EXPECT_EQ(truth.sketch.nodes.cols(), 8);
}

TEST(MeshPart, CylinderOfSixtyFourFacetsHasTwoCircles) {
  const MeshPart part = part_of(write("cylinder.stl", prism(ellipse(64, 1, 1), {0, 0, 1})));
  ASSERT_EQ(part.truth.sketch.size(), 2);
  EXPECT_EQ(count(part.truth.sketch, StrokeKind::kCircle), 2);
  EXPECT_EQ(part.truth.sketch.nodes.cols(), 0);
  for (int s = 0; s < 2; ++s) {
    const ControlPoints c = control_points(part.truth.sketch, s);
    EXPECT_NEAR(c.p[1].norm(), 0.5, 1e-6);
    EXPECT_LT(c.p[0].head<2>().norm(), 1e-6);
    EXPECT_NEAR(std::abs(c.p[0].z()), 0.25, 1e-6);
  }
  for (size_t i = 0; i < part.surface.points.size(); ++i) {
    const Eigen::Vector3f &p = part.surface.points[i], &n = part.surface.normals[i];
    if (std::abs(n.z()) > 0.5f) continue;
    EXPECT_GT(n.dot(Eigen::Vector3f(p.x(), p.y(), 0).normalized()), 0.9999f) << "a facet shows";
  }
}

TEST(MeshPart, SmallerCreaseAngleThanTheFacetsHaveShowsEveryFacet) {
  const Truth truth = part_of(write("faceted.stl", prism(ellipse(16, 1, 1), {0, 0, 1})), 10).truth;
  EXPECT_EQ(count(truth.sketch, StrokeKind::kLine), 48);
}

TEST(MeshPart, EllipsesAreOne) {
  const Truth truth = part_of(write("oval.stl", prism(ellipse(96, 2, 1), {0, 0, 1}))).truth;
  EXPECT_EQ(truth.sketch.size(), 2);
  EXPECT_EQ(count(truth.sketch, StrokeKind::kEllipse), 2);
}

TEST(MeshPart, SlotIsTwoLinesAndTwoArcsOverSharedNodes) {
  std::vector<Vector3d> outline;
  for (int i = 0; i <= 20; ++i)
    outline.emplace_back(2 + std::sin(M_PI * i / 20), -std::cos(M_PI * i / 20), 0);
  for (int i = 0; i <= 20; ++i)
    outline.emplace_back(-2 - std::sin(M_PI * i / 20), std::cos(M_PI * i / 20), 0);
  const Sketch sketch = part_of(write("slot.stl", prism(outline, {0, 0, 1}))).truth.sketch;
  EXPECT_EQ(count(sketch, StrokeKind::kLine), 4);
  EXPECT_EQ(count(sketch, StrokeKind::kArc), 4);
  EXPECT_EQ(sketch.nodes.cols(), 8);
  EXPECT_THAT(validate(sketch), testing::IsEmpty());
}

TEST(MeshPart, TetrahedronOfAnOffFileHasSixLines) {
  const Truth truth =
      part_of(write("tetra.off",
                    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"))
          .truth;
  EXPECT_EQ(count(truth.sketch, StrokeKind::kLine), 6);
  EXPECT_EQ(truth.sketch.nodes.cols(), 4);
}

TEST(MeshPart, PolygonThatIsNotConvexKeepsItsArea) {
  const TriangleMesh mesh = read_mesh(
      write("ell.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 3 4 5 6 1 2\n"));
  ASSERT_EQ(mesh.triangles.size(), 4u);
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += (mesh.points[t[1]] - mesh.points[t[0]])
                .cross(mesh.points[t[2]] - mesh.points[t[0]])
                .norm() /
            2;
  EXPECT_NEAR(area, 3, 1e-12);
  EXPECT_EQ(part_of(testing::TempDir() + "mesh_part_test/ell.obj").truth.sketch.size(), 6);
}

TEST(MeshPart, UnreadableFilesAreInputErrorsAndNothingIsPrinted) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  for (const char* ending : {".obj", ".stl", ".ply", ".off"}) {
    EXPECT_THROW(read_mesh(write(std::string("empty") + ending, "")), InputError) << ending;
    EXPECT_THROW(read_mesh(write(std::string("text") + ending, "Dear reader,\nno mesh here.\n")),
                 InputError)
        << ending;
    EXPECT_THROW(read_mesh(testing::TempDir() + "no-such-file" + ending), InputError) << ending;
    EXPECT_THROW(read_mesh(testing::TempDir()), InputError);
  }
  EXPECT_THROW(read_mesh(write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n")), InputError);
  EXPECT_THROW(part_of(write("thin.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")), InputError);
  EXPECT_THROW(read_mesh(write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")), InputError);
  EXPECT_THROW(read_mesh(write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")), InputError);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(MeshPart, SameFileSameBytes) {
  const std::string path = write("twice.stl", prism(ellipse(40, 1.3, 1), {0.2, 0, 1}));
  std::string texts[2];
  for (std::string& text : texts) {
    std::ostringstream out;
    write_sketch_json(out, part_of(path).truth.sketch);
    text = out.str();
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST(MeshPart, SceneOfAMeshSeesItsEdges) {
  SynthesizeOptions options;
  options.part = write("scene.obj", kCube);
  options.rig.views = 8;
  const SyntheticScene scene = synthesize(options);
  for (const TruthCurve& curve : scene.truth.curves)
    EXPECT_GT(curve.visible_views[curve.visible_views.size() / 2], 0);
}

TEST(CutRun, FreeformRunIsFewCubicsThatMeet) {
  Eigen::Matrix3Xd points(3, 201);
  for (int i = 0; i <= 200; ++i)
    points.col(i) << i / 200.0, 0.2 * std::sin(i / 30.0), 0.1 * std::cos(i / 20.0);
  const std::vector<MeshCurve> pieces = cut_run(points, 1e-4);
  EXPECT_LT(pieces.size(), 20u);
  EXPECT_EQ(pieces.front().first, 0);
  EXPECT_EQ(pieces.back().last, 200);
  for (size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].kind, StrokeKind::kBezier)
        << i << ": " << pieces[i].first << " to " << pieces[i].last;
    if (i == 0) continue;
    EXPECT_EQ(pieces[i].first, pieces[i - 1].last);
  }
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <BRepAdaptor_Surface.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "datasets/types/errors.h"
#include "gmock/gmock.h"
#include "tests/topology/solids.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

void expect_valid(const Solid& solid, double volume, double area) {
  const SolidCheck check = write_solid_step(solid, "");
  EXPECT_TRUE(check.valid) << check.why;
  EXPECT_NEAR(check.volume, volume, 1e-6 * volume);
  EXPECT_NEAR(check.area, area, 1e-6 * area);
  EXPECT_LT(check.tolerance, 1e-8);
}

std::string file_name() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  return ::testing::TempDir() + "brep_" + test->name() + ".step";
}

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

// What OpenCASCADE makes of a file.
struct Reread {
  int solids = 0;
  bool valid = false;
  double volume = 0;
  std::map<GeomAbs_SurfaceType, int> faces;
};
Reread reread(const std::string& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  Reread out;
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return out;
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) ++out.solids;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
    ++out.faces[BRepAdaptor_Surface(TopoDS::Face(it.Current())).GetType()];
  out.valid = BRepCheck_Analyzer(shape).IsValid();
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  out.volume = properties.Mass();
  return out;
}

TEST(Brep, ACubeIsValid) { expect_valid(box_solid({0, 0, 0}, {1, 1, 1}), 1, 6); }

TEST(Brep, AThroughHoleHasTwoLoopsOnItsCylinder) {
  expect_valid(plate_with_hole(0.5), 1 - M_PI / 16 * 0.5, 7 - 2 * M_PI / 16 + M_PI / 2 * 0.5);
}

TEST(Brep, ABlindHoleIsValid) {
  expect_valid(plate_with_hole(0.2), 1 - M_PI / 16 * 0.2, 7 + M_PI / 2 * 0.2);
}

TEST(Brep, ArcsAndLinesBoundAPieceOfACylinder) {
  expect_valid(half_cylinder(), M_PI, M_PI + 2 * M_PI + 4);
}

TEST(Brep, AFrustumIsValid) {
  expect_valid(cone_solid(0.5), M_PI / 3 * 1.75, M_PI * 1.25 + M_PI * 1.5 * std::hypot(1, 0.5));
}

TEST(Brep, AConeEndsInItsApex) {
  expect_valid(cone_solid(0), M_PI / 3, M_PI + M_PI * std::sqrt(2.0));
}

TEST(Brep, AWholeSphereHasNoLoops) { expect_valid(sphere_solid(), M_PI / 6, M_PI); }

}  // namespace
}  // namespace sketchsplat

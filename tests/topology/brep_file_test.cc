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
#include <sstream>

#include "datasets/step/guarded.h"
#include "datasets/step/read_step_shape.h"
#include "datasets/types/errors.h"
#include "gmock/gmock.h"
#include "tests/topology/solids.h"
#include "topology/brep/mesh_solid.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {
namespace {

using ::testing::HasSubstr;

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

TEST(BrepFile, HoldsOneSolidWithItsSurfaces) {
  StepSolidOptions options;
  options.name = "Träger 'A\\1'";
  options.scale = 10;
  const std::string path = file_name();
  ASSERT_TRUE(write_solid_step(plate_with_hole(0.2), path, options).valid);
  const Reread file = reread(path);
  EXPECT_EQ(file.solids, 1);
  EXPECT_TRUE(file.valid);
  EXPECT_NEAR(file.volume, 1000 * (1 - M_PI / 16 * 0.2), 1e-3);
  EXPECT_THAT(file.faces,
              ::testing::ElementsAre(std::pair(GeomAbs_Plane, 7), std::pair(GeomAbs_Cylinder, 1)));
  const std::string text = read(path);
  EXPECT_THAT(text, HasSubstr(R"(MANIFOLD_SOLID_BREP('Tr\X2\00E4\X0\ger ''A\\1''')"));
  EXPECT_THAT(text, HasSubstr(R"(PRODUCT('Tr\X2\00E4\X0\ger ''A\\1''')"));
  EXPECT_THAT(text, HasSubstr("AUTOMOTIVE_DESIGN"));
  EXPECT_THAT(text, HasSubstr("ADVANCED_FACE('cylinder_"));
  EXPECT_THAT(text, HasSubstr("COLOUR_RGB"));
}

TEST(BrepFile, EverySurfaceSurvives) {
  std::vector<Solid> solids = some_solids();
  solids.push_back(sphere_solid());
  solids.push_back(perturbed(plate_with_hole(0.5), 1e-6));
  solids.push_back(perturbed(half_cone(), 1e-6));
  for (size_t i = 0; i < solids.size(); ++i) {
    const SolidCheck check = write_solid_step(solids[i], file_name());
    ASSERT_TRUE(check.valid) << i << ": " << check.why;
    const Reread file = reread(file_name());
    EXPECT_EQ(file.solids, 1) << i;
    EXPECT_TRUE(file.valid) << i;
    EXPECT_NEAR(file.volume, check.volume, 1e-5 * check.volume) << i;
    int faces = 0;
    for (const auto& [type, count] : file.faces) faces += count;
    EXPECT_EQ(faces, int(solids[i].faces.size())) << i;
  }
}

TEST(BrepFile, StatesItsUnit) {
  StepSolidOptions options;
  options.unit = LengthUnit::kInch;
  ASSERT_TRUE(write_solid_step(box_solid({0, 0, 0}, {1, 1, 1}), file_name(), options).valid);
  EXPECT_NEAR(reread(file_name()).volume, std::pow(25.4, 3), 1e-3);
  EXPECT_THAT(read(file_name()), HasSubstr("INCH"));
  EXPECT_THAT(read(file_name()), HasSubstr("CARTESIAN_POINT('',(1.,1.,1.))"));
}

TEST(BrepFile, OfTheSameSolidHasTheSameBytes) {
  const std::string path = file_name();
  ASSERT_TRUE(write_solid_step(plate_with_hole(0.2), path).valid);
  const std::string first = read(path);
  ASSERT_TRUE(write_solid_step(cone_solid(0), path).valid);
  ASSERT_TRUE(write_solid_step(plate_with_hole(0.2), path).valid);
  EXPECT_EQ(read(path), first);
}

TEST(BrepFile, NumbersFacesAsTheSolidDoes) {
  SolidMaker m;
  m.box({0, 0, 0}, {4, 4, 4});
  Solid voids = m.solid;  // a cavity, whose faces come first, in a shell of their own
  SolidMaker inner;
  inner.solid = Solid();
  inner.face({SurfaceKind::kSphere, {2, 2, 2}, Eigen::Vector3d::UnitZ(), 1}, true, {});
  voids.surfaces.insert(voids.surfaces.begin(), inner.solid.surfaces[0]);
  for (SolidFace& face : voids.faces) ++face.surface;
  voids.faces.insert(voids.faces.begin() + 3, inner.solid.faces[0]);
  ASSERT_TRUE(write_solid_step(voids, file_name()).valid);
  EXPECT_THAT(read(file_name()), HasSubstr("ADVANCED_FACE('sphere_3'"));
}

TEST(MeshSolid, HasTheAreasOfTheFacesAndLooksOut) {
  const Solid solid = plate_with_hole(0.5);
  const std::vector<FaceMesh> mesh = mesh_solid(solid, 1e-3);
  ASSERT_EQ(mesh.size(), solid.faces.size());
  EXPECT_NEAR(mesh[2].area, 2 * 0.5, 1e-9);
  EXPECT_NEAR(mesh[6].area, M_PI * 0.5 * 0.5, 1e-9);
  double volume = 0;
  for (const FaceMesh& face : mesh)
    for (const auto& [a, b, c] : face.triangles)
      volume +=
          face.points[size_t(a)].dot(face.points[size_t(b)].cross(face.points[size_t(c)])) / 6;
  EXPECT_NEAR(volume, 1 - M_PI / 16 * 0.5, 2e-3);
  EXPECT_TRUE(mesh_solid(Solid(), 1e-3).empty());
}

TEST(BrepFile, IsNotThereIfTheSolidIsRefused) {
  Solid solid = box_solid({0, 0, 0}, {1, 1, 1});
  solid.faces.pop_back();
  const std::string path = file_name();
  std::filesystem::remove(path);
  EXPECT_FALSE(write_solid_step(solid, path).valid);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THROW(write_solid_step(sphere_solid(), "/nowhere/at/all/solid.step"), OutputError);
}

TEST(StepFile, WhatIsWrittenIsReadTheSameThroughTheChild) {
  const std::string path = file_name();
  ASSERT_TRUE(write_solid_step(plate_with_hole(0.5), path).valid);
  const TopoDS_Shape shape =
      shape_of(guarded(path, "a STEP file", 20, [&] { return bytes_of(read_step_shape(path)); }));
  const Reread direct = reread(path);
  Reread child;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
    ++child.faces[BRepAdaptor_Surface(TopoDS::Face(it.Current())).GetType()];
  EXPECT_EQ(child.faces, direct.faces);
  GProp_GProps volume;
  BRepGProp::VolumeProperties(shape, volume);
  EXPECT_EQ(volume.Mass(), direct.volume);  // to the last bit
}

}  // namespace
}  // namespace sketchsplat

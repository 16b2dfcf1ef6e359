// SPDX-License-Identifier: MIT
#include <BRepAdaptor_Curve.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TransferBRep.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "gmock/gmock.h"
#include "sketches/io/io.h"
#include "tests/sketches/five_kinds.h"
#include "topology/faces/planar_faces.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// What OpenCASCADE's reader of whole documents makes of a file.
struct Document {
  TopoDS_Shape shape;
  TopTools_IndexedMapOfShape faces, edges;
  std::multimap<std::string, std::string> colour_of_name;  ///< of edges
  double area = 0;
};
Document read(const Sketch& s, const StepOptions& options) {
  namespace fs = std::filesystem;
  const fs::path path = fs::path(testing::TempDir()) / "sketchsplat_document.step";
  {
    std::ofstream out(path);
    write_step(out, s, options);
  }
  Document out;
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true);
  EXPECT_EQ(reader.ReadFile(path.c_str()), IFSelect_RetDone);
  EXPECT_TRUE(reader.Transfer(document));
  fs::remove(path);
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  TDF_LabelSequence labels;
  shapes->GetFreeShapes(labels);
  EXPECT_EQ(labels.Length(), 1) << "one product";
  if (labels.Length() != 1) return out;
  out.shape = shapes->GetShape(labels.First());
  TopExp::MapShapes(out.shape, TopAbs_FACE, out.faces);
  TopExp::MapShapes(out.shape, TopAbs_EDGE, out.edges);
  const auto transfer = reader.Reader().WS()->TransferReader();
  for (int i = 1; i <= out.edges.Extent(); ++i) {
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(
        transfer->EntityFromShapeResult(out.edges(i), 1));
    Quantity_Color colour;
    if (item.IsNull() || !colours->GetColor(out.edges(i), XCAFDoc_ColorCurv, colour)) continue;
    out.colour_of_name.emplace(item->Name()->ToCString(),
                               Quantity_Color::ColorToHex(colour).ToCString());
  }
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(out.shape, properties);
  out.area = properties.Mass();
  return out;
}

// A box with a round hole through it, and an edge that stands out of it.
Sketch pierced_box() {
  Sketch s;
  const Vector3d size(3, 2, 0.5);
  for (int n = 0; n < 8; ++n)
    s.add_node(size.cwiseProduct(Vector3d(n & 1, n >> 1 & 1, n >> 2 & 1)));
  for (int n = 0; n < 8; ++n)
    for (const int bit : {1, 2, 4})
      if (!(n & bit)) s.add_stroke(StrokeKind::kLine, n, n | bit, {});
  for (const double z : {0.0, 0.5})
    s.add_stroke(StrokeKind::kCircle, -1, -1, {{1, 1, z}, {0, 0, 0.4}});
  s.add_stroke(StrokeKind::kLine, 7, s.add_node({3, 2, 1.5}), {});
  return s;
}
constexpr double kPiercedArea = 2 * (6 - M_PI * 0.16) + 2 * 1.5 + 2 * 1.0;

TEST(StepFaces, FillABoxWithAHoleAndLeaveTheRestAsEdges) {
  Random random;
  for (const double unit : {1.0, 1e-2, 1e2})
    for (int round = 0; round < 3; ++round) {
      const Sketch s = moved(pierced_box(), unit, random.rotation(), unit * random.point());
      StepOptions options;
      options.scale = 50 / unit;
      options.faces = planar_faces(s);
      ASSERT_EQ(options.faces.size(), 6u);
      const Document d = read(s, options);
      EXPECT_EQ(d.faces.Extent(), 6);
      EXPECT_EQ(d.edges.Extent(), s.size()) << "every stroke once";
      EXPECT_TRUE(BRepCheck_Analyzer(d.shape).IsValid());
      EXPECT_NEAR(d.area, kPiercedArea * 2500, 1e-4 * d.area);
    }
}

TEST(StepFaces, AreValidWhereEdgesAreAsInexactAsReconstructedOnes) {
  Random random;
  Sketch s = pierced_box();
  for (int n = 0; n < s.nodes.cols(); ++n) s.nodes.col(n) += 5e-4 * random.point();
  StepOptions options;
  options.scale = 50;
  options.faces = planar_faces(s);
  ASSERT_EQ(options.faces.size(), 6u);
  const Document d = read(s, options);
  EXPECT_EQ(d.faces.Extent(), 6);
  EXPECT_TRUE(BRepCheck_Analyzer(d.shape).IsValid());
  EXPECT_NEAR(d.area, kPiercedArea * 2500, 1e-2 * d.area);
}

TEST(StepFaces, AlternateBetweenFaceAndHole) {
  Sketch s;
  for (const double r : {4.0, 3.0, 2.0, 1.0})
    s.add_stroke(StrokeKind::kCircle, -1, -1, {{0, 0, 1}, {0, 0, r}});
  StepOptions options;
  options.faces = planar_faces(s);
  ASSERT_EQ(options.faces.size(), 2u);
  EXPECT_NEAR(read(s, options).area, M_PI * (16 - 9 + 4 - 1), 1e-6);
}

TEST(StepFaces, NeedAClosedLoopInAPlane) {
  EXPECT_TRUE(planar_faces(Sketch()).empty());
  Sketch open = pierced_box();
  std::vector<bool> keep(open.size(), true);
  for (int i = 0; i < 12; ++i) keep[i] = i % 3 != 0;
  EXPECT_EQ(planar_faces(keep_strokes(open, keep)).size(), 2u) << "the circles alone";
  Sketch bent;  // a closed loop of four that is not flat
  for (int n = 0; n < 4; ++n) bent.add_node({double(n == 1 || n == 2), n / 2.0, 0.2 * (n % 2)});
  for (int n = 0; n < 4; ++n) bent.add_stroke(StrokeKind::kLine, n, (n + 1) % 4, {});
  EXPECT_TRUE(planar_faces(bent).empty());
}

// Most of either is inside of the other.
TEST(StepFaces, RoundsThatCrossEachOtherAreNoReasonToTurnForEver) {
  Sketch s;
  for (const double side : {1.0, -1.0})
    s.add_stroke(StrokeKind::kEllipse, -1, -1,
                 {Vector3d(0.01 * side, 0, 0), Vector3d(side, 0, 0), Vector3d(0, 1, 0)});
  EXPECT_LE(planar_faces(s).size(), 2u);
}

TEST(StepDocument, CarriesNamesAndColoursByKind) {
  const Document d = read(five_kinds(), {"part", 50});
  std::map<std::string, std::set<std::string>> colours;
  std::set<std::string> names;
  for (const auto& [name, colour] : d.colour_of_name) {
    names.insert(name);
    colours[name.substr(0, name.find('_'))].insert(colour);
  }
  EXPECT_THAT(names, testing::ElementsAre("arc_1", "bezier_2", "circle_4", "ellipse_5", "line_0",
                                          "line_3"));
  std::set<std::string> all;
  for (const auto& [kind, of_kind] : colours) {
    EXPECT_EQ(of_kind.size(), 1u) << kind;
    all.insert(of_kind.begin(), of_kind.end());
  }
  EXPECT_EQ(all.size(), 5u);
}

TEST(StepDocument, DeclaresItsUnit) {
  Sketch s;
  s.add_node({0, 0, 0});
  s.add_node({1, 0, 0});
  s.add_stroke(StrokeKind::kLine, 0, 1, {});
  for (int unit = 0; unit < 4; ++unit) {
    const Document d = read(s, {"line", 2, LengthUnit(unit)});
    ASSERT_EQ(d.edges.Extent(), 1);
    const BRepAdaptor_Curve curve(TopoDS::Edge(d.edges(1)));
    EXPECT_NEAR(curve.Value(curve.FirstParameter()).Distance(curve.Value(curve.LastParameter())),
                2 * millimetres(LengthUnit(unit)), 1e-9)
        << length_unit_names()[unit];
  }
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <XSControl_WorkSession.hxx>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "gmock/gmock.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "sketches/io/io.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

std::string step_of(const Sketch& s, const StepOptions& options = {}) {
  std::ostringstream out;
  write_step(out, s, options);
  return out.str();
}

// What OpenCASCADE makes of the file.
struct Shape {
  bool read = false;
  int roots = 0;
  TopoDS_Shape shape;
  TopTools_IndexedMapOfShape edges, vertices;
  TopoDS_Edge edge(int i) const { return TopoDS::Edge(edges(i + 1)); }
};
Shape open_step(const std::string& text) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  Shape out;
  STEPControl_Reader reader;
  std::istringstream in(text);
  out.read = reader.ReadStream("sketch.step", in) == IFSelect_RetDone;
  if (!out.read) return out;
  out.roots = reader.TransferRoots();
  out.shape = reader.OneShape();
  if (out.shape.IsNull()) return out;
  TopExp::MapShapes(out.shape, TopAbs_EDGE, out.edges);
  TopExp::MapShapes(out.shape, TopAbs_VERTEX, out.vertices);
  return out;
}

double length_of(const TopoDS_Edge& edge) {
  return GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge), 1e-12);
}

GeomAbs_CurveType type_of(StrokeKind kind) {
  switch (kind) {
    case StrokeKind::kLine:
      return GeomAbs_Line;
    case StrokeKind::kArc:
    case StrokeKind::kCircle:
      return GeomAbs_Circle;
    case StrokeKind::kEllipse:
    case StrokeKind::kEllipticArc:
      return GeomAbs_Ellipse;
    case StrokeKind::kBezier:
      break;
  }
  return GeomAbs_BSplineCurve;
}

int num_closed(const Sketch& s) {
  return int(std::count_if(s.strokes.begin(), s.strokes.end(),
                           [](const Stroke& stroke) { return is_closed(stroke.kind); }));
}

// Edge by edge: the type, the length and points all along.
void expect_same_curves(const Sketch& s, const Shape& shape, double scale) {
  ASSERT_EQ(shape.edges.Extent(), s.size());
  EXPECT_EQ(shape.vertices.Extent(), s.nodes.cols() + num_closed(s)) << "junctions are shared";
  EXPECT_TRUE(BRepCheck_Analyzer(shape.shape).IsValid());
  const double extent = largest_extent(s);
  for (int i = 0; i < s.size(); ++i) {
    // Edges may come in another order: the one whose middle is on the stroke and whose length fits.
    int matches = 0;
    for (int e = 0; e < shape.edges.Extent(); ++e) {
      const BRepAdaptor_Curve curve(shape.edge(e));
      if (curve.GetType() != type_of(s.strokes[i].kind)) continue;
      double worst = 0;
      for (int k = 0; k <= 8; ++k) {
        const double u =
            curve.FirstParameter() + k / 8.0 * (curve.LastParameter() - curve.FirstParameter());
        const gp_Pnt p = curve.Value(u);
        const Vector3d q = Vector3d(p.X(), p.Y(), p.Z()) / scale;
        worst = std::max(worst, distance_to_stroke(s, i, q).distance);
      }
      if (worst > 1e-7 * extent) continue;
      ++matches;
      EXPECT_NEAR(length_of(shape.edge(e)), scale * stroke_length(s, i),
                  1e-6 * scale * stroke_length(s, i))
          << kind_name(s.strokes[i].kind);
    }
    EXPECT_EQ(matches, 1) << "stroke " << i << ", " << kind_name(s.strokes[i].kind);
  }
}

TEST(Step, ReadsBackInOpenCascadeCurveByCurve) {
  const Shape shape = open_step(step_of(all_kinds()));
  ASSERT_TRUE(shape.read);
  EXPECT_EQ(shape.roots, 1) << "one product";
  expect_same_curves(all_kinds(), shape, 1);
}

TEST(Step, ReadsBackTurnedMovedAndInOtherUnits) {
  Random random;
  for (double unit : {1e-3, 1.0, 1e3})
    for (double scale : {1.0, 1e-3, 1e3}) {
      if (unit * scale < 1e-3 || unit * scale > 1e3) continue;  // a part of 1 micron to 1 m
      const Sketch s = moved(all_kinds(), unit, random.rotation(), unit * random.point());
      SCOPED_TRACE(testing::Message() << "unit " << unit << " scale " << scale);
      const Shape shape = open_step(step_of(s, {"part", scale}));
      ASSERT_TRUE(shape.read);
      expect_same_curves(s, shape, scale);
    }
}

TEST(Step, HasTheBoundingBoxOfTheSketch) {
  const Sketch s = all_kinds();
  const Shape shape = open_step(step_of(s, {"part", 50}));
  Bnd_Box bounds;
  BRepBndLib::AddOptimal(shape.shape, bounds, Standard_False, Standard_False);
  double box[6];
  bounds.Get(box[0], box[1], box[2], box[3], box[4], box[5]);
  Eigen::AlignedBox3d expected;
  for (int i = 0; i < s.size(); ++i) {
    const Eigen::Matrix3Xd points = sample_stroke(s, i, 1e-3);
    for (int k = 0; k < points.cols(); ++k) expected.extend(50 * points.col(k));
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(box[k], expected.min()[k], 1e-3);
    EXPECT_NEAR(box[k + 3], expected.max()[k], 1e-3);
  }
}

TEST(Step, KeepsArcsOfEveryAngleOnTheirSide) {
  for (double degrees : {0.01, 1.0, 90.0, 180.0, 270.0, 359.0})
    for (double sign : {1.0, -1.0}) {
      SCOPED_TRACE(sign * degrees);
      const double angle = sign * degrees * M_PI / 180;
      const auto on = [](double a) { return Vector3d(1 + std::cos(a), std::sin(a), 0.3); };
      Sketch s;
      const int a = s.add_node(on(0.2)), b = s.add_node(on(0.2 + angle));
      s.add_stroke(StrokeKind::kArc, a, b, {on(0.2 + angle / 2)});
      expect_same_curves(s, open_step(step_of(s)), 1);
    }
}

TEST(Step, WritesAnArcWithoutSagittaAsALine) {
  for (double sagitta : {0.0, 1e-12, 1e-8}) {
    Sketch s;
    const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0});
    s.add_stroke(StrokeKind::kArc, a, b, {{0.5, sagitta, 0}});
    const Shape shape = open_step(step_of(s));
    ASSERT_EQ(shape.edges.Extent(), 1);
    EXPECT_EQ(BRepAdaptor_Curve(shape.edge(0)).GetType(), GeomAbs_Line);
    EXPECT_NEAR(length_of(shape.edge(0)), 1, 1e-9);
  }
}

TEST(Step, SharesVerticesAndWritesChainsAsSuch) {
  Sketch s;  // a closed square, a star of three, a closed cubic
  int corner[4];
  for (int k = 0; k < 4; ++k) corner[k] = s.add_node({k == 1 || k == 2 ? 1.0 : 0.0, k / 2.0, 0});
  for (int k = 0; k < 4; ++k) s.add_stroke(StrokeKind::kLine, corner[k], corner[(k + 1) % 4], {});
  const int hub = s.add_node({5, 0, 0});
  for (int k = 0; k < 3; ++k) {
    const int tip = s.add_node(Vector3d(5, 0, 0) + Vector3d::Unit(k));
    s.add_stroke(StrokeKind::kLine, hub, tip, {});
  }
  const int loop = s.add_node({9, 0, 0});
  s.add_stroke(StrokeKind::kBezier, loop, loop, {{10, 0, 0}, {9, 1, 0}});
  const std::string text = step_of(s);
  const std::regex set("=CONNECTED_EDGE_SET\\(");
  EXPECT_EQ(std::distance(std::sregex_iterator(text.begin(), text.end(), set), {}), 1 + 3 + 1);
  const Shape shape = open_step(text);
  EXPECT_EQ(shape.vertices.Extent(), 9);
  expect_same_curves(s, shape, 1);
}

TEST(Step, WritesASmoothChainAsOneSplineOfTheSameLength) {
  const Sketch s = smooth_chain();
  const std::string text = step_of(s);
  const Shape shape = open_step(text);
  ASSERT_EQ(shape.edges.Extent(), 2);
  EXPECT_EQ(shape.vertices.Extent(), 3);
  double sum = 0, length = 0;
  for (int i = 0; i < 2; ++i) length += length_of(shape.edge(i));
  for (int i = 0; i < s.size(); ++i) sum += stroke_length(s, i);
  EXPECT_NEAR(length, sum, 1e-4 * sum);
  EXPECT_THAT(text, testing::HasSubstr("(4,2,2,4)"));
}

TEST(Step, KeepsTheCornersOfACubeApart) {
  Sketch s;
  for (int n = 0; n < 8; ++n) s.add_node({double(n & 1), double(n >> 1 & 1), double(n >> 2 & 1)});
  for (int n = 0; n < 8; ++n)
    for (int bit : {1, 2, 4})
      if (!(n & bit)) s.add_stroke(StrokeKind::kLine, n, n | bit, {});
  expect_same_curves(s, open_step(step_of(s)), 1);
}

TEST(Step, KeepsAnyGraphAsItIs) {
  Random random;
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE(round);
    Sketch s;
    for (int n = 0; n < 10; ++n) s.add_node(random.point());
    for (int i = 0; i < 8 + round; ++i) {
      const int a = int(random.engine() % 10), b = int(random.engine() % 10);
      const Vector3d apex = (s.nodes.col(a) + s.nodes.col(b)) / 2 + 0.3 * random.point();
      if (i % 3 == 0) {
        s.add_stroke(StrokeKind::kBezier, a, b, {random.point(), random.point()});
      } else if (a != b) {
        s.add_stroke(i % 3 == 1 ? StrokeKind::kLine : StrokeKind::kArc, a, b,
                     i % 3 == 1 ? std::vector<Vector3d>() : std::vector<Vector3d>{apex});
      }
    }
    s = keep_strokes(s, std::vector<bool>(s.size(), true));  // drops the nodes left over
    const Shape shape = open_step(step_of(s));
    ASSERT_EQ(shape.edges.Extent(), s.size());
    EXPECT_EQ(shape.vertices.Extent(), s.nodes.cols());
    double length = 0, expected = 0;
    for (int i = 0; i < s.size(); ++i) {
      length += length_of(shape.edge(i));
      expected += stroke_length(s, i);
    }
    EXPECT_NEAR(length, expected, 1e-6 * expected);
  }
}

TEST(Step, IsValidWithoutStrokes) {
  const std::string text = step_of(Sketch(), {"nothing", 1});
  const Shape shape = open_step(text);
  EXPECT_TRUE(shape.read);
  EXPECT_EQ(shape.edges.Extent(), 0);
  EXPECT_THAT(text, HasSubstr("PRODUCT('nothing','nothing'"));
  EXPECT_THAT(text, Not(HasSubstr("EDGE_BASED")));
}

TEST(Step, EscapesTheNameOfThePart) {
  const std::string text = step_of(all_kinds(), {"Bob's caf\xc3\xa9 \\ \xf0\x9f\x98\x80\xff", 1});
  const std::string name = R"('Bob''s caf\X2\00E9\X0\ \\ \X4\0001F600\X0\\X2\FFFD\X0\')";
  EXPECT_THAT(text, HasSubstr("PRODUCT(" + name + "," + name));
  EXPECT_TRUE(open_step(text).read);
  for (char c : text) EXPECT_TRUE(c == '\n' || (c >= 32 && c < 127));
}

TEST(Step, WritesEveryRealWithAPointAndColoursEveryEdge) {
  const Sketch s = moved(all_kinds(), 1e-9, Eigen::Matrix3d::Identity(), {1, 0, 0});
  const std::string text = step_of(s);
  const std::regex point("CARTESIAN_POINT\\('',\\(([^)]*)\\)\\)");
  const std::regex real("-?[0-9]+\\.[0-9]*(E[-+]?[0-9]+)?");
  int points = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), point), end; it != end; ++it, ++points) {
    std::istringstream numbers((*it)[1].str());
    for (std::string x; std::getline(numbers, x, ',');) EXPECT_TRUE(std::regex_match(x, real)) << x;
  }
  EXPECT_GT(points, 10);
  const std::regex styled("=STYLED_ITEM\\("), colour("=COLOUR_RGB\\(");
  EXPECT_EQ(std::distance(std::sregex_iterator(text.begin(), text.end(), styled), {}), s.size());
  EXPECT_EQ(std::distance(std::sregex_iterator(text.begin(), text.end(), colour), {}), 6);
}

TEST(Step, RefersOnlyToEntitiesThatAreThere) {
  const std::string text = step_of(all_kinds());
  const std::regex define("(^|\n)#([0-9]+)="), refer("#([0-9]+)[^0-9=]");
  std::set<int> defined;
  for (std::sregex_iterator it(text.begin(), text.end(), define), end; it != end; ++it)
    EXPECT_TRUE(defined.insert(std::stoi((*it)[2])).second) << "defined twice";
  for (std::sregex_iterator it(text.begin(), text.end(), refer), end; it != end; ++it)
    EXPECT_EQ(defined.count(std::stoi((*it)[1])), 1u) << (*it)[0];
}

TEST(Step, OpensInFreeCad) {
  std::string command;
  for (const char* name : {"freecadcmd", "FreeCADCmd"})
    if (std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0)
      command = name;
  if (command.empty()) GTEST_SKIP() << "FreeCAD (freecadcmd) is not installed.";
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "sketchsplat_freecad";
  fs::create_directories(folder);
  std::ofstream(folder / "part.step") << step_of(all_kinds());
  std::ofstream(folder / "count.py")
      << "import Part\ns = Part.Shape()\ns.read('" << (folder / "part.step").string()
      << "')\nkinds = sorted(e.Curve.TypeId.split('::')[1] for e in s.Edges)\n"
      << "open('" << (folder / "kinds.txt").string() << "', 'w').write(' '.join(kinds))\n";
  ASSERT_EQ(
      std::system(
          (command + " " + (folder / "count.py").string() + " >/dev/null 2>&1 </dev/null").c_str()),
      0);
  std::ifstream in(folder / "kinds.txt");
  const std::string kinds{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(kinds,
            "GeomBSplineCurve GeomCircle GeomCircle GeomEllipse GeomEllipse GeomLine GeomLine");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/io/io.h"
#include "sketches/io/io_number.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kStraight = 1e-7;  // of the extent: arcs flatter than this are lines

// Layers by kind (order: StrokeKind) and their AutoCAD colours, about those of kind_color(): blue,
// orange, red, magenta, green, rose.
constexpr const char* kLayer[kNumKinds] = {"LINE",    "ARC",    "CIRCLE",
                                           "ELLIPSE", "SPLINE", "ELLIPTIC_ARC"};
constexpr int kColour[kNumKinds] = {5, 30, 1, 6, 3, 230};

// Axes that AutoCAD gives to the plane of an extrusion direction.
void arbitrary_axes(const Vector3d& normal, Vector3d* x, Vector3d* y) {
  const bool near_z = std::abs(normal.x()) < 1.0 / 64 && std::abs(normal.y()) < 1.0 / 64;
  *x = (near_z ? Vector3d::UnitY() : Vector3d::UnitZ()).cross(normal).normalized();
  *y = normal.cross(*x).normalized();
}

double degrees(double radians) {
  const double d = radians * 180 / M_PI;
  return d < 0 ? d + 360 : d;
}

// Writes pairs of group code and value, and a handle for everything that needs one.
class DxfFile {
 public:
  DxfFile(std::ostream& out, double scale) : out_(out), scale_(scale) {}

  DxfFile& text(int code, const std::string& value) {
    out_ << code << "\n" << value << "\n";
    return *this;
  }
  DxfFile& whole(int code, int value) { return text(code, std::to_string(value)); }
  DxfFile& real(int code, double x) { return text(code, shortest(x == 0 ? 0.0 : x)); }
  DxfFile& length(int code, double x) { return real(code, scale_ * x); }
  DxfFile& vector(int code, const Vector3d& v) {
    return real(code, v.x()).real(code + 10, v.y()).real(code + 20, v.z());
  }
  DxfFile& point(int code, const Vector3d& p) { return vector(code, scale_ * p); }
  DxfFile& section(const char* name) { return text(0, "SECTION").text(2, name); }
  DxfFile& handle() { return text(5, hexadecimal(next_++)); }
  DxfFile& owner(int of) { return text(330, hexadecimal(of)); }
  DxfFile& subclass(const std::string& name) { return text(100, "AcDb" + name); }

 private:
  static std::string hexadecimal(int x) {
    char digits[12];
    std::snprintf(digits, sizeof(digits), "%X", unsigned(x));
    return digits;
  }
  std::ostream& out_;
  double scale_;
  int next_ = 0x100;  // what is referred to has fixed handles below
};

// Fixed handles of what others refer to.
constexpr int kModelSpace = 0x1F, kPaperSpace = 0x1B, kRecords = 0x1, kRoot = 0xC;
const char* const kHandSeed = "FFFFFF";

int insertion_unit(LengthUnit unit) {
  constexpr int kCodes[] = {4, 5, 6, 1};
  return kCodes[int(unit)];
}

void write_header(DxfFile* file, const Sketch& sketch, LengthUnit unit) {
  Eigen::AlignedBox3d box(Vector3d(0, 0, 0), Vector3d(0, 0, 0));
  if (sketch.size() > 0) box.setEmpty();
  for (int i = 0; i < sketch.size(); ++i) {
    const Eigen::Matrix3Xd points = sample_stroke(sketch, i, stroke_length(sketch, i) / 32);
    for (int k = 0; k < points.cols(); ++k) box.extend(points.col(k));
  }
  file->section("HEADER").text(9, "$ACADVER").text(1, "AC1015").text(9, "$HANDSEED");
  file->text(5, kHandSeed).text(9, "$INSUNITS").whole(70, insertion_unit(unit));
  file->text(9, "$MEASUREMENT").whole(70, unit == LengthUnit::kInch ? 0 : 1);
  file->text(9, "$EXTMIN").point(10, box.min()).text(9, "$EXTMAX").point(10, box.max());
  file->text(0, "ENDSEC");
}

// Start of a table with `count` entries, and of one entry.
void start_table(DxfFile* file, const char* name, int count, int handle = 0) {
  file->text(0, "TABLE").text(2, name);
  if (handle)
    file->text(5, "1");
  else
    file->handle();
  file->owner(0).subclass("SymbolTable").whole(70, count);
}

DxfFile& entry(DxfFile* file, const char* type, const char* record, const std::string& name) {
  file->text(0, type).handle().owner(0).subclass("SymbolTableRecord");
  return file->subclass(std::string(record) + "TableRecord").text(2, name).whole(70, 0);
}

void write_tables(DxfFile* file) {
  file->section("TABLES");
  start_table(file, "VPORT", 0);
  file->text(0, "ENDTAB");
  start_table(file, "LTYPE", 3);
  for (const char* name : {"ByBlock", "ByLayer", "Continuous"})
    entry(file, "LTYPE", "Linetype", name).text(3, "").whole(72, 65).whole(73, 0).real(40, 0);
  file->text(0, "ENDTAB");
  start_table(file, "LAYER", kNumKinds + 1);
  entry(file, "LAYER", "Layer", "0").whole(62, 7).text(6, "Continuous");
  for (int k = 0; k < kNumKinds; ++k)
    entry(file, "LAYER", "Layer", kLayer[k]).whole(62, kColour[k]).text(6, "Continuous");
  file->text(0, "ENDTAB");
  start_table(file, "STYLE", 1);
  entry(file, "STYLE", "TextStyle", "Standard").real(40, 0).real(41, 1).real(50, 0).whole(71, 0);
  file->real(42, 2.5).text(3, "txt").text(4, "").text(0, "ENDTAB");
  for (const char* name : {"VIEW", "UCS"}) {
    start_table(file, name, 0);
    file->text(0, "ENDTAB");
  }
  start_table(file, "APPID", 1);
  entry(file, "APPID", "RegApp", "ACAD");
  file->text(0, "ENDTAB");
  start_table(file, "DIMSTYLE", 0);
  file->subclass("DimStyleTable").whole(71, 0).text(0, "ENDTAB");
  start_table(file, "BLOCK_RECORD", 2, kRecords);
  for (const auto& [name, handle] :
       {std::pair("*Model_Space", "1F"), std::pair("*Paper_Space", "1B")})
    file->text(0, "BLOCK_RECORD")
        .text(5, handle)
        .owner(kRecords)
        .subclass("SymbolTableRecord")
        .subclass("BlockTableRecord")
        .text(2, name);
  file->text(0, "ENDTAB").text(0, "ENDSEC");
}

void write_blocks(DxfFile* file) {
  file->section("BLOCKS");
  for (const auto& [name, record] :
       {std::pair("*Model_Space", kModelSpace), std::pair("*Paper_Space", kPaperSpace)}) {
    file->text(0, "BLOCK").handle().owner(record).subclass("Entity").text(8, "0");
    file->subclass("BlockBegin").text(2, name).whole(70, 0).vector(10, {0, 0, 0}).text(3, name);
    file->text(1, "").text(0, "ENDBLK").handle().owner(record).subclass("Entity").text(8, "0");
    file->subclass("BlockEnd");
  }
  file->text(0, "ENDSEC");
}

DxfFile& entity(DxfFile* file, const char* type, StrokeKind kind) {
  file->text(0, type).handle().owner(kModelSpace).subclass("Entity");
  return file->text(8, kLayer[int(kind)]);
}

void write_circle(DxfFile* file, StrokeKind kind, const CircleParameters& c,
                  const Vector3d& begin) {
  Vector3d x, y;
  arbitrary_axes(c.normal, &x, &y);
  const bool arc = kind == StrokeKind::kArc;
  entity(file, arc ? "ARC" : "CIRCLE", kind).subclass("Circle");
  file->point(10, {c.centre.dot(x), c.centre.dot(y), c.centre.dot(c.normal)});
  file->length(40, c.radius).vector(210, c.normal);
  if (!arc) return;
  const Vector3d from = begin - c.centre;
  const double start = std::atan2(from.dot(y), from.dot(x));
  file->subclass("Arc").real(50, degrees(start));
  file->real(51, std::fmod(degrees(start + c.angle), 360));
}

// From angle `first` to `last` about the principal axes [rad].
void write_ellipse(DxfFile* file, StrokeKind kind, const Vector3d& centre, const EllipseAxes& axes,
                   double first, double last) {
  entity(file, "ELLIPSE", kind).subclass("Ellipse").point(10, centre);
  file->point(11, axes.major).vector(210, axes.major.cross(axes.minor).normalized());
  const double ratio = axes.minor.norm() / axes.major.norm();
  file->real(40, std::min(ratio, 1.0)).real(41, first).real(42, last);
}

void write_elliptic_arc(DxfFile* file, const EllipticArcParameters& e) {
  double shift = 0;
  const EllipseAxes axes = principal_axes(e.p, e.q, &shift);
  const auto turn = [](double a) { return a - 2 * M_PI * std::floor(a / (2 * M_PI)); };
  write_ellipse(file, StrokeKind::kEllipticArc, e.centre, axes, turn(-e.half_angle - shift),
                turn(e.half_angle - shift));
}

void write_spline(DxfFile* file, const Spline& spline) {
  const int n = int(spline.breaks.size()), points = int(spline.points.cols());
  entity(file, "SPLINE", StrokeKind::kBezier).subclass("Spline").whole(70, 0).whole(71, 3);
  file->whole(72, points + 4).whole(73, points).whole(74, 0);
  for (int k = 0; k < n; ++k)
    for (int m = 0; m < (k == 0 || k == n - 1 ? 4 : 2); ++m) file->real(40, spline.breaks[k]);
  for (int k = 0; k < points; ++k) file->point(10, spline.points.col(k));
}

void write_line(DxfFile* file, StrokeKind kind, const Vector3d& begin, const Vector3d& end) {
  entity(file, "LINE", kind).subclass("Line").point(10, begin).point(11, end);
}

void write_entity(DxfFile* file, const Sketch& sketch, const CurveChain& chain, double straight) {
  const int i = chain.strokes[0];
  const StrokeKind kind = sketch.strokes[i].kind;
  const ControlPoints c = control_points(sketch, i);
  if (kind == StrokeKind::kLine) {
    write_line(file, kind, c.p[0], c.p[1]);
  } else if (kind == StrokeKind::kEllipse) {
    write_ellipse(file, kind, c.p[0], principal_axes(c.p[1], c.p[2]), 0, 2 * M_PI);
  } else if (kind == StrokeKind::kEllipticArc) {
    const EllipticArcParameters e = elliptic_arc_parameters(c);
    if (e.straight || (c.p[1] - (c.p[0] + c.p[3]) / 2).norm() <= straight)
      write_line(file, kind, c.p[0], c.p[3]);
    else
      write_elliptic_arc(file, e);
  } else if (kind == StrokeKind::kBezier) {
    write_spline(file, chain_spline(sketch, chain));
  } else {
    const CircleParameters circle = circle_parameters(sketch, i);
    const double sagitta =
        circle.straight ? 0 : 2 * circle.radius * std::pow(std::sin(circle.angle / 4), 2);
    if (kind == StrokeKind::kArc && sagitta <= straight)
      write_line(file, kind, c.p[0], c.p[2]);
    else
      write_circle(file, kind, circle, c.p[0]);
  }
}

// The dictionary of dictionaries, with the one that AutoCAD insists on.
void write_objects(DxfFile* file) {
  file->section("OBJECTS").text(0, "DICTIONARY").text(5, "C").owner(0).subclass("Dictionary");
  file->whole(281, 1).text(3, "ACAD_GROUP").text(350, "D");
  file->text(0, "DICTIONARY").text(5, "D").owner(kRoot).subclass("Dictionary").whole(281, 1);
  file->text(0, "ENDSEC");
}

}  // namespace

void write_dxf(std::ostream& out, const Sketch& sketch, const DxfOptions& options) {
  DxfFile file(out, options.scale);
  write_header(&file, sketch, options.unit);
  write_tables(&file);
  write_blocks(&file);
  file.section("ENTITIES");
  const double straight = kStraight * largest_extent(sketch);
  for (const CurveChain& chain : curve_chains(sketch)) write_entity(&file, sketch, chain, straight);
  file.text(0, "ENDSEC");
  write_objects(&file);
  file.text(0, "EOF");
}

}  // namespace sketchsplat

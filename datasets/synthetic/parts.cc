// SPDX-License-Identifier: MIT
#include "datasets/synthetic/parts.h"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Tool.hxx>
#include <Eigen/Geometry>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>
#include <cmath>
#include <functional>
#include <iterator>
#include <random>

#include "datasets/errors.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Dimensions in millimetres.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * double(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

TopoDS_Shape box(const Vector3d& corner, const Vector3d& size) {
  return BRepPrimAPI_MakeBox(gp_Pnt(corner.x(), corner.y(), corner.z()), size.x(), size.y(),
                             size.z());
}
gp_Ax2 axis(const Vector3d& base, const Vector3d& along) {
  return gp_Ax2(gp_Pnt(base.x(), base.y(), base.z()), gp_Dir(along.x(), along.y(), along.z()));
}
TopoDS_Shape cylinder(const Vector3d& base, const Vector3d& along, double radius) {
  return BRepPrimAPI_MakeCylinder(axis(base, along), radius, along.norm());
}
TopoDS_Shape cone(const Vector3d& base, const Vector3d& along, double bottom, double top) {
  return BRepPrimAPI_MakeCone(axis(base, along), bottom, top, along.norm());
}
TopoDS_Shape prism(const std::vector<Vector3d>& polygon, const Vector3d& along) {
  BRepBuilderAPI_MakePolygon wire;
  for (const Vector3d& p : polygon) wire.Add(gp_Pnt(p.x(), p.y(), p.z()));
  wire.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(),
                               gp_Vec(along.x(), along.y(), along.z()));
}
TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b) { return BRepAlgoAPI_Cut(a, b); }
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Common(a, b);
}
// Faces that continue one another become one, so that no seam is left where the parts met.
TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  ShapeUpgrade_UnifySameDomain unify(BRepAlgoAPI_Fuse(a, b).Shape());
  unify.Build();
  return unify.Shape();
}

// Straight edges of a shape by their end points.
std::vector<TopoDS_Edge> edges_where(
    const TopoDS_Shape& shape, const std::function<bool(const Vector3d&, const Vector3d&)>& take) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, TopAbs_EDGE, map);
  std::vector<TopoDS_Edge> edges;
  const auto point = [](const TopoDS_Vertex& v) {
    const gp_Pnt p = BRep_Tool::Pnt(v);
    return Vector3d(p.X(), p.Y(), p.Z());
  };
  for (int i = 1; i <= map.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(map(i));
    if (take(point(TopExp::FirstVertex(edge)), point(TopExp::LastVertex(edge))))
      edges.push_back(edge);
  }
  return edges;
}
bool vertical(const Vector3d& a, const Vector3d& b) {
  return (a - b).head<2>().norm() < 1e-6 * (a - b).norm();
}
TopoDS_Shape fillet(const TopoDS_Shape& shape, const std::vector<TopoDS_Edge>& edges, double r) {
  BRepFilletAPI_MakeFillet maker(shape);
  for (const TopoDS_Edge& edge : edges) maker.Add(r, edge);
  return maker.Shape();
}
TopoDS_Shape chamfer(const TopoDS_Shape& shape, const std::vector<TopoDS_Edge>& edges, double d) {
  BRepFilletAPI_MakeChamfer maker(shape);
  for (const TopoDS_Edge& edge : edges) maker.Add(d, edge);
  return maker.Shape();
}

Vector3d random_size(Dice& dice) {
  const double x = dice.between(50, 80), y = dice.between(30, 50), z = dice.between(20, 40);
  return {x, y, z};
}

TopoDS_Shape plain_box(Dice& dice) { return box(Vector3d::Zero(), random_size(dice)); }

TopoDS_Shape box_hole(Dice& dice) {
  const Vector3d size = random_size(dice);
  const double r = dice.between(0.15, 0.35) * size.y();
  const Vector3d base(dice.between(0.42, 0.58) * size.x(), size.y() / 2, -1);
  return cut(box(Vector3d::Zero(), size), cylinder(base, {0, 0, size.z() + 2}, r));
}

TopoDS_Shape plate_holes(Dice& dice) {
  const Vector3d size(dice.between(70, 90), dice.between(45, 60), dice.between(6, 12));
  const double r = dice.between(2.5, 5), inset = dice.between(8, 11);
  TopoDS_Shape shape = box(Vector3d::Zero(), size);
  const Vector3d through(0, 0, size.z() + 2);
  for (double x : {inset, size.x() - inset})
    for (double y : {inset, size.y() - inset}) shape = cut(shape, cylinder({x, y, -1}, through, r));
  return cut(shape, cylinder({size.x() / 2, size.y() / 2, -1}, through, dice.between(9, 13)));
}

TopoDS_Shape stepped_shaft(Dice& dice) {
  TopoDS_Shape shape;
  double z = 0;
  const double r = dice.between(8, 12);
  for (double radius : {r, r * dice.between(1.5, 1.9), r * dice.between(1.2, 1.35), 0.6 * r}) {
    const double length = dice.between(14, 26);
    const TopoDS_Shape step = cylinder({0, 0, z}, {0, 0, length}, radius);
    shape = shape.IsNull() ? step : fuse(shape, step);
    z += length;
  }
  return shape;
}

TopoDS_Shape l_bracket(Dice& dice) {
  const double a = dice.between(45, 60), b = dice.between(35, 50), w = dice.between(28, 40);
  const double t = dice.between(6, 10), r = dice.between(4, 6);
  const TopoDS_Shape angle =
      prism({{0, 0, 0}, {a, 0, 0}, {a, 0, t}, {t, 0, t}, {t, 0, b}, {0, 0, b}}, Vector3d(0, w, 0));
  const TopoDS_Shape one = cut(angle, cylinder({0.65 * a, w / 2, -1}, {0, 0, t + 2}, r));
  return cut(one, cylinder({-1, w / 2, 0.65 * b}, {t + 2, 0, 0}, r));
}

TopoDS_Shape pocket_block(Dice& dice) {
  const Vector3d size = random_size(dice);
  const double wall = dice.between(5, 8), r = dice.between(2.5, 6);
  const double floor = dice.between(0.3, 0.6) * size.z();
  TopoDS_Shape hollow =
      box({wall, wall, floor}, {size.x() - 2 * wall, size.y() - 2 * wall, size.z()});
  hollow = fillet(hollow, edges_where(hollow, vertical), r);
  return cut(box(Vector3d::Zero(), size), hollow);
}

TopoDS_Shape box_fillet(Dice& dice) {
  const TopoDS_Shape shape = plain_box(dice);
  return fillet(shape, edges_where(shape, vertical), dice.between(5, 10));
}

TopoDS_Shape box_chamfer(Dice& dice) {
  const Vector3d size = random_size(dice);
  const auto on_top = [&](const Vector3d& a, const Vector3d& b) {
    return std::min(a.z(), b.z()) > 0.5 * size.z();
  };
  const TopoDS_Shape shape = box(Vector3d::Zero(), size);
  return chamfer(shape, edges_where(shape, on_top), dice.between(4, 8));
}

TopoDS_Shape slotted_sheet(Dice& dice) {
  const double a = dice.between(70, 90), b = dice.between(40, 60), t = dice.between(1.2, 2.5);
  const int slots = 2 + int(dice.between(0, 2.999));
  const double r = dice.between(2, 3.5), length = dice.between(0.4, 0.6) * b;
  TopoDS_Shape shape = box(Vector3d::Zero(), {a, b, t});
  for (int i = 0; i < slots; ++i) {
    const double x = a * (i + 1) / (slots + 1), y = (b - length) / 2;
    const Vector3d through(0, 0, t + 2);
    TopoDS_Shape slot = box({x - r, y, -1}, {2 * r, length, t + 2});
    slot = fuse(slot, cylinder({x, y, -1}, through, r));
    shape = cut(shape, fuse(slot, cylinder({x, y + length, -1}, through, r)));
  }
  return shape;
}

TopoDS_Shape cut_cylinder(Dice& dice) {
  const double r = dice.between(14, 22), h = dice.between(40, 60);
  const double rise = dice.between(0.3, 0.8) * 2 * r;
  const double low = h - rise, big = 3 * r;
  // A wedge whose slanted face passes through (-r, low) and (r, h).
  const double slope = rise / (2 * r), left = low + slope * (r - big),
               right = h + slope * (big - r);
  const TopoDS_Shape wedge = prism(
      {{-big, -big, left}, {big, -big, right}, {big, -big, right + big}, {-big, -big, right + big}},
      Vector3d(0, 2 * big, 0));
  return cut(cylinder(Vector3d::Zero(), {0, 0, h + 5}, r), wedge);
}

TopoDS_Shape frustum(Dice& dice) {
  const double r = dice.between(18, 26);
  return cone(Vector3d::Zero(), {0, 0, dice.between(30, 50)}, r, dice.between(0.3, 0.7) * r);
}

TopoDS_Shape hex_nut(Dice& dice) {
  const double across = dice.between(28, 40), h = dice.between(0.4, 0.6) * across;
  const double corner = across / std::sqrt(3.0), bore = dice.between(0.25, 0.32) * across;
  std::vector<Vector3d> hexagon;
  for (int i = 0; i < 6; ++i)
    hexagon.emplace_back(corner * std::cos(i * M_PI / 3), corner * std::sin(i * M_PI / 3), 0);
  TopoDS_Shape nut = prism(hexagon, Vector3d(0, 0, h));
  // 30 degree chamfers take the corners away and leave hyperbolas on the six flats.
  const double slope = std::tan(M_PI / 6), flat = 0.475 * across;
  const double wide = 2 * across, rise = (wide - flat) * slope;
  nut = common(nut, cone({0, 0, h - rise}, {0, 0, rise}, wide, flat));
  nut = common(nut, cone({0, 0, 0}, {0, 0, rise}, flat, wide));
  return cut(nut, cylinder({0, 0, -1}, {0, 0, h + 2}, bore));
}

TopoDS_Shape dome_plate(Dice& dice) {
  const Vector3d size(dice.between(60, 80), dice.between(50, 60), dice.between(8, 14));
  const double r = dice.between(14, 20), sink = dice.between(0.0, 0.4) * r;
  const TopoDS_Shape ball =
      BRepPrimAPI_MakeSphere(gp_Pnt(size.x() / 2, size.y() / 2, size.z() - sink), r);
  const TopoDS_Shape above = box({-100, -100, size.z() / 2}, {300, 300, 100});
  return fuse(box(Vector3d::Zero(), size), common(ball, above));
}

TopoDS_Shape flange(Dice& dice) {
  const double r = dice.between(30, 40), t = dice.between(6, 10),
               hub = dice.between(0.35, 0.45) * r;
  const double h = dice.between(15, 25), hole = dice.between(2.5, 4);
  const int count = 4 + int(dice.between(0, 2.999));
  TopoDS_Shape shape = fuse(cylinder(Vector3d::Zero(), {0, 0, t}, r),
                            cylinder(Vector3d::Zero(), {0, 0, t + h}, hub));
  shape = cut(shape, cylinder({0, 0, -1}, {0, 0, t + h + 2}, dice.between(0.5, 0.7) * hub));
  for (int i = 0; i < count; ++i) {
    const double a = 2 * M_PI * i / count, d = 0.72 * r;
    shape = cut(shape, cylinder({d * std::cos(a), d * std::sin(a), -1}, {0, 0, t + 2}, hole));
  }
  return shape;
}

TopoDS_Shape tee(Dice& dice) {
  const double r = dice.between(12, 16), length = dice.between(50, 70);
  const double branch = dice.between(0.6, 0.85) * r, h = dice.between(1.6, 2.2) * r;
  return fuse(cylinder({-length / 2, 0, 0}, {length, 0, 0}, r),
              cylinder(Vector3d::Zero(), {0, 0, h}, branch));
}

TopoDS_Shape u_channel(Dice& dice) {
  const double w = dice.between(30, 45), h = dice.between(25, 40), length = dice.between(55, 75);
  const double t = dice.between(4, 7), r = dice.between(4, 6);
  const TopoDS_Shape u =
      cut(box(Vector3d::Zero(), {length, w, h}), box({-1, t, t}, {length + 2, w - 2 * t, h}));
  return cut(u, cylinder({length / 3, -1, 0.6 * h}, {0, w + 2, 0}, r));
}

struct Part {
  const char* name;
  TopoDS_Shape (*make)(Dice&);
};
// A part is one line here and one function above.
const Part kParts[] = {
    {"box", plain_box},
    {"box-hole", box_hole},
    {"plate-holes", plate_holes},
    {"stepped-shaft", stepped_shaft},
    {"l-bracket", l_bracket},
    {"pocket-block", pocket_block},
    {"box-fillet", box_fillet},
    {"box-chamfer", box_chamfer},
    {"slotted-sheet", slotted_sheet},
    {"cut-cylinder", cut_cylinder},
    {"frustum", frustum},
    {"hex-nut", hex_nut},
    {"dome-plate", dome_plate},
    {"flange", flange},
    {"tee", tee},
    {"u-channel", u_channel},
};
static_assert(std::size(kParts) == std::size(kPartNames), "parts.h names every part");

}  // namespace

Brep make_part(const std::string& name, std::uint64_t seed) {
  for (const Part& part : kParts) {
    if (name != part.name) continue;
    Dice dice(seed);
    return {std::make_shared<const TopoDS_Shape>(part.make(dice))};
  }
  std::string known;
  for (const Part& part : kParts) known += (known.empty() ? "" : ", ") + std::string(part.name);
  throw InputError(name, "a STEP file or one of " + known, "neither");
}

}  // namespace sketchsplat

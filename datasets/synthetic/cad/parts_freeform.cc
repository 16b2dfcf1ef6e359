// SPDX-License-Identifier: MIT
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepTools.hxx>
#include <Eigen/Geometry>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Wire.hxx>
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Parts with B-splines: outlines, lofts, sweeps and surfaces through points.

namespace sketchsplat {
namespace {

gp_Pnt pnt(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

TopoDS_Shape spline_plate(const Dimensions& d) {
  const double size = d["size"], t = d["thickness"] * size;
  const int lobes = int(d["lobes"]), n = 12 * lobes;
  std::vector<Vector3d> points;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n, r = size * (1 + d["wave"] * std::cos(lobes * a));
    points.emplace_back(r * std::cos(a), r * std::sin(a), 0);
  }
  return cut(prism(blob(points), Vector3d(0, 0, t)),
             cylinder({0, 0, -1}, {0, 0, t + 2}, d["bore"] * size));
}

TopoDS_Shape wave_block(const Dimensions& d) {
  const double length = d["length"], h = d["height"], phase = d["phase"] * M_PI / 180;
  const auto top = [&](double x) {
    return Vector3d(x, 0, h * (1 + d["wave"] * std::sin(2 * M_PI * x / length + phase)));
  };
  std::vector<Vector3d> crest;
  constexpr int kPieces = 10;
  for (int i = kPieces - 1; i >= 0; --i) crest.push_back(top(length * i / kPieces));
  const TopoDS_Face face =
      Outline({0, 0, 0}).line({length, 0, 0}).line(top(length)).spline(crest).face();
  return prism(face, Vector3d(0, d["width"], 0));
}

// From a cushion over a waist to another cushion, turned: its four edges twist.
TopoDS_Shape loft_grip(const Dimensions& d) {
  const double r = d["radius"], length = d["length"], turn = d["turn"] * M_PI / 180;
  const auto section = [&](double z, double half, double angle) {
    const auto at = [&](double radius, int eighth) {
      const double a = angle + eighth * M_PI / 4;
      return Vector3d(radius * std::cos(a), radius * std::sin(a), z);
    };
    const double corner = half * std::sqrt(2.0), side = (1 + d["bulge"]) * half;
    Outline outline(at(corner, 0));
    for (int i = 1; i < 8; i += 2) outline.arc(at(side, i), at(corner, i + 1));
    return BRepTools::OuterWire(outline.face());
  };
  BRepOffsetAPI_ThruSections loft(/*isSolid=*/true, /*ruled=*/false);
  loft.AddWire(section(0, d["flare"] * r, 0));
  loft.AddWire(section(length / 2, d["waist"] * r, turn / 2));
  loft.AddWire(section(length, r, turn));
  loft.Build();
  return cut(loft.Shape(), cylinder({0, 0, -1}, {0, 0, length + 2}, 0.4 * d["waist"] * r));
}

// A bar along a curve that leaves every plane, upright everywhere.
TopoDS_Shape swept_rail(const Dimensions& d) {
  const double length = d["length"], sway = d["sway"] * length, rise = d["rise"] * length;
  const Vector3d across(0, d["width"] * length / 2, 0), up(0, 0, d["height"] * length / 2);
  BRepOffsetAPI_ThruSections sweep(/*isSolid=*/true, /*ruled=*/false);
  constexpr int kSections = 9;
  for (int i = 0; i < kSections; ++i) {
    const double s = double(i) / (kSections - 1);
    const Vector3d at(length * s, sway * std::sin(2 * M_PI * s) / 2, rise * s * s);
    Outline outline(at - across - up);
    outline.line(at + across - up).line(at + across + up).line(at - across + up);
    sweep.AddWire(BRepTools::OuterWire(outline.face()));
  }
  sweep.Build();
  return sweep.Shape();
}

// A block whose top is a surface through points.
TopoDS_Shape freeform_pad(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const double bulge = d["bulge"] * length, skew = d["skew"] * length;
  constexpr int kPoints = 7;
  TColgp_Array2OfPnt points(1, kPoints, 1, kPoints);
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      const double s = -0.1 + 1.2 * i / (kPoints - 1), t = -0.1 + 1.2 * j / (kPoints - 1);
      const double z = h + bulge * std::sin(M_PI * s) * std::cos(M_PI * (t - 0.4)) +
                       skew * (2 * s - 1) * (2 * t - 1);
      points.SetValue(i + 1, j + 1, pnt({s * length, t * w, z}));
    }
  const Handle(Geom_BSplineSurface) top = GeomAPI_PointsToBSplineSurface(points).Surface();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(top, 1e-6).Face();
  return cut(box(Vector3d::Zero(), {length, w, 2 * h}), prism(face, Vector3d(0, 0, 3 * h)));
}

}  // namespace

const std::vector<PartMaker>& freeform_parts() {
  static const std::vector<PartMaker> parts = {
      {"spline-plate", spline_plate}, {"wave-block", wave_block},     {"loft-grip", loft_grip},
      {"swept-rail", swept_rail},     {"freeform-pad", freeform_pad},
  };
  return parts;
}

}  // namespace sketchsplat

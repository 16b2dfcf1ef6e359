// SPDX-License-Identifier: MIT
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepTools.hxx>
#include <Eigen/Geometry>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Parts with rounded edges, where what is round is no edge and what is machined is one; parts with
// B-splines: outlines, lofts, sweeps and surfaces through points.

namespace sketchsplat {
namespace {

// A corner of a polygon, rounded by a radius (0: sharp).
struct Corner {
  Vector2d at;
  double radius;
};

// The same as a profile; it begins where the first corner ends.
std::vector<To> rounded(const std::vector<Corner>& corners) {
  const int n = int(corners.size());
  std::vector<To> places;
  for (int i = 1; i <= n; ++i) {
    const Corner& c = corners[i % n];
    const Vector2d before = (corners[(i + n - 1) % n].at - c.at).normalized();
    const Vector2d after = (corners[(i + 1) % n].at - c.at).normalized();
    const double half = std::acos(before.dot(after)) / 2, reach = c.radius / std::tan(half);
    const Vector2d enter = c.at + before * reach, leave = c.at + after * reach;
    places.push_back({enter.x(), enter.y()});
    if (!(c.radius > 0)) continue;
    // The middle of the arc lies on the line from the corner to the centre.
    const Vector2d middle =
        c.at + (before + after).normalized() * c.radius * (1 / std::sin(half) - 1);
    places.push_back({middle.x(), middle.y(), kThrough});
    places.push_back({leave.x(), leave.y()});
  }
  std::rotate(places.begin(), places.end() - 1, places.end());
  return places;
}

// An angle, all edges rounded, with a machined foot and a bore in either leg.
TopoDS_Shape cast_bracket(const Dimensions& d) {
  const double a = d["length"], w = d["width"], b = d["height"], t = d["leg"];
  const double r = d["round"], wide = 1.4 * r, bore = 0.16 * w;
  TopoDS_Shape shape = along_y(rounded({{{0, -wide}, wide},
                                        {{a, -wide}, wide},
                                        {{a, t}, wide},
                                        {{t, t}, wide},
                                        {{t, b}, wide},
                                        {{0, b}, wide}}),
                               w);
  const auto at_ends = [](const Vector3d& p, const Vector3d& q) {
    return std::abs(p.y() - q.y()) < 1e-9;
  };
  shape = fillet(shape, edges_where(shape, at_ends), r);
  shape = cut(shape, box({-1, -1, -1 - wide}, {a + 2, w + 2, 1 + wide}));
  shape = drilled(shape, 0.65 * a, w / 2, t, bore);
  return cut(shape, cylinder({-1, w / 2, 0.65 * b}, {t + 2, 0, 0}, bore));
}

// A step along x whose edges have rounds of different radii, and sharp ones among them.
TopoDS_Shape blend_step(const Dimensions& d) {
  const double w = d["width"], h = d["height"], r = d["round"], half = w / 2, step = d["step"];
  return along_x(rounded({{{0, 0}, 0},
                          {{w, 0}, 0},
                          {{w, step}, 0.6 * r},
                          {{half, step}, r},
                          {{half, h}, 0.4 * r},
                          {{0, h}, 0}}),
                 d["length"]);
}

// A flange whose rims are rounded, with a round groove to its hub; base and bores are machined.
TopoDS_Shape cast_flange(const Dimensions& d) {
  const double r = d["radius"], t = d["thickness"], h = d["hub-height"], hub = d["hub"];
  const double round = d["round"], at = 0.5 * (hub + r);
  const TopoDS_Shape shape = lathed(rounded({{{0.5 * hub, 0}, 0},
                                             {{r, 0}, 0},
                                             {{r, t}, round},
                                             {{hub, t}, round},
                                             {{hub, t + h}, 0.5 * round},
                                             {{0.5 * hub, t + h}, 0}}));
  return drilled_around(shape, int(d["holes"]), at, t, d["hole"]);
}

// What rounds an edge of a box that runs along x from `apex` to `end`, between faces that look
// along y * side and z: what lies between them and a cone that touches both, so that the radius
// grows from nothing to `radius`.
TopoDS_Shape taper_tool(const Vector3d& apex, double end, double side, double radius) {
  constexpr double kBeyond = 1.3;
  const Vector3d corner = apex + Vector3d(kBeyond * (end - apex.x()), 0, 0);
  const Vector3d y(0, side * kBeyond * radius, 0), z(0, 0, kBeyond * radius);
  const Vector3d top = corner - (1 - std::sqrt(0.5)) * (y + z);
  return pyramid(apex,
                 Outline(corner - y).line(corner).line(corner - z).arc(top, corner - y).face());
}

// Two of its edges are sharp up to their middle, and rounder and rounder from there.
TopoDS_Shape taper_block(const Dimensions& d) {
  const double length = d["length"], w = d["width"], h = d["height"], r = d["round"];
  const double x = d["sharp"];
  const TopoDS_Shape shape = cut(box(d), taper_tool({x, w, h}, length, 1, r));
  return cut(shape, taper_tool({length - x, 0, h}, 0, -1, r));
}

TopoDS_Shape spline_plate(const Dimensions& d) {
  const double t = d["thickness"];
  const int lobes = int(d["lobes"]), n = 12 * lobes;
  std::vector<Vector3d> points;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n, r = d["size"] + d["wave"] * std::cos(lobes * a);
    points.emplace_back(r * std::cos(a), r * std::sin(a), 0);
  }
  return drilled(prism(blob(points), {0, 0, t}), 0, 0, t, d["bore"]);
}

TopoDS_Shape wave_block(const Dimensions& d) {
  const double length = d["length"];
  const auto top = [&](double x) {
    return Vector3d(x, 0, d["height"] + d["wave"] * std::sin(2 * M_PI * x / length + d["phase"]));
  };
  std::vector<Vector3d> crest;
  constexpr int kPieces = 10;
  for (int i = kPieces - 1; i >= 0; --i) crest.push_back(top(length * i / kPieces));
  const TopoDS_Face face =
      Outline({0, 0, 0}).line({length, 0, 0}).line(top(length)).spline(crest).face();
  return prism(face, {0, d["width"], 0});
}

// From a cushion over a waist to another cushion, turned: its four edges twist.
TopoDS_Shape loft_grip(const Dimensions& d) {
  const double r = d["radius"], length = d["length"], turn = d["turn"];
  const auto section = [&](double z, double half, double angle) {
    const auto at = [&](double radius, int eighth) {
      const double a = angle + eighth * M_PI / 4;
      return Vector3d(radius * std::cos(a), radius * std::sin(a), z);
    };
    const double corner = half * std::sqrt(2.0), side = (1 + d["bulge"] / r) * half;
    Outline outline(at(corner, 0));
    for (int i = 1; i < 8; i += 2) outline.arc(at(side, i), at(corner, i + 1));
    return BRepTools::OuterWire(outline.face());
  };
  BRepOffsetAPI_ThruSections loft(/*isSolid=*/true, /*ruled=*/false);
  loft.AddWire(section(0, d["flare"], 0));
  loft.AddWire(section(length / 2, d["waist"], turn / 2));
  loft.AddWire(section(length, r, turn));
  loft.Build();
  return drilled(loft.Shape(), 0, 0, length, 0.4 * d["waist"]);
}

// A bar along a curve that leaves every plane, upright everywhere.
TopoDS_Shape swept_rail(const Dimensions& d) {
  const Vector3d across(0, d["width"] / 2, 0), up(0, 0, d["height"] / 2);
  BRepOffsetAPI_ThruSections sweep(/*isSolid=*/true, /*ruled=*/false);
  constexpr int kSections = 9;
  for (int i = 0; i < kSections; ++i) {
    const double s = double(i) / (kSections - 1);
    const Vector3d at(d["length"] * s, d["sway"] * std::sin(2 * M_PI * s) / 2, d["rise"] * s * s);
    Outline outline(at - across - up);
    outline.line(at + across - up).line(at + across + up).line(at - across + up);
    sweep.AddWire(BRepTools::OuterWire(outline.face()));
  }
  sweep.Build();
  return sweep.Shape();
}

// A block whose top is a surface through points.
TopoDS_Shape freeform_pad(const Dimensions& d) {
  const double length = d["length"], w = d["width"], h = d["height"];
  constexpr int kPoints = 7;
  TColgp_Array2OfPnt points(1, kPoints, 1, kPoints);
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      const double s = -0.1 + 1.2 * i / (kPoints - 1), t = -0.1 + 1.2 * j / (kPoints - 1);
      const double z = h + d["bulge"] * std::sin(M_PI * s) * std::cos(M_PI * (t - 0.4)) +
                       d["skew"] * (2 * s - 1) * (2 * t - 1);
      points.SetValue(i + 1, j + 1, gp_Pnt(s * length, t * w, z));
    }
  const Handle(Geom_BSplineSurface) top = GeomAPI_PointsToBSplineSurface(points).Surface();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(top, 1e-6).Face();
  return cut(box(Vector3d(length, w, 2 * h)), prism(face, {0, 0, 3 * h}));
}

}  // namespace

const PartMakers& smooth_parts() {
  static const PartMakers parts = {{"cast-bracket", cast_bracket}, {"blend-step", blend_step},
                                   {"cast-flange", cast_flange},   {"taper-block", taper_block},
                                   {"spline-plate", spline_plate}, {"wave-block", wave_block},
                                   {"loft-grip", loft_grip},       {"swept-rail", swept_rail},
                                   {"freeform-pad", freeform_pad}};
  return parts;
}

}  // namespace sketchsplat

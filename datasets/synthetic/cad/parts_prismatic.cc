// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Blocks and whatever is cut out of them; ribs, thin walls and sheet.

namespace sketchsplat {
namespace {

TopoDS_Shape plain_box(const Dimensions& d) { return box(d); }

TopoDS_Shape box_hole(const Dimensions& d) {
  return drilled(box(d), d["place"], d["width"] / 2, d["height"], d["radius"]);
}

// A hole in either leg of an angle of this thickness, at (x, y) and (y, z).
TopoDS_Shape with_hole_in_either_leg(const TopoDS_Shape& angle, double x, double y, double z,
                                     double thickness, double radius) {
  return cut(drilled(angle, x, y, thickness, radius),
             cylinder({-1, y, z}, {thickness + 2, 0, 0}, radius));
}

TopoDS_Shape l_bracket(const Dimensions& d) {
  const double a = d["foot"], b = d["height"], w = d["width"], t = d["thickness"];
  const TopoDS_Shape angle = along_y({{0, 0}, {a, 0}, {a, t}, {t, t}, {t, b}, {0, b}}, w);
  return with_hole_in_either_leg(angle, 0.65 * a, w / 2, 0.65 * b, t, d["radius"]);
}

TopoDS_Shape pocket_block(const Dimensions& d) {
  const double rim = d["rim"];
  const TopoDS_Shape hollow =
      box({rim, rim, d["floor"]}, {d["length"] - 2 * rim, d["width"] - 2 * rim, d["height"]});
  return cut(box(d), fillet(hollow, edges_where(hollow, vertical), d["corner"]));
}

TopoDS_Shape box_fillet(const Dimensions& d) {
  const TopoDS_Shape shape = box(d);
  return fillet(shape, edges_where(shape, vertical), d["radius"]);
}

TopoDS_Shape box_chamfer(const Dimensions& d) {
  const TopoDS_Shape shape = box(d);
  const auto on_top = [&](const Vector3d& a, const Vector3d& b) {
    return std::min(a.z(), b.z()) > 0.5 * d["height"];
  };
  return chamfer(shape, edges_where(shape, on_top), d["chamfer"]);
}

TopoDS_Shape u_channel(const Dimensions& d) {
  const double w = d["width"], h = d["height"], length = d["length"], t = d["thickness"];
  const TopoDS_Shape u = cut(box(d), box({-1, t, t}, {length + 2, w - 2 * t, h}));
  return cut(u, cylinder({length / 3, -1, 0.6 * h}, {0, w + 2, 0}, d["radius"]));
}

// Two parallel ribs on a plate, not reaching its ends.
TopoDS_Shape rib_plate(const Dimensions& d) {
  const double length = d["length"], w = d["width"], base = d["base"];
  const double gap = d["gap"], wall = d["wall"], h = d["rib-height"];
  TopoDS_Shape shape = box(Vector3d(length, w, base));
  for (double y : {w / 2 - gap / 2 - wall, w / 2 + gap / 2})
    shape = fuse(shape, box({0.08 * length, y, base / 2}, {0.84 * length, wall, base / 2 + h}));
  return shape;
}

// A slot with round ends along x.
TopoDS_Shape slot_block(const Dimensions& d) {
  const double length = d["length"], y = d["width"] / 2, r = d["gap"] / 2, depth = d["depth"];
  const double a = 0.2 * length + r, b = 0.8 * length - r;
  return cut(box(d), along_z({{a, y - r},
                              {b, y - r},
                              {b + r, y, kThrough},
                              {b, y + r},
                              {a, y + r},
                              {a - r, y, kThrough}},
                             d["height"] - depth, depth + 1));
}

TopoDS_Shape tray(const Dimensions& d) {
  const double t = d["wall"];
  return cut(box(d), box({t, t, t}, {d["length"] - 2 * t, d["width"] - 2 * t, d["height"]}));
}

// An angle of sheet, bent and not folded, with a hole in either leg.
TopoDS_Shape bent_sheet(const Dimensions& d) {
  const double a = d["length"], leg = d["leg"], w = d["width"], t = d["wall"];
  const double inner = d["bend"], outer = inner + t;
  const double in = outer - inner * std::sqrt(0.5), out = outer - outer * std::sqrt(0.5);
  const TopoDS_Shape sheet = along_y({{outer, 0},
                                      {a, 0},
                                      {a, t},
                                      {outer, t},
                                      {in, in, kThrough},
                                      {t, outer},
                                      {t, leg},
                                      {0, leg},
                                      {0, outer},
                                      {out, out, kThrough}},
                                     w);
  return with_hole_in_either_leg(sheet, 0.7 * a, w / 2, 0.78 * leg, t, 0.07 * a);
}

TopoDS_Shape fillet_block(const Dimensions& d) {
  const TopoDS_Shape shape = box(d);
  const auto long_on_top = [&](const Vector3d& a, const Vector3d& b) {
    return std::min(a.z(), b.z()) > 0.5 * d["height"] &&
           std::abs(a.x() - b.x()) > 0.5 * d["length"];
  };
  return fillet(shape, edges_where(shape, long_on_top), d["fillet"]);
}

// The inner edge of a step is rounded, all others stay.
TopoDS_Shape fillet_step(const Dimensions& d) {
  const double w = d["width"], h = d["height"], step = d["step"], half = w / 2, r = d["fillet"];
  const double s = r * (1 - std::sqrt(0.5));
  return along_x({{0, 0},
                  {w, 0},
                  {w, step},
                  {half + r, step},
                  {half + s, step + s, kThrough},
                  {half, step + r},
                  {half, h},
                  {0, h}},
                 d["length"]);
}

// A roof so flat that its ridge may hardly show.
TopoDS_Shape ridge_block(const Dimensions& d) {
  const double w = d["width"], h = d["height"], rise = w / 2 * std::tan(d["crease"] / 2);
  return along_x({{0, 0}, {w, 0}, {w, h}, {w / 2, h + rise}, {0, h}}, d["length"]);
}

// A row of such roofs.
TopoDS_Shape pleat_block(const Dimensions& d) {
  const double w = d["width"], h = d["height"];
  const int pleats = int(d["pleats"]);
  const double half = w / (2 * pleats), rise = half * std::tan(d["crease"] / 2);
  std::vector<To> places = {{0, 0}, {w, 0}};
  for (int k = 2 * pleats; k >= 0; --k) places.push_back({k * half, h + (k % 2) * rise});
  return along_x(places, d["length"]);
}

TopoDS_Shape oblique_hole(const Dimensions& d) {
  const Vector3d size(d["length"], d["width"], d["height"]);
  const double a = d["tilt"];
  const Vector3d along = 2 * size.norm() * Vector3d(std::sin(a), 0, std::cos(a));
  return cut(box(size), cylinder(size / 2 - along / 2, along, d["radius"]));
}

// A corner cut off by a plane, and a notch across the top.
TopoDS_Shape corner_block(const Dimensions& d) {
  const Vector3d size(d["length"], d["width"], d["height"]);
  const double c = d["corner"], far = 4 * c, depth = d["notch-depth"];
  // What lies beyond the plane through three points at c from the corner.
  const Vector3d base = size - Vector3d(0, 0, c), n = Vector3d::Ones().normalized();
  const Vector3d u = far * Vector3d(1, -1, 0).normalized(), v = n.cross(u);
  const TopoDS_Face lid =
      Outline(base - u - v).line(base + u - v).line(base + u + v).line(base - u + v).face();
  const TopoDS_Shape notch =
      box({0.12 * size.x(), -1, size.z() - depth}, {d["notch"], size.y() + 2, depth + 1});
  return cut(cut(box(size), prism(lid, far * n)), notch);
}

}  // namespace

const PartMakers& prismatic_parts() {
  static const PartMakers parts = {{"box", plain_box},
                                   {"box-hole", box_hole},
                                   {"l-bracket", l_bracket},
                                   {"pocket-block", pocket_block},
                                   {"box-fillet", box_fillet},
                                   {"box-chamfer", box_chamfer},
                                   {"u-channel", u_channel},
                                   {"rib-plate", rib_plate},
                                   {"slot-block", slot_block},
                                   {"tray", tray},
                                   {"bent-sheet", bent_sheet},
                                   {"fillet-block", fillet_block},
                                   {"fillet-step", fillet_step},
                                   {"ridge-block", ridge_block},
                                   {"pleat-block", pleat_block},
                                   {"oblique-hole", oblique_hole},
                                   {"corner-block", corner_block}};
  return parts;
}

}  // namespace sketchsplat

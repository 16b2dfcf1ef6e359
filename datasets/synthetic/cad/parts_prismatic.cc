// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Blocks and whatever is cut out of them.

namespace sketchsplat {
namespace {

Vector3d size_of(const Dimensions& d) { return {d["length"], d["width"], d["height"]}; }

TopoDS_Shape plain_box(const Dimensions& d) { return box(Vector3d::Zero(), size_of(d)); }

TopoDS_Shape box_hole(const Dimensions& d) {
  const Vector3d size = size_of(d);
  const Vector3d base(d["place"] * size.x(), size.y() / 2, -1);
  return cut(plain_box(d), cylinder(base, {0, 0, size.z() + 2}, d["radius"] * size.y()));
}

TopoDS_Shape l_bracket(const Dimensions& d) {
  const double a = d["foot"], b = d["height"], w = d["width"], t = d["thickness"], r = d["radius"];
  const TopoDS_Shape angle =
      prism({{0, 0, 0}, {a, 0, 0}, {a, 0, t}, {t, 0, t}, {t, 0, b}, {0, 0, b}}, Vector3d(0, w, 0));
  const TopoDS_Shape one = cut(angle, cylinder({0.65 * a, w / 2, -1}, {0, 0, t + 2}, r));
  return cut(one, cylinder({-1, w / 2, 0.65 * b}, {t + 2, 0, 0}, r));
}

TopoDS_Shape pocket_block(const Dimensions& d) {
  const Vector3d size = size_of(d);
  const double rim = d["rim"], floor = d["floor"] * size.z();
  TopoDS_Shape hollow = box({rim, rim, floor}, {size.x() - 2 * rim, size.y() - 2 * rim, size.z()});
  hollow = fillet(hollow, edges_where(hollow, vertical), d["corner"]);
  return cut(plain_box(d), hollow);
}

TopoDS_Shape box_fillet(const Dimensions& d) {
  const TopoDS_Shape shape = plain_box(d);
  return fillet(shape, edges_where(shape, vertical), d["radius"]);
}

TopoDS_Shape box_chamfer(const Dimensions& d) {
  const TopoDS_Shape shape = plain_box(d);
  const auto on_top = [&](const Vector3d& a, const Vector3d& b) {
    return std::min(a.z(), b.z()) > 0.5 * d["height"];
  };
  return chamfer(shape, edges_where(shape, on_top), d["chamfer"]);
}

TopoDS_Shape u_channel(const Dimensions& d) {
  const double w = d["width"], h = d["height"], length = d["length"], t = d["thickness"];
  const TopoDS_Shape u =
      cut(box(Vector3d::Zero(), {length, w, h}), box({-1, t, t}, {length + 2, w - 2 * t, h}));
  return cut(u, cylinder({length / 3, -1, 0.6 * h}, {0, w + 2, 0}, d["radius"]));
}

// A slot with round ends, from a to b along x.
TopoDS_Shape round_slot(const Vector3d& a, const Vector3d& b, double r, double height) {
  const Vector3d side(0, r, 0), out(r, 0, 0);
  const TopoDS_Face face = Outline(a - side)
                               .line(b - side)
                               .arc(b + out, b + side)
                               .line(a + side)
                               .arc(a - out, a - side)
                               .face();
  return prism(face, Vector3d(0, 0, height));
}

TopoDS_Shape slot_block(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const double r = d["gap"] * length / 2, depth = d["depth"] * h;
  const Vector3d a(0.2 * length + r, w / 2, h - depth), b(0.8 * length - r, w / 2, h - depth);
  return cut(box(Vector3d::Zero(), {length, w, h}), round_slot(a, b, r, depth + 1));
}

TopoDS_Shape fillet_block(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const TopoDS_Shape shape = box(Vector3d::Zero(), {length, w, h});
  const auto long_on_top = [&](const Vector3d& a, const Vector3d& b) {
    return std::min(a.z(), b.z()) > 0.5 * h && std::abs(a.x() - b.x()) > 0.5 * length;
  };
  return fillet(shape, edges_where(shape, long_on_top), d["fillet"] * length);
}

// The inner edge of a step is rounded, all others stay.
TopoDS_Shape fillet_step(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const double step = d["step"] * h, half = w / 2, r = d["fillet"] * length;
  const double s = r * std::sqrt(0.5);
  const Vector3d centre(0, half + r, step + r);
  const TopoDS_Face face = Outline({0, 0, 0})
                               .line({0, w, 0})
                               .line({0, w, step})
                               .line({0, half + r, step})
                               .arc(centre - Vector3d(0, s, s), {0, half, step + r})
                               .line({0, half, h})
                               .line({0, 0, h})
                               .face();
  return prism(face, Vector3d(length, 0, 0));
}

// A roof so flat that its ridge may hardly show.
TopoDS_Shape ridge_block(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const double rise = w / 2 * std::tan(d["crease"] * M_PI / 360);
  return prism({{0, 0, 0}, {0, w, 0}, {0, w, h}, {0, w / 2, h + rise}, {0, 0, h}},
               Vector3d(length, 0, 0));
}

// A row of such roofs.
TopoDS_Shape pleat_block(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const int pleats = int(d["pleats"]);
  const double half = w / (2 * pleats), rise = half * std::tan(d["crease"] * M_PI / 360);
  std::vector<Vector3d> profile = {{0, 0, 0}, {0, w, 0}};
  for (int k = 2 * pleats; k >= 0; --k) profile.push_back({0, k * half, h + (k % 2) * rise});
  return prism(profile, Vector3d(length, 0, 0));
}

TopoDS_Shape oblique_hole(const Dimensions& d) {
  const Vector3d size = size_of(d);
  const double a = d["tilt"] * M_PI / 180;
  const Vector3d along = 2 * size.norm() * Vector3d(std::sin(a), 0, std::cos(a));
  return cut(plain_box(d), cylinder(size / 2 - along / 2, along, d["radius"] * size.y()));
}

// A corner cut off by a plane, and a notch across the top.
TopoDS_Shape corner_block(const Dimensions& d) {
  const Vector3d size = size_of(d);
  const double c = d["corner"] * size.z();
  // What lies beyond the plane through three points at c from the corner.
  const Vector3d base = size - Vector3d(0, 0, c);
  const double far = 4 * c;
  const Vector3d n = Vector3d::Ones().normalized();
  const Vector3d u = Vector3d(1, -1, 0).normalized(), v = n.cross(u);
  const TopoDS_Shape lid = prism({base - far * u - far * v, base + far * u - far * v,
                                  base + far * u + far * v, base - far * u + far * v},
                                 far * n);
  const double depth = d["notch-depth"] * size.z();
  const TopoDS_Shape notch = box({0.12 * size.x(), -1, size.z() - depth},
                                 {d["notch"] * size.x(), size.y() + 2, depth + 1});
  return cut(cut(plain_box(d), lid), notch);
}

}  // namespace

const std::vector<PartMaker>& prismatic_parts() {
  static const std::vector<PartMaker> parts = {
      {"box", plain_box},
      {"box-hole", box_hole},
      {"l-bracket", l_bracket},
      {"pocket-block", pocket_block},
      {"box-fillet", box_fillet},
      {"box-chamfer", box_chamfer},
      {"u-channel", u_channel},
      {"slot-block", slot_block},
      {"fillet-block", fillet_block},
      {"fillet-step", fillet_step},
      {"ridge-block", ridge_block},
      {"pleat-block", pleat_block},
      {"oblique-hole", oblique_hole},
      {"corner-block", corner_block},
  };
  return parts;
}

}  // namespace sketchsplat

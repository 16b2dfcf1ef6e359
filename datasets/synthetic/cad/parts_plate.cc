// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Plates with holes, bosses and slots.

namespace sketchsplat {
namespace {

Vector3d polar(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

TopoDS_Shape plate_holes(const Dimensions& d) {
  const Vector3d size(d["length"], d["width"], d["thickness"]);
  const double inset = d["inset"];
  TopoDS_Shape shape = box(Vector3d::Zero(), size);
  const Vector3d through(0, 0, size.z() + 2);
  double shift = d["hole-shift"] * size.x();  // of the first hole
  for (double x : {inset, size.x() - inset})
    for (double y : {inset, size.y() - inset}) {
      shape = cut(shape, cylinder({x + 0.6 * shift, y + 0.8 * shift, -1}, through, d["radius"]));
      shift = 0;
    }
  const double bore = d["bore"] * (1 + d["bore-error"] / 100);
  return cut(shape, cylinder({size.x() / 2, size.y() / 2, -1}, through, bore));
}

TopoDS_Shape slotted_sheet(const Dimensions& d) {
  const double a = d["length"], b = d["width"], t = d["thickness"], r = d["radius"];
  const int slots = int(d["slots"]);
  const double length = d["slot-length"] * b;
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

TopoDS_Shape dome_plate(const Dimensions& d) {
  const Vector3d size(d["length"], d["width"], d["thickness"]);
  const double r = d["radius"], sink = d["sink"] * r;
  const TopoDS_Shape dome = ball({size.x() / 2, size.y() / 2, size.z() - sink}, r);
  const TopoDS_Shape above = box({-100, -100, size.z() / 2}, {300, 300, 100});
  return fuse(box(Vector3d::Zero(), size), common(dome, above));
}

// A countersink, a blind hole and a counterbore in a row.
TopoDS_Shape countersunk_plate(const Dimensions& d) {
  const double length = d["length"], y = d["width"] / 2, t = d["thickness"];
  const double r = d["radius"], sink = d["sink"], depth = d["blind-depth"] * t;
  const Vector3d through(0, 0, t + 2);
  TopoDS_Shape shape = box(Vector3d::Zero(), {length, d["width"], t});
  shape = cut(shape, cylinder({0.18 * length, y, -1}, through, r));
  shape = cut(shape, cone({0.18 * length, y, t - sink}, {0, 0, sink + 1}, r, r + sink + 1));
  shape = cut(shape, cylinder({0.5 * length, y, t - depth}, {0, 0, depth + 1}, d["blind-radius"]));
  shape = cut(shape, cylinder({0.82 * length, y, -1}, through, r));
  return cut(shape, cylinder({0.82 * length, y, 0.6 * t}, {0, 0, t}, r + sink));
}

// Half an ellipse as its end, and an elliptical hole.
TopoDS_Shape ellipse_plate(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, t = d["thickness"] * length;
  const double straight = 0.75 * length, turn = d["turn"] * M_PI / 180;
  const Vector3d middle(straight, w / 2, 0);
  // The longer half-axis comes first, and it is the one across.
  const TopoDS_Face face =
      Outline({0, 0, 0})
          .line({straight, 0, 0})
          .ellipse(middle, Vector3d(0, w / 2, 0), Vector3d(-0.25 * length, 0, 0), -M_PI, 0)
          .line({0, w, 0})
          .face();
  const double a = d["long-axis"] * w, b = d["short-axis"] * a;
  const Vector3d u = polar(a, turn, 0), v = polar(b, turn + M_PI / 2, 0);
  const Vector3d centre(0.4 * length, w / 2, -1);
  const TopoDS_Face hole = Outline(centre + u).ellipse(centre, u, v, 0, 2 * M_PI).face();
  return cut(prism(face, Vector3d(0, 0, t)), prism(hole, Vector3d(0, 0, t + 2)));
}

// A drafted boss with a blind hole, held by two ribs.
TopoDS_Shape boss_plate(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, t = d["thickness"];
  const double h = d["boss-height"], r = d["boss"] * w, half = d["rib"] / 2;
  const double top = r - h * std::tan(d["draft"] * M_PI / 180);
  const Vector3d foot(length / 2, w / 2, t);
  TopoDS_Shape shape = fuse(box(Vector3d::Zero(), {length, w, t}), cone(foot, {0, 0, h}, r, top));
  for (double side : {-1.0, 1.0}) {
    const Vector3d a = foot - Vector3d(0, half, 0);
    const TopoDS_Shape rib =
        prism({a, a + Vector3d(side * 0.42 * length, 0, 0), a + Vector3d(0, 0, 0.8 * h)},
              Vector3d(0, 2 * half, 0));
    shape = fuse(shape, rib);
  }
  return cut(shape, cylinder(foot + Vector3d(0, 0, 0.3 * h), {0, 0, h}, d["hole"] * top));
}

// A slot along a circle about z, with round ends.
TopoDS_Shape bent_slot(double pitch, double r, double from, double to, double height) {
  const double mid = (from + to) / 2, z = -1;
  const auto end = [&](double angle, double ahead) -> Vector3d {
    return polar(pitch, angle, z) + ahead * polar(r, angle + M_PI / 2, 0);
  };
  const TopoDS_Face face = Outline(polar(pitch + r, from, z))
                               .arc(polar(pitch + r, mid, z), polar(pitch + r, to, z))
                               .arc(end(to, 1), polar(pitch - r, to, z))
                               .arc(polar(pitch - r, mid, z), polar(pitch - r, from, z))
                               .arc(end(from, -1), polar(pitch + r, from, z))
                               .face();
  return prism(face, Vector3d(0, 0, height));
}

TopoDS_Shape slot_disc(const Dimensions& d) {
  const double r = d["radius"], t = d["thickness"] * r;
  const int slots = int(d["slots"]);
  const double step = 2 * M_PI / slots, sweep = d["sweep"] * step;
  TopoDS_Shape shape = cut(cylinder(Vector3d::Zero(), {0, 0, t}, r),
                           cylinder({0, 0, -1}, {0, 0, t + 2}, d["bore"] * r));
  for (int i = 0; i < slots; ++i)
    shape = cut(shape,
                bent_slot(d["pitch"] * r, d["slot-radius"] * r, i * step, i * step + sweep, t + 2));
  return shape;
}

}  // namespace

const std::vector<PartMaker>& plate_parts() {
  static const std::vector<PartMaker> parts = {
      {"plate-holes", plate_holes},     {"slotted-sheet", slotted_sheet},
      {"dome-plate", dome_plate},       {"countersunk-plate", countersunk_plate},
      {"ellipse-plate", ellipse_plate}, {"boss-plate", boss_plate},
      {"slot-disc", slot_disc},
  };
  return parts;
}

}  // namespace sketchsplat

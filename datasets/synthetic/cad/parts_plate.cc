// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Plates with holes, bosses and slots.

namespace sketchsplat {
namespace {

TopoDS_Shape plate(const Dimensions& d) {
  return box(Vector3d(d["length"], d["width"], d["thickness"]));
}

TopoDS_Shape plate_holes(const Dimensions& d) {
  const double length = d["length"], w = d["width"], t = d["thickness"], inset = d["inset"];
  TopoDS_Shape shape = plate(d);
  double shift = d["hole-shift"];  // of the first hole
  for (double x : {inset, length - inset})
    for (double y : {inset, w - inset}) {
      shape = drilled(shape, x + 0.6 * shift, y + 0.8 * shift, t, d["radius"]);
      shift = 0;
    }
  return drilled(shape, length / 2, w / 2, t, d["bore"] * (1 + d["bore-error"] / 100));
}

TopoDS_Shape slotted_sheet(const Dimensions& d) {
  const double t = d["thickness"], r = d["radius"], length = d["slot-length"];
  const int slots = int(d["slots"]);
  TopoDS_Shape shape = plate(d);
  for (int i = 0; i < slots; ++i) {
    const double x = d["length"] * (i + 1) / (slots + 1), y = (d["width"] - length) / 2;
    TopoDS_Shape slot = box({x - r, y, -1}, {2 * r, length, t + 2});
    for (double end : {y, y + length}) slot = fuse(slot, cylinder({x, end, -1}, {0, 0, t + 2}, r));
    shape = cut(shape, slot);
  }
  return shape;
}

TopoDS_Shape dome_plate(const Dimensions& d) {
  const double t = d["thickness"];
  const TopoDS_Shape dome = ball({d["length"] / 2, d["width"] / 2, t - d["sink"]}, d["radius"]);
  return fuse(plate(d), common(dome, box({-100, -100, t / 2}, {300, 300, 100})));
}

// A countersink, a blind hole and a counterbore in a row.
TopoDS_Shape countersunk_plate(const Dimensions& d) {
  const double length = d["length"], y = d["width"] / 2, t = d["thickness"];
  const double r = d["radius"], sink = d["sink"], depth = d["blind-depth"];
  TopoDS_Shape shape = drilled(plate(d), 0.18 * length, y, t, r);
  shape = cut(shape, cone({0.18 * length, y, t - sink}, {0, 0, sink + 1}, r, r + sink + 1));
  shape = cut(shape, cylinder({0.5 * length, y, t - depth}, {0, 0, depth + 1}, d["blind-radius"]));
  shape = drilled(shape, 0.82 * length, y, t, r);
  return cut(shape, cylinder({0.82 * length, y, 0.6 * t}, {0, 0, t}, r + sink));
}

// Half an ellipse as its end, and an elliptical hole.
TopoDS_Shape ellipse_plate(const Dimensions& d) {
  const double length = d["length"], w = d["width"], t = d["thickness"], turn = d["turn"];
  const double straight = 0.75 * length, a = d["long-axis"], b = d["short-axis"];
  // The longer half-axis comes first, and it is the one across.
  const TopoDS_Face face = Outline({0, 0, 0})
                               .line({straight, 0, 0})
                               .ellipse({straight, w / 2, 0}, Vector3d(0, w / 2, 0),
                                        Vector3d(-0.25 * length, 0, 0), -M_PI, 0)
                               .line({0, w, 0})
                               .face();
  const Vector3d u(a * std::cos(turn), a * std::sin(turn), 0),
      v(-b * std::sin(turn), b * std::cos(turn), 0), centre(0.4 * length, w / 2, -1);
  const TopoDS_Face hole = Outline(centre + u).ellipse(centre, u, v, 0, 2 * M_PI).face();
  return cut(prism(face, {0, 0, t}), prism(hole, {0, 0, t + 2}));
}

// A drafted boss with a blind hole, held by two ribs.
TopoDS_Shape boss_plate(const Dimensions& d) {
  const double length = d["length"], h = d["boss-height"], r = d["boss"], half = d["rib"] / 2;
  const double top = r - h * std::tan(d["draft"]);
  const Vector3d foot(length / 2, d["width"] / 2, d["thickness"]), a = foot - Vector3d(0, half, 0);
  TopoDS_Shape shape = fuse(plate(d), cone(foot, {0, 0, h}, r, top));
  for (double side : {-1.0, 1.0}) {
    const TopoDS_Face rib = Outline(a)
                                .line(a + Vector3d(side * 0.42 * length, 0, 0))
                                .line(a + Vector3d(0, 0, 0.8 * h))
                                .face();
    shape = fuse(shape, prism(rib, {0, 2 * half, 0}));
  }
  // "of boss" is of its top here.
  return cut(shape, cylinder(foot + Vector3d(0, 0, 0.3 * h), {0, 0, h}, d["hole"] / r * top));
}

// Slots along a circle about z, with round ends.
TopoDS_Shape slot_disc(const Dimensions& d) {
  const double r = d["radius"], t = d["thickness"], pitch = d["pitch"], s = d["slot-radius"];
  const int slots = int(d["slots"]);
  TopoDS_Shape shape = drilled(cylinder(Vector3d::Zero(), {0, 0, t}, r), 0, 0, t, d["bore"]);
  for (int i = 0; i < slots; ++i) {
    const double from = 2 * M_PI * i / slots, to = from + d["sweep"] * 2 * M_PI / slots;
    const auto at = [&](double radius, double angle, double ahead, bool through) -> To {
      return {radius * std::cos(angle) - ahead * std::sin(angle),
              radius * std::sin(angle) + ahead * std::cos(angle), through};
    };
    const double mid = (from + to) / 2;
    const TopoDS_Shape slot = along_z(
        {at(pitch + s, from, 0, false), at(pitch + s, mid, 0, true), at(pitch + s, to, 0, false),
         at(pitch, to, s, true), at(pitch - s, to, 0, false), at(pitch - s, mid, 0, true),
         at(pitch - s, from, 0, false), at(pitch, from, -s, true)},
        -1, t + 2);
    shape = cut(shape, slot);
  }
  return shape;
}

}  // namespace

const PartMakers& plate_parts() {
  static const PartMakers parts = {
      {"plate-holes", plate_holes},     {"slotted-sheet", slotted_sheet},
      {"dome-plate", dome_plate},       {"countersunk-plate", countersunk_plate},
      {"ellipse-plate", ellipse_plate}, {"boss-plate", boss_plate},
      {"slot-disc", slot_disc}};
  return parts;
}

}  // namespace sketchsplat

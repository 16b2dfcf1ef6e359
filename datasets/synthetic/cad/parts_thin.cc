// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Ribs, thin walls and sheet.

namespace sketchsplat {
namespace {

// Two parallel ribs on a plate, not reaching its ends.
TopoDS_Shape rib_plate(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, base = d["base"] * length;
  const double gap = d["gap"] * length, wall = d["wall"] * length, h = d["rib-height"] * length;
  TopoDS_Shape shape = box(Vector3d::Zero(), {length, w, base});
  for (double y : {w / 2 - gap / 2 - wall, w / 2 + gap / 2})
    shape = fuse(shape, box({0.08 * length, y, base / 2}, {0.84 * length, wall, base / 2 + h}));
  return shape;
}

TopoDS_Shape tray(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const double t = d["wall"] * length;
  return cut(box(Vector3d::Zero(), {length, w, h}), box({t, t, t}, {length - 2 * t, w - 2 * t, h}));
}

// An angle of sheet, bent and not folded, with a hole in either leg.
TopoDS_Shape bent_sheet(const Dimensions& d) {
  const double length = d["length"], leg = d["leg"] * length, w = d["width"] * length;
  const double t = d["wall"] * length, inner = d["bend"] * length, outer = inner + t;
  const auto on_bend = [&](double radius) {
    const double s = outer - radius * std::sqrt(0.5);
    return Vector3d(s, 0, s);
  };
  const TopoDS_Face face = Outline({outer, 0, 0})
                               .line({length, 0, 0})
                               .line({length, 0, t})
                               .line({outer, 0, t})
                               .arc(on_bend(inner), {t, 0, outer})
                               .line({t, 0, leg})
                               .line({0, 0, leg})
                               .line({0, 0, outer})
                               .arc(on_bend(outer), {outer, 0, 0})
                               .face();
  const double r = 0.07 * length;
  const TopoDS_Shape sheet =
      cut(prism(face, Vector3d(0, w, 0)), cylinder({0.7 * length, w / 2, -1}, {0, 0, t + 2}, r));
  return cut(sheet, cylinder({-1, w / 2, 0.78 * leg}, {t + 2, 0, 0}, r));
}

}  // namespace

const std::vector<PartMaker>& thin_parts() {
  static const std::vector<PartMaker> parts = {
      {"rib-plate", rib_plate}, {"tray", tray}, {"bent-sheet", bent_sheet}};
  return parts;
}

}  // namespace sketchsplat

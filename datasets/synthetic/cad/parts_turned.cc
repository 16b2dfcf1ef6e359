// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Parts from the lathe, and pipes.

namespace sketchsplat {
namespace {

TopoDS_Shape stepped_shaft(const Dimensions& d) {
  TopoDS_Shape shape;
  double z = 0;
  for (const auto& [radius, length] : {std::pair{d["radius"], d["first-length"]},
                                       {d["second-radius"], d["second-length"]},
                                       {d["third-radius"], d["third-length"]},
                                       {0.6 * d["radius"], d["fourth-length"]}}) {
    const TopoDS_Shape step = cylinder({0, 0, z}, {0, 0, length}, radius);
    shape = shape.IsNull() ? step : fuse(shape, step);
    z += length;
  }
  return shape;
}

// What lies above the slanted line from (x0, z0) to (x1, z1), wide and high enough for all.
TopoDS_Shape wedge(double x0, double z0, double x1, double z1, double high, double wide) {
  const TopoDS_Face face = Outline({x0, -wide, z0})
                               .line({x1, -wide, z1})
                               .line({x1, -wide, high})
                               .line({x0, -wide, high})
                               .face();
  return prism(face, {0, 2 * wide, 0});
}

TopoDS_Shape cut_cylinder(const Dimensions& d) {
  const double r = d["radius"], h = d["height"], rise = d["rise"], big = 3 * r;
  // The slanted face passes through (-r, h - rise) and (r, h).
  const double slope = rise / (2 * r), right = h + slope * (big - r);
  return cut(cylinder(Vector3d::Zero(), {0, 0, h + 5}, r),
             wedge(-big, h - rise + slope * (r - big), big, right, right + big, big));
}

// Two slanted planes that meet in a ridge: two arcs of ellipses.
TopoDS_Shape ridge_cylinder(const Dimensions& d) {
  const double r = d["radius"], h = d["height"], big = 3 * r, x = d["ridge"];
  TopoDS_Shape shape = cylinder(Vector3d::Zero(), {0, 0, h + r}, r);
  for (int side : {-1, 1}) {
    const double slope = d[side < 0 ? "left-rise" : "right-rise"] / r, end = side * big;
    shape = cut(shape, wedge(x, h, end, h - slope * std::abs(end - x), h + 2 * big, big));
  }
  return shape;
}

TopoDS_Shape frustum(const Dimensions& d) {
  return cone(Vector3d::Zero(), {0, 0, d["height"]}, d["radius"], d["top"]);
}

TopoDS_Shape hex_nut(const Dimensions& d) {
  const double across = d["across"], h = d["height"], corner = across / std::sqrt(3.0);
  std::vector<To> hexagon;
  for (int i = 0; i < 6; ++i)
    hexagon.push_back({corner * std::cos(i * M_PI / 3), corner * std::sin(i * M_PI / 3)});
  TopoDS_Shape nut = along_z(hexagon, 0, h);
  // 30 degree chamfers take the corners away and leave hyperbolas on the six flats.
  const double slope = std::tan(M_PI / 6), flat = 0.475 * across;
  const double wide = 2 * across, rise = (wide - flat) * slope;
  nut = common(nut, cone({0, 0, h - rise}, {0, 0, rise}, wide, flat));
  nut = common(nut, cone({0, 0, 0}, {0, 0, rise}, flat, wide));
  return drilled(nut, 0, 0, h, d["bore"]);
}

TopoDS_Shape flange(const Dimensions& d) {
  const double r = d["radius"], t = d["thickness"], h = d["hub-height"];
  const TopoDS_Shape shape = fuse(cylinder(Vector3d::Zero(), {0, 0, t}, r),
                                  cylinder(Vector3d::Zero(), {0, 0, t + h}, d["hub"]));
  return drilled_around(drilled(shape, 0, 0, t + h, d["bore"]), int(d["holes"]), 0.72 * r, t,
                        d["hole"]);
}

TopoDS_Shape tee(const Dimensions& d) {
  const double length = d["length"];
  return fuse(cylinder({-length / 2, 0, 0}, {length, 0, 0}, d["radius"]),
              cylinder(Vector3d::Zero(), {0, 0, d["rise"]}, d["branch"]));
}

// A flat ring, a slope and a flat top: both circles turn the surface by the same angle.
TopoDS_Shape crease_disc(const Dimensions& d) {
  const double r = d["radius"], t = d["thickness"], ring = d["ring"], slant = d["slant"];
  const double in = ring - slant * std::cos(d["crease"]), top = t + slant * std::sin(d["crease"]);
  return lathed({{0, 0}, {r, 0}, {r, t}, {ring, t}, {in, top}, {0, top}});
}

TopoDS_Shape knob(const Dimensions& d) {
  const double r = d["radius"], h = d["height"], c = d["chamfer"], in = d["bore"];
  const int scallops = int(d["scallops"]);
  TopoDS_Shape shape = lathed({{in, 0}, {r, 0}, {r, h - c}, {r - c, h}, {in, h}});
  // The first one takes the seam of the outside away, and their own seams stay outside.
  const TopoDS_Shape scallop = cylinder({r, 0, -1}, {0, 0, h + 2}, d["scallop"]);
  for (int i = 0; i < scallops; ++i) shape = cut(shape, turned(scallop, 2 * M_PI * i / scallops));
  return shape;
}

TopoDS_Shape keyed_hub(const Dimensions& d) {
  const double r = d["radius"], h = d["length"], c = d["chamfer"], in = d["bore"];
  const TopoDS_Shape hub = lathed({{in, 0}, {r - c, 0}, {r, c}, {r, h - c}, {r - c, h}, {in, h}});
  const double wide = d["key-width"];
  return cut(hub, box({0, -wide / 2, -1}, {in + d["key-depth"], wide, h + 2}));
}

// A quarter of a torus between two straight pipes.
TopoDS_Shape bent_rod(double ring, double length, double radius) {
  const TopoDS_Shape one =
      fuse(quarter_torus(ring, radius), cylinder({ring, 0, 0}, {0, -length, 0}, radius));
  return fuse(one, cylinder({0, ring, 0}, {-length, 0, 0}, radius));
}
TopoDS_Shape elbow(const Dimensions& d) {
  const double r = d["radius"], ring = d["bend"], straight = d["straight"];
  const TopoDS_Shape collar =
      cylinder({ring, 0.5 * r - straight, 0}, {0, -0.5 * r, 0}, d["collar"]);
  return cut(fuse(bent_rod(ring, straight, r), collar), bent_rod(ring, straight + 1, d["bore"]));
}

// A groove for a ring of wire: half a torus.
TopoDS_Shape groove_shaft(const Dimensions& d) {
  const double r = d["radius"], h = d["length"], g = d["groove"], z = d["place"], c = d["chamfer"];
  return lathed({{0, 0},
                 {r, 0},
                 {r, z - g},
                 {r - g, z, kThrough},
                 {r, z + g},
                 {r, h - c},
                 {r - c, h},
                 {0, h}});
}

TopoDS_Shape ball_stud(const Dimensions& d) {
  const double r = d["radius"], b = d["ball"], collar = d["collar"], top = d["flat"];
  const double neck = 0.5 * r + d["stem"], centre = neck + std::sqrt(b * b - r * r);
  return lathed({{0, 0},
                 {collar, 0},
                 {collar, 0.5 * r},
                 {r, 0.5 * r},
                 {r, neck},
                 {b, centre, kThrough},
                 {std::sqrt(b * b - top * top), centre + top},
                 {0, centre + top}});
}

// A hemispherical shell with a rim and a port.
TopoDS_Shape dished_cap(const Dimensions& d) {
  const double r = d["radius"], in = r - d["thickness"], rim = d["rim"], port = d["port"];
  const double h = d["rim-height"];
  const auto on = [](double radius, double x, bool through = false) -> To {
    return {x, std::sqrt(radius * radius - x * x), through};
  };
  return lathed({{in, 0},
                 {rim, 0},
                 {rim, h},
                 {std::sqrt(r * r - h * h), h},
                 on(r, 0.7 * r, kThrough),
                 on(r, port),
                 on(in, port),
                 on(in, 0.7 * in, kThrough)});
}

// A pin with a round head, drilled across (saddle curves) and from below (blind).
TopoDS_Shape cross_drilled(const Dimensions& d) {
  const double r = d["radius"], h = d["length"], s = r * std::sqrt(0.5);
  const TopoDS_Shape pin = lathed({{0, 0}, {r, 0}, {r, h}, {s, h + s, kThrough}, {0, h + r}});
  const TopoDS_Shape bored =
      cut(pin, cylinder({0, 0, -1}, {0, 0, d["blind-depth"] + 1}, d["blind-bore"]));
  return cut(bored, cylinder({0, -2 * r, 0.6 * h}, {0, 4 * r, 0}, d["drill"]));
}

}  // namespace

const PartMakers& turned_parts() {
  static const PartMakers parts = {{"stepped-shaft", stepped_shaft},
                                   {"cut-cylinder", cut_cylinder},
                                   {"ridge-cylinder", ridge_cylinder},
                                   {"frustum", frustum},
                                   {"hex-nut", hex_nut},
                                   {"flange", flange},
                                   {"tee", tee},
                                   {"crease-disc", crease_disc},
                                   {"knob", knob},
                                   {"keyed-hub", keyed_hub},
                                   {"elbow", elbow},
                                   {"groove-shaft", groove_shaft},
                                   {"ball-stud", ball_stud},
                                   {"dished-cap", dished_cap},
                                   {"cross-drilled", cross_drilled}};
  return parts;
}

}  // namespace sketchsplat

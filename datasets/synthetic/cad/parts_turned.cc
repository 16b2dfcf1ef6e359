// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Parts from the lathe, and pipes.

namespace sketchsplat {
namespace {

TopoDS_Shape stepped_shaft(const Dimensions& d) {
  const double r = d["radius"];
  const std::pair<double, double> steps[] = {{r, d["first-length"]},
                                             {r * d["second-radius"], d["second-length"]},
                                             {r * d["third-radius"], d["third-length"]},
                                             {0.6 * r, d["fourth-length"]}};
  TopoDS_Shape shape;
  double z = 0;
  for (const auto& [radius, length] : steps) {
    const TopoDS_Shape step = cylinder({0, 0, z}, {0, 0, length}, radius);
    shape = shape.IsNull() ? step : fuse(shape, step);
    z += length;
  }
  return shape;
}

TopoDS_Shape cut_cylinder(const Dimensions& d) {
  const double r = d["radius"], h = d["height"], rise = d["rise"] * 2 * r;
  const double low = h - rise, big = 3 * r;
  // A wedge whose slanted face passes through (-r, low) and (r, h).
  const double slope = rise / (2 * r), left = low + slope * (r - big),
               right = h + slope * (big - r);
  const TopoDS_Shape wedge = prism(
      {{-big, -big, left}, {big, -big, right}, {big, -big, right + big}, {-big, -big, right + big}},
      Vector3d(0, 2 * big, 0));
  return cut(cylinder(Vector3d::Zero(), {0, 0, h + 5}, r), wedge);
}

// Two slanted planes that meet in a ridge: two arcs of ellipses.
TopoDS_Shape ridge_cylinder(const Dimensions& d) {
  const double r = d["radius"], h = d["height"] * r, big = 3 * r, x = d["ridge"] * r;
  TopoDS_Shape shape = cylinder(Vector3d::Zero(), {0, 0, h + r}, r);
  for (int side : {-1, 1}) {
    const double slope = d[side < 0 ? "left-rise" : "right-rise"], end = side * big;
    const Vector3d ridge(x, -big, h), foot(end, -big, h - slope * std::abs(end - x));
    const Vector3d up(0, 0, 2 * big);
    shape = cut(shape, prism({ridge, foot, foot + up, ridge + up}, Vector3d(0, 2 * big, 0)));
  }
  return shape;
}

TopoDS_Shape frustum(const Dimensions& d) {
  return cone(Vector3d::Zero(), {0, 0, d["height"]}, d["radius"], d["top"] * d["radius"]);
}

TopoDS_Shape hex_nut(const Dimensions& d) {
  const double across = d["across"], h = d["height"] * across;
  const double corner = across / std::sqrt(3.0), bore = d["bore"] * across;
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

TopoDS_Shape flange(const Dimensions& d) {
  const double r = d["radius"], t = d["thickness"], hub = d["hub"] * r, h = d["hub-height"];
  const int count = int(d["holes"]);
  TopoDS_Shape shape = fuse(cylinder(Vector3d::Zero(), {0, 0, t}, r),
                            cylinder(Vector3d::Zero(), {0, 0, t + h}, hub));
  shape = cut(shape, cylinder({0, 0, -1}, {0, 0, t + h + 2}, d["bore"] * hub));
  for (int i = 0; i < count; ++i) {
    const double a = 2 * M_PI * i / count, at = 0.72 * r;
    shape =
        cut(shape, cylinder({at * std::cos(a), at * std::sin(a), -1}, {0, 0, t + 2}, d["hole"]));
  }
  return shape;
}

TopoDS_Shape tee(const Dimensions& d) {
  const double r = d["radius"], length = d["length"];
  return fuse(cylinder({-length / 2, 0, 0}, {length, 0, 0}, r),
              cylinder(Vector3d::Zero(), {0, 0, d["rise"] * r}, d["branch"] * r));
}

// A flat ring, a slope and a flat top: both circles turn the surface by the same angle.
TopoDS_Shape crease_disc(const Dimensions& d) {
  const double r = d["radius"], t = d["thickness"] * r, ring = d["ring"] * r;
  const double slant = d["slant"] * r, a = d["crease"] * M_PI / 180;
  const double top = t + slant * std::sin(a);
  return revolve(Outline({0, 0, 0})
                     .line({r, 0, 0})
                     .line({r, 0, t})
                     .line({ring, 0, t})
                     .line({ring - slant * std::cos(a), 0, top})
                     .line({0, 0, top})
                     .face());
}

TopoDS_Shape knob(const Dimensions& d) {
  const double r = d["radius"], h = d["height"] * r, c = d["chamfer"] * r, in = d["bore"] * r;
  const int scallops = int(d["scallops"]);
  TopoDS_Shape shape = revolve(Outline({in, 0, 0})
                                   .line({r, 0, 0})
                                   .line({r, 0, h - c})
                                   .line({r - c, 0, h})
                                   .line({in, 0, h})
                                   .face());
  // The first one takes the seam of the outside away, and their own seams stay outside.
  const TopoDS_Shape scallop = cylinder({r, 0, -1}, {0, 0, h + 2}, d["scallop"] * r);
  for (int i = 0; i < scallops; ++i) shape = cut(shape, turned(scallop, 2 * M_PI * i / scallops));
  return shape;
}

TopoDS_Shape keyed_hub(const Dimensions& d) {
  const double r = d["radius"], h = d["length"] * r, c = d["chamfer"] * r, in = d["bore"] * r;
  const TopoDS_Shape hub = revolve(Outline({in, 0, 0})
                                       .line({r - c, 0, 0})
                                       .line({r, 0, c})
                                       .line({r, 0, h - c})
                                       .line({r - c, 0, h})
                                       .line({in, 0, h})
                                       .face());
  const double half = d["key-width"] * in / 2;
  return cut(hub, box({0, -half, -1}, {(1 + d["key-depth"]) * in, 2 * half, h + 2}));
}

// A quarter of a torus between two straight pipes.
TopoDS_Shape bent_rod(double ring, double straight, double radius, double beyond) {
  const double length = straight + beyond;
  const TopoDS_Shape one =
      fuse(quarter_torus(ring, radius), cylinder({ring, 0, 0}, {0, -length, 0}, radius));
  return fuse(one, cylinder({0, ring, 0}, {-length, 0, 0}, radius));
}
TopoDS_Shape elbow(const Dimensions& d) {
  const double r = d["radius"], ring = d["bend"] * r, straight = d["straight"] * r;
  const TopoDS_Shape collar =
      cylinder({ring, 0.5 * r - straight, 0}, {0, -0.5 * r, 0}, d["collar"] * r);
  return cut(fuse(bent_rod(ring, straight, r, 0), collar),
             bent_rod(ring, straight, d["bore"] * r, 1));
}

// A groove for a ring of wire: half a torus.
TopoDS_Shape groove_shaft(const Dimensions& d) {
  const double r = d["radius"], length = d["length"] * r, g = d["groove"] * r;
  const double z = d["place"] * length, c = d["chamfer"] * r;
  return revolve(Outline({0, 0, 0})
                     .line({r, 0, 0})
                     .line({r, 0, z - g})
                     .arc({r - g, 0, z}, {r, 0, z + g})
                     .line({r, 0, length - c})
                     .line({r - c, 0, length})
                     .line({0, 0, length})
                     .face());
}

TopoDS_Shape ball_stud(const Dimensions& d) {
  const double r = d["radius"], b = d["ball"] * r, collar = d["collar"] * r;
  const double neck = (0.5 + d["stem"]) * r, centre = neck + std::sqrt(b * b - r * r);
  const double top = d["flat"] * b;
  return revolve(Outline({0, 0, 0})
                     .line({collar, 0, 0})
                     .line({collar, 0, 0.5 * r})
                     .line({r, 0, 0.5 * r})
                     .line({r, 0, neck})
                     .arc({b, 0, centre}, {std::sqrt(b * b - top * top), 0, centre + top})
                     .line({0, 0, centre + top})
                     .face());
}

// A hemispherical shell with a rim and a port.
TopoDS_Shape dished_cap(const Dimensions& d) {
  const double r = d["radius"], in = r * (1 - d["thickness"]), rim = d["rim"] * r;
  const double h = d["rim-height"] * r, port = d["port"] * r;
  const auto on = [](double radius, double x) {
    return Vector3d(x, 0, std::sqrt(radius * radius - x * x));
  };
  const Vector3d outer(std::sqrt(r * r - h * h), 0, h);
  return revolve(Outline({in, 0, 0})
                     .line({rim, 0, 0})
                     .line({rim, 0, h})
                     .line(outer)
                     .arc(on(r, 0.7 * r), on(r, port))
                     .line(on(in, port))
                     .arc(on(in, 0.7 * in), {in, 0, 0})
                     .face());
}

// A pin with a round head, drilled across (saddle curves) and from below (blind).
TopoDS_Shape cross_drilled(const Dimensions& d) {
  const double r = d["radius"], length = d["length"] * r;
  const double s = r * std::sqrt(0.5);
  const TopoDS_Shape pin = revolve(Outline({0, 0, 0})
                                       .line({r, 0, 0})
                                       .line({r, 0, length})
                                       .arc({s, 0, length + s}, {0, 0, length + r})
                                       .face());
  const TopoDS_Shape bored =
      cut(pin, cylinder({0, 0, -1}, {0, 0, d["blind-depth"] * length + 1}, d["blind-bore"] * r));
  return cut(bored, cylinder({0, -2 * r, 0.6 * length}, {0, 4 * r, 0}, d["drill"] * r));
}

}  // namespace

const std::vector<PartMaker>& turned_parts() {
  static const std::vector<PartMaker> parts = {
      {"stepped-shaft", stepped_shaft},
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
      {"cross-drilled", cross_drilled},
  };
  return parts;
}

}  // namespace sketchsplat

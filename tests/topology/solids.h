// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// Solids typed by hand. Every helper appends.
struct SolidMaker {
  using Vector3d = Eigen::Vector3d;
  Solid solid;

  int node(const Vector3d& p) { return solid.edges.add_node(p); }
  int line(int a, int b) { return add(StrokeKind::kLine, a, b, {}); }
  int arc(int a, int b, const Vector3d& apex) { return add(StrokeKind::kArc, a, b, {apex}); }
  /// Counter-clockwise about the axis.
  int circle(const Vector3d& centre, const Vector3d& axis, double radius) {
    return add(StrokeKind::kCircle, -1, -1, {centre, axis.normalized() * radius});
  }
  int add(StrokeKind kind, int a, int b, const std::vector<Vector3d>& handles) {
    solid.inferred.push_back(false);
    return solid.edges.add_stroke(kind, a, b, handles);
  }
  void face(const Surface& surface, bool reversed, const std::vector<Loop>& loops) {
    solid.surfaces.push_back(surface);
    solid.faces.push_back({int(solid.surfaces.size()) - 1, reversed, loops});
  }
  /// A polygon of nodes, counter-clockwise from outside; its edges are found or made.
  Loop polygon(const std::vector<int>& nodes) {
    Loop loop;
    for (size_t i = 0; i < nodes.size(); ++i)
      loop.push_back(edge(nodes[i], nodes[(i + 1) % nodes.size()]));
    return loop;
  }
  LoopStroke edge(int a, int b) {
    for (int s = 0; s < solid.edges.size(); ++s) {
      const Stroke& stroke = solid.edges.strokes[s];
      if (stroke.begin == a && stroke.end == b) return {s, true};
      if (stroke.begin == b && stroke.end == a) return {s, false};
    }
    return {line(a, b), true};
  }
  /// Lines around a rectangle of half sides x and y at a height, and its corners,
  /// counter-clockwise.
  std::vector<int> rectangle(double x, double y, const Vector3d& middle) {
    std::vector<int> n;
    for (const auto& [a, b] : {std::pair(-x, -y), {x, -y}, {x, y}, {-x, y}})
      n.push_back(node(middle + Vector3d(a, b, 0)));
    for (int i = 0; i < 4; ++i) line(n[size_t(i)], n[size_t(i + 1) % 4]);
    return n;
  }
  /// Two rectangles about z and the lines between their corners.
  void frame(double x, double y, double low, double high) {
    const std::vector<int> a = rectangle(x, y, {0, 0, low}), b = rectangle(x, y, {0, 0, high});
    for (size_t i = 0; i < 4; ++i) line(a[i], b[i]);
  }
  static Surface plane(const Vector3d& p, const Vector3d& n) {
    return {SurfaceKind::kPlane, p, n.normalized()};
  }
  static Surface cylinder(const Vector3d& p, const Vector3d& axis, double radius) {
    return {SurfaceKind::kCylinder, p, axis.normalized(), radius};
  }
  /// Of the corners 0..3 below and 4..7 above, each counter-clockwise from above.
  std::vector<int> box_nodes(const Vector3d& low, const Vector3d& high) {
    std::vector<int> n;
    for (const double z : {low.z(), high.z()})
      for (const auto& [x, y] : {std::pair(low.x(), low.y()), std::pair(high.x(), low.y()),
                                 std::pair(high.x(), high.y()), std::pair(low.x(), high.y())})
        n.push_back(node({x, y, z}));
    return n;
  }
  Vector3d at(int n) const { return solid.edges.nodes.col(n); }
  /// The sides of a box; top and bottom with holes.
  void box(const Vector3d& low, const Vector3d& high, const std::vector<Loop>& top_holes = {},
           const std::vector<Loop>& bottom_holes = {}) {
    const std::vector<int> n = box_nodes(low, high);
    const auto side = [&](int a, int b, int c, int d, const std::vector<Loop>& holes) {
      std::vector<Loop> loops = {polygon({n[a], n[b], n[c], n[d]})};
      loops.insert(loops.end(), holes.begin(), holes.end());
      const Vector3d normal = (at(n[b]) - at(n[a])).cross(at(n[d]) - at(n[a]));
      face(plane(at(n[a]), normal), false, loops);
    };
    side(0, 3, 2, 1, bottom_holes);
    side(4, 5, 6, 7, top_holes);
    side(0, 1, 5, 4, {});
    side(1, 2, 6, 5, {});
    side(2, 3, 7, 6, {});
    side(3, 0, 4, 7, {});
  }
};

inline Solid box_solid(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  SolidMaker m;
  m.box(low, high);
  return m.solid;
}

/// A plate 2 x 1 x 0.5 from the origin with a hole of radius 0.25 about (0.6, 0.5); `depth` of it
/// from above, a through hole if 0.5.
inline Solid plate_with_hole(double depth) {
  using Eigen::Vector3d;
  SolidMaker m;
  const Vector3d up = Vector3d::UnitZ();
  const bool through = depth >= 0.5;
  const int top = m.circle({0.6, 0.5, 0.5}, up, 0.25);
  const int bottom = m.circle({0.6, 0.5, 0.5 - depth}, up, 0.25);
  m.box({0, 0, 0}, {2, 1, 0.5}, {{{top, false}}},
        through ? std::vector<Loop>{{{bottom, true}}} : std::vector<Loop>());
  // From inside of the hole its wall is seen from outside of the material.
  m.face(SolidMaker::cylinder({0.6, 0.5, 0}, up, 0.25), true, {{{top, true}}, {{bottom, false}}});
  if (!through) m.face(SolidMaker::plane({0.6, 0.5, 0.5 - depth}, up), false, {{{bottom, true}}});
  return m.solid;
}

/// A cone about z: radius 1 at z = 0, and `top` at z = 1; 0 is an apex.
inline Solid cone_solid(double top) {
  using Eigen::Vector3d;
  SolidMaker m;
  const Vector3d up = Vector3d::UnitZ();
  const int base = m.circle({0, 0, 0}, up, 1);
  m.face(SolidMaker::plane({0, 0, 0}, -up), false, {{{base, false}}});
  const Surface side = {SurfaceKind::kCone, Vector3d(0, 0, 0), up, 1, top - 1};
  if (top > 0) {
    const int upper = m.circle({0, 0, 1}, up, top);
    m.face(SolidMaker::plane({0, 0, 1}, up), false, {{{upper, true}}});
    m.face(side, false, {{{base, true}}, {{upper, false}}});
  } else {
    m.face(side, false, {{{base, true}}});
  }
  return m.solid;
}

/// The edges of a bar of thickness 1 along x, from -2 to 1, with an arc of apex (`apex`, 0) between
/// (1, -1) and (1, 1) at its end: one of radius 1 if it is 2. Nothing shows where flat sides run
/// into the round. Strokes 0 to 3 lie at height 0, the second one is the arc; 4 to 7 at height 1.
inline Sketch tongue_edges(double apex = 2) {
  SolidMaker m;
  for (const double z : {0.0, 1.0}) {
    const int a = m.node({-2, -1, z}), b = m.node({1, -1, z}), c = m.node({1, 1, z}),
              d = m.node({-2, 1, z});
    m.line(a, b);
    m.arc(b, c, {apex, 0, z});
    m.line(c, d);
    m.line(d, a);
  }
  m.line(0, 4);
  m.line(3, 7);
  return m.solid.edges;
}

inline Sketch without(const Sketch& sketch, const std::vector<int>& strokes) {
  std::vector<bool> keep(sketch.size(), true);
  for (const int s : strokes) keep[s] = false;
  return keep_strokes(sketch, keep);
}

inline Solid sphere_solid() {
  SolidMaker m;
  m.face({SurfaceKind::kSphere, {1, 2, 3}, Eigen::Vector3d::UnitZ(), 0.5}, false, {});
  return m.solid;
}

/// Half a cylinder of radius 1 and height 2 on its flat side: arcs and lines.
inline Solid half_cylinder() {
  using Eigen::Vector3d;
  SolidMaker m;
  int n[4];
  for (int k = 0; k < 2; ++k)
    n[2 * k] = m.node({1, 0, 2.0 * k}), n[2 * k + 1] = m.node({-1, 0, 2.0 * k});
  const int low = m.arc(n[0], n[1], {0, 1, 0}), high = m.arc(n[2], n[3], {0, 1, 2});
  const int right = m.line(n[0], n[2]), left = m.line(n[1], n[3]);
  const int front_low = m.line(n[0], n[1]), front_high = m.line(n[2], n[3]);
  m.face(SolidMaker::plane({0, 0, 0}, -Vector3d::UnitZ()), false,
         {{{low, false}, {front_low, true}}});
  m.face(SolidMaker::plane({0, 0, 2}, Vector3d::UnitZ()), false,
         {{{high, true}, {front_high, false}}});
  m.face(SolidMaker::cylinder({0, 0, 0}, Vector3d::UnitZ(), 1), false,
         {{{low, true}, {left, true}, {high, false}, {right, false}}});
  m.face(SolidMaker::plane({0, 0, 0}, -Vector3d::UnitY()), false,
         {{{front_low, false}, {right, true}, {front_high, true}, {left, false}}});
  return m.solid;
}

/// A ball of radius 1 cut at a height in (-1, 1): what lies above it.
inline Solid ball_cap(double height, const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ()) {
  SolidMaker m;
  const int rim = m.circle(height * up, up, std::sqrt(1 - height * height));
  m.face({SurfaceKind::kSphere, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), 1}, false,
         {{{rim, true}}});
  m.face(SolidMaker::plane(height * up, -up), false, {{{rim, false}}});
  return m.solid;
}

/// The octant of the unit ball between the positive half-axes.
inline Solid ball_octant() {
  using Eigen::Vector3d;
  SolidMaker m;
  const int o = m.node({0, 0, 0});
  int n[3], spoke[3], arc[3];
  for (int k = 0; k < 3; ++k) n[k] = m.node(Vector3d::Unit(k));
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    spoke[k] = m.line(o, n[k]);
    arc[k] = m.arc(n[k], n[next], (Vector3d::Unit(k) + Vector3d::Unit(next)).normalized());
  }
  m.face({SurfaceKind::kSphere, Vector3d::Zero(), Vector3d::UnitZ(), 1}, false,
         {{{arc[0], true}, {arc[1], true}, {arc[2], true}}});
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    m.face(SolidMaker::plane({0, 0, 0}, -Vector3d::Unit((k + 2) % 3)), false,
           {{{spoke[next], true}, {arc[k], false}, {spoke[k], false}}});
  }
  return m.solid;
}

inline Surface torus_about_z() {
  return {SurfaceKind::kTorus, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 2, 0, 0.5};
}

/// A quarter of the torus with radii 2 and 0.5 about z, as a bent rod.
inline Solid elbow() {
  using Eigen::Vector3d;
  SolidMaker m;
  const int begin = m.circle({2, 0, 0}, -Vector3d::UnitY(), 0.5);
  const int end = m.circle({0, 2, 0}, -Vector3d::UnitX(), 0.5);
  m.face(torus_about_z(), false, {{{begin, false}}, {{end, false}}});
  m.face(SolidMaker::plane({2, 0, 0}, -Vector3d::UnitY()), false, {{{begin, true}}});
  m.face(SolidMaker::plane({0, 2, 0}, -Vector3d::UnitX()), false, {{{end, true}}});
  return m.solid;
}

/// The upper half of that torus with its hole filled: a rounded disk of height 0.5. The round side
/// is the outer quarter of the tube.
inline Solid rounded_disk() {
  using Eigen::Vector3d;
  SolidMaker m;
  const Vector3d up = Vector3d::UnitZ();
  const int rim = m.circle({0, 0, 0}, up, 2.5), top = m.circle({0, 0, 0.5}, up, 2);
  m.face(torus_about_z(), false, {{{rim, true}}, {{top, false}}});
  m.face(SolidMaker::plane({0, 0, 0.5}, up), false, {{{top, true}}});
  m.face(SolidMaker::plane({0, 0, 0}, -up), false, {{{rim, false}}});
  return m.solid;
}

/// A rod of radius 1 from z = 0 to a cut through (0, 0, 2) that rises with x; its lower rim is two
/// arcs with corners that no seam needs.
inline Solid cut_rod() {
  using Eigen::Vector3d;
  SolidMaker m;
  const int a = m.node({0.6, 0.8, 0}), b = m.node({-0.6, -0.8, 0});
  const int left = m.arc(a, b, {-0.8, 0.6, 0}), right = m.arc(b, a, {0.8, -0.6, 0});
  const int cut = m.add(StrokeKind::kEllipse, -1, -1, {{0, 0, 2}, {1, 0, 0.5}, {0, 1, 0}});
  m.face(SolidMaker::cylinder({0, 0, 0}, Vector3d::UnitZ(), 1), false,
         {{{left, true}, {right, true}}, {{cut, false}}});
  m.face(SolidMaker::plane({0, 0, 0}, -Vector3d::UnitZ()), false,
         {{{right, false}, {left, false}}});
  m.face(SolidMaker::plane({0, 0, 2}, {-0.5, 0, 1}), false, {{{cut, true}}});
  return m.solid;
}

/// Half of the cone with apex (0, 0, 1) over the unit disk: y > 0.
inline Solid half_cone() {
  using Eigen::Vector3d;
  SolidMaker m;
  const int a = m.node({1, 0, 0}), b = m.node({-1, 0, 0}), apex = m.node({0, 0, 1});
  const int base = m.line(b, a), rim = m.arc(a, b, {0, 1, 0});
  const int up = m.line(b, apex), down = m.line(apex, a);
  m.face({SurfaceKind::kCone, {0, 0, 0}, Vector3d::UnitZ(), 1, -1}, false,
         {{{rim, true}, {up, true}, {down, true}}});
  m.face(SolidMaker::plane({0, 0, 0}, -Vector3d::UnitZ()), false, {{{rim, false}, {base, false}}});
  m.face(SolidMaker::plane({0, 0, 0}, -Vector3d::UnitY()), false,
         {{{base, true}, {down, false}, {up, false}}});
  return m.solid;
}

/// As if all of a solid's surfaces were looked at from the other side.
inline Solid inside_out(Solid solid) {
  for (SolidFace& face : solid.faces) {
    face.reversed = !face.reversed;
    for (Loop& loop : face.loops) {
      std::reverse(loop.begin(), loop.end());
      for (LoopStroke& s : loop) s.forward = !s.forward;
    }
  }
  return solid;
}

/// Control points moved at random by at most this along each axis.
inline Solid perturbed(Solid solid, double by) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-by, by);
  for (int i = 0; i < solid.edges.nodes.size(); ++i) solid.edges.nodes.data()[i] += off(random);
  for (const Stroke& s : solid.edges.strokes)
    if (s.handle >= 0)
      for (int k = 0; k < 3; ++k) solid.edges.handles(k, s.handle) += off(random);
  solid.gap = 2 * by;
  return solid;
}

/// One of each that has edges.
inline std::vector<Solid> some_solids() {
  return {box_solid({0, 0, 0}, {1, 2, 3}),
          plate_with_hole(0.2),
          plate_with_hole(0.5),
          half_cylinder(),
          cone_solid(0.5),
          cone_solid(0),
          ball_cap(0.6),
          ball_cap(-0.7),
          ball_octant(),
          elbow(),
          rounded_disk(),
          cut_rod(),
          half_cone()};
}

}  // namespace sketchsplat

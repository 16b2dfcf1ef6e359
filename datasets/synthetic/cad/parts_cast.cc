// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>

#include "datasets/synthetic/cad/shapes.h"

// Parts with rounded edges: what is round is no edge, what is machined is one.

namespace sketchsplat {
namespace {

// A polygon in the plane of `right` and `up`, the corner after each side rounded by its radius
// (0: sharp). A corner is `from` + `right` x + `up` y.
class RoundedOutline {
 public:
  RoundedOutline(Vector3d right, Vector3d up) : right_(std::move(right)), up_(std::move(up)) {}
  void add(double x, double y, double radius) { corners_.push_back({{x, y}, radius}); }

  TopoDS_Face face() const {
    const int n = int(corners_.size());
    Outline outline(in_space(leaving(0)));
    for (int i = 1; i <= n; ++i) {
      const Corner& c = corners_[i % n];
      outline.line(in_space(entering(i % n)));
      if (!(c.radius > 0)) continue;
      const Vector2d a = entering(i % n), b = leaving(i % n), mid = (a + b) / 2;
      // The middle of the arc lies on the line from the corner to the centre.
      const Vector2d way = (mid - c.at).normalized();
      const double half = std::acos((a - c.at).normalized().dot(way));
      const Vector2d top = c.at + way * c.radius * (1 / std::sin(half) - 1);
      outline.arc(in_space(top), in_space(b));
    }
    return outline.face();
  }

 private:
  struct Corner {
    Vector2d at;
    double radius;
  };
  Vector3d in_space(const Vector2d& p) const { return right_ * p.x() + up_ * p.y(); }
  // Where the outline leaves the sides that meet in a corner.
  Vector2d towards(int corner, int other) const {
    const int n = int(corners_.size());
    const Corner& c = corners_[corner];
    const Vector2d a = (corners_[(corner + 1) % n].at - c.at).normalized();
    const Vector2d b = (corners_[(corner + n - 1) % n].at - c.at).normalized();
    const double half = std::acos(a.dot(b)) / 2;
    return c.at + (other > 0 ? a : b) * c.radius / std::tan(half);
  }
  Vector2d entering(int corner) const { return towards(corner, -1); }
  Vector2d leaving(int corner) const { return towards(corner, 1); }

  Vector3d right_, up_;
  std::vector<Corner> corners_;
};

// An angle, all edges rounded, with a machined foot and a bore in either leg.
TopoDS_Shape cast_bracket(const Dimensions& d) {
  const double a = d["length"], w = d["width"] * a, b = d["height"] * a;
  const double r = d["round"] * a, wide = 1.4 * r, t = d["leg"] * a;
  RoundedOutline outline({1, 0, 0}, {0, 0, 1});
  for (const Vector2d& p : {Vector2d(0, -wide), Vector2d(a, -wide), Vector2d(a, t), Vector2d(t, t),
                            Vector2d(t, b), Vector2d(0, b)})
    outline.add(p.x(), p.y(), wide);
  TopoDS_Shape shape = prism(outline.face(), Vector3d(0, w, 0));
  const auto at_ends = [](const Vector3d& p, const Vector3d& q) {
    return std::abs(p.y() - q.y()) < 1e-9;
  };
  shape = fillet(shape, edges_where(shape, at_ends), r);
  shape = cut(shape, box({-1, -1, -1 - wide}, {a + 2, w + 2, 1 + wide}));
  const double bore = 0.16 * w;
  shape = cut(shape, cylinder({0.65 * a, w / 2, -1}, {0, 0, t + 2}, bore));
  return cut(shape, cylinder({-1, w / 2, 0.65 * b}, {t + 2, 0, 0}, bore));
}

// A step along x whose edges have rounds of different radii, and sharp ones among them.
TopoDS_Shape blend_step(const Dimensions& d) {
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const double r = d["round"] * length, half = w / 2, step = d["step"] * h;
  RoundedOutline outline({0, 1, 0}, {0, 0, 1});
  outline.add(0, 0, 0);
  outline.add(w, 0, 0);
  outline.add(w, step, 0.6 * r);
  outline.add(half, step, r);
  outline.add(half, h, 0.4 * r);
  outline.add(0, h, 0);
  return prism(outline.face(), Vector3d(length, 0, 0));
}

// A flange whose rims are rounded, with a round groove to its hub; base and bores are machined.
TopoDS_Shape cast_flange(const Dimensions& d) {
  const double r = d["radius"], longest = 2 * r, t = d["thickness"] * longest;
  const double h = d["hub-height"] * longest, hub = d["hub"] * r, round = d["round"] * longest;
  RoundedOutline outline({1, 0, 0}, {0, 0, 1});
  outline.add(0.5 * hub, 0, 0);
  outline.add(r, 0, 0);
  outline.add(r, t, round);
  outline.add(hub, t, round);
  outline.add(hub, t + h, 0.5 * round);
  outline.add(0.5 * hub, t + h, 0);
  TopoDS_Shape shape = revolve(outline.face());
  const int count = int(d["holes"]);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count, at = 0.5 * (hub + r);
    shape = cut(shape, cylinder({at * std::cos(angle), at * std::sin(angle), -1}, {0, 0, t + 2},
                                d["hole"] * r));
  }
  return shape;
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
  const double length = d["length"], w = d["width"] * length, h = d["height"] * length;
  const double r = d["round"] * length, x = d["sharp"] * length;
  const TopoDS_Shape shape =
      cut(box(Vector3d::Zero(), {length, w, h}), taper_tool({x, w, h}, length, 1, r));
  return cut(shape, taper_tool({length - x, 0, h}, 0, -1, r));
}

}  // namespace

const std::vector<PartMaker>& cast_parts() {
  static const std::vector<PartMaker> parts = {{"cast-bracket", cast_bracket},
                                               {"blend-step", blend_step},
                                               {"cast-flange", cast_flange},
                                               {"taper-block", taper_block}};
  return parts;
}

}  // namespace sketchsplat

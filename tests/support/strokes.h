// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "tests/support/wireframe.h"

namespace sketchsplat::test {

/// Strokes with nodes of their own.
inline int add_line(Sketch* s, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const int begin = s->add_node(a), end = s->add_node(b);
  return s->add_stroke(StrokeKind::kLine, begin, end, {});
}
inline int add_arc(Sketch* s, const Eigen::Vector3d& a, const Eigen::Vector3d& apex,
                   const Eigen::Vector3d& b) {
  const int begin = s->add_node(a), end = s->add_node(b);
  return s->add_stroke(StrokeKind::kArc, begin, end, {apex});
}
inline int add_bezier(Sketch* s, const Eigen::Vector3d& a, const Eigen::Vector3d& h0,
                      const Eigen::Vector3d& h1, const Eigen::Vector3d& b) {
  const int begin = s->add_node(a), end = s->add_node(b);
  return s->add_stroke(StrokeKind::kBezier, begin, end, {h0, h1});
}
/// Of centre + cos(t) p + sin(t) q.
inline int add_elliptic_arc(Sketch* s, const Eigen::Vector3d& centre, const Eigen::Vector3d& p,
                            const Eigen::Vector3d& q, double t0, double t1) {
  const ControlPoints c = elliptic_arc(centre, p, q, t0, t1);
  const int begin = s->add_node(c.p[0]), end = s->add_node(c.p[3]);
  return s->add_stroke(StrokeKind::kEllipticArc, begin, end, {c.p[1], c.p[2]});
}
/// `axis`: unit normal times radius.
inline int add_circle(Sketch* s, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis) {
  return s->add_stroke(StrokeKind::kCircle, -1, -1, {centre, axis});
}

inline Eigen::Vector3d point_at(const Sketch& s, int stroke, double t) {
  Eigen::Vector3d p, d;
  evaluate_stroke(s, stroke, t, &p, &d);
  return p;
}

/// A stroke as something to be seen.
inline Polyline polyline_of(const Sketch& s, int stroke) {
  Polyline p;
  const int n = s.strokes[stroke].kind == StrokeKind::kLine ? 1 : 400;
  for (int i = 0; i <= n; ++i) p.push_back(point_at(s, stroke, double(i) / n));
  return p;
}
inline std::vector<Polyline> polylines_of(const Sketch& s) {
  std::vector<Polyline> out;
  for (int i = 0; i < s.size(); ++i) out.push_back(polyline_of(s, i));
  return out;
}

/// Largest distance of a stroke from the curves; `ends` is the share left out at either end (the
/// edgels say nothing about where on a line its ends belong).
inline double farthest(const Sketch& s, int stroke, const std::vector<Polyline>& curves,
                       double ends = 0) {
  double worst = 0;
  for (int i = 0; i <= 40; ++i)
    worst =
        std::max(worst, distance_to(curves, point_at(s, stroke, ends + (1 - 2 * ends) * i / 40.0)));
  return worst;
}

/// The sketch moved by `shift`. The axis of a circle is no point and stays.
inline Sketch moved(Sketch s, const Eigen::Vector3d& shift) {
  s.nodes.colwise() += shift;
  for (const Stroke& stroke : s.strokes)
    for (int h = 0; h < (is_closed(stroke.kind) ? 1 : num_handles(stroke.kind)); ++h)
      s.handles.col(stroke.handle + h) += shift;
  return s;
}
inline Sketch scaled(Sketch s, double factor) {
  s.nodes *= factor;
  s.handles *= factor;
  return s;
}

/// A view with fewer pixels of the same scene.
inline View smaller(View v, int size) {
  const double f = double(size) / v.camera.width;
  v.camera = {size, size, f * v.camera.fx, f * v.camera.fy, (size - 1) / 2.0, (size - 1) / 2.0};
  return v;
}

/// The picture of a convex body: 1 where the ray through a pixel meets the hull of the points.
inline Image<uint8_t> convex_mask(const View& view, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector2d> q;
  double z;
  for (const Eigen::Vector3d& p : points) q.push_back(view.project(p, &z));
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  Image<uint8_t> mask(view.camera.width, view.camera.height, 1);
  for (const Eigen::Vector2d& a : q)
    for (const Eigen::Vector2d& b : q) {
      if ((b - a).norm() < 1e-9) continue;
      const bool border = std::all_of(q.begin(), q.end(), [&](const Eigen::Vector2d& c) {
        return cross(b - a, c - a) >= -1e-9;
      });
      if (!border) continue;
      for (int y = 0; y < mask.height; ++y) {  // in this row, at + slope * x >= 0 is inside
        const double at = cross(b - a, Eigen::Vector2d(0, y) - a), slope = -(b - a).y();
        const double end = std::clamp(-at / slope, -1.0, mask.width + 1.0);
        int first = 0, last = mask.width;  // of what lies outside
        if (slope > 0) last = std::clamp(int(std::ceil(end)), 0, mask.width);
        if (slope < 0) first = std::clamp(int(std::floor(end)) + 1, 0, mask.width);
        if (slope == 0 && at >= 0) last = 0;
        std::fill(mask.row(y) + first, mask.row(y) + std::max(first, last), uint8_t(0));
      }
    }
  return mask;
}

inline std::vector<Eigen::Vector3d> cube_corners(const Eigen::Vector3d& low, double size) {
  std::vector<Eigen::Vector3d> out;
  for (int k = 0; k < 8; ++k)
    out.push_back(low + size * Eigen::Vector3d(k & 1, (k >> 1) & 1, k >> 2));
  return out;
}

}  // namespace sketchsplat::test

// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "edges/views/lift.h"
#include "edges/views/match.h"

namespace sketchsplat::test {

/// Cameras on a Fibonacci sphere that look at `target` from `distance`; 400 x 400 px, focal
/// 500 px, or `side` px and as much more.
inline std::vector<View> ring_of_views(int count, const Eigen::Vector3d& target, double distance,
                                       int side = 400) {
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, a = i * M_PI * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d back(r * std::cos(a), r * std::sin(a), z);
    const Eigen::Vector3d forward = -back;
    Eigen::Vector3d up =
        std::abs(back.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d right = forward.cross(up).normalized();
    View v;
    v.name = std::to_string(i);
    const double focal = 1.25 * side, centre = (side - 1) / 2.0;
    v.camera = {side, side, focal, focal, centre, centre};
    v.cam_from_world.rotation.row(0) = right;
    v.cam_from_world.rotation.row(1) = forward.cross(right);
    v.cam_from_world.rotation.row(2) = forward;
    v.cam_from_world.translation = -v.cam_from_world.rotation * (target + distance * back);
    views.push_back(v);
  }
  return views;
}

/// A curve in space as points; consecutive points are joined by straight pieces.
using Polyline = std::vector<Eigen::Vector3d>;

inline Polyline segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return {a, b}; }

inline Polyline circle(const Eigen::Vector3d& c, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                       double from_deg = 0, double to_deg = 360) {
  Polyline p;
  for (int i = 0; i <= 360; ++i) {
    const double a = (from_deg + (to_deg - from_deg) * i / 360) * M_PI / 180;
    p.push_back(c + std::cos(a) * u + std::sin(a) * v);
  }
  return p;
}

inline std::vector<Polyline> cube_edges(const Eigen::Vector3d& low, double size) {
  std::vector<Polyline> out;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) {
      Eigen::Vector3d a = low;
      a[(axis + 1) % 3] += size * (k & 1);
      a[(axis + 2) % 3] += size * (k >> 1);
      out.push_back(segment(a, a + size * Eigen::Vector3d::Unit(axis)));
    }
  return out;
}

/// Perfect edgels, one per pixel of length, of curves that everybody sees.
inline EdgelMap ideal_edgels(const View& view, const std::vector<Polyline>& curves) {
  EdgelMap map;
  map.width = view.camera.width, map.height = view.camera.height;
  map.chain.push_back(0);
  for (const Polyline& curve : curves) {
    double carry = 0;
    for (size_t i = 0; i + 1 < curve.size(); ++i) {
      double za, zb;
      const Eigen::Vector2d a = view.project(curve[i], &za), b = view.project(curve[i + 1], &zb);
      if (za <= 0 || zb <= 0) continue;
      const double length = (b - a).norm();
      if (length < 1e-9) continue;
      const Eigen::Vector2d t = (b - a) / length;
      for (; carry <= length; carry += 1) {
        const Eigen::Vector2d p = a + carry * t;
        if (!view.camera.contains(p)) continue;
        Edgel e;
        e.x = float(p.x()), e.y = float(p.y());
        e.nx = float(t.y()), e.ny = float(-t.x());
        e.strength = 0.3f, e.width = 1.2f;
        map.edgels.push_back(e);
      }
      carry -= length;
    }
    if (int(map.edgels.size()) > map.chain.back()) map.chain.push_back(int(map.edgels.size()));
  }
  build_lookup(&map, 4.0);
  return map;
}

inline EdgeWorld ideal_world(const std::vector<View>& views, const std::vector<Polyline>& curves) {
  std::vector<EdgelMap> maps;
  for (const View& v : views) maps.push_back(ideal_edgels(v, curves));
  return make_edge_world(views, maps);
}

/// n samples of a straight curve.
inline CurvePoints line_samples(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int n) {
  CurvePoints s;
  s.position.resize(3, n), s.tangent.resize(3, n);
  for (int i = 0; i < n; ++i) {
    s.position.col(i) = a + (b - a) * (i + 0.5) / n;
    s.tangent.col(i) = (b - a).normalized();
  }
  s.first = {0, n};
  return s;
}

/// Distance of a point from the nearest curve.
inline double distance_to(const std::vector<Polyline>& curves, const Eigen::Vector3d& p) {
  double best = 1e300;
  for (const Polyline& c : curves)
    for (size_t i = 0; i + 1 < c.size(); ++i) {
      const Eigen::Vector3d d = c[i + 1] - c[i];
      const double t =
          std::min(1.0, std::max(0.0, d.dot(p - c[i]) / std::max(1e-300, d.squaredNorm())));
      best = std::min(best, (c[i] + t * d - p).norm());
    }
  return best;
}

}  // namespace sketchsplat::test

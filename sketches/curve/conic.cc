// SPDX-License-Identifier: MIT
#include "sketches/curve/conic.h"

#include <Eigen/Geometry>
#include <cassert>
#include <cmath>

#include "sketches/curve/curve.h"

namespace sketchsplat {

CircleParameters circle_parameters(const Sketch& sketch, int stroke) {
  const StrokeKind kind = sketch.strokes[stroke].kind;
  assert(kind == StrokeKind::kArc || kind == StrokeKind::kCircle);
  const ControlPoints c = control_points(sketch, stroke);
  CircleParameters out;
  if (kind == StrokeKind::kCircle) {
    out.centre = c.p[0];
    out.radius = c.p[1].norm();
    out.normal = c.p[1] / out.radius;
    out.angle = 2 * M_PI;
    return out;
  }
  const ArcFrame<double> f = arc_frame<double>(c.p[0], c.p[1], c.p[2]);
  out.straight = f.straight;
  out.radius = f.radius;
  out.angle = 2 * f.half_angle;
  out.centre = f.middle + f.up * (f.sagitta - f.radius);
  out.normal = f.up.cross(f.along);
  return out;
}

EllipticArcParameters elliptic_arc_parameters(const ControlPoints& c) {
  const EllipticFrame<double> f = elliptic_frame<double>(c.p[0], c.p[1], c.p[2], c.p[3]);
  EllipticArcParameters out;
  out.straight = f.straight;
  out.centre = out.p = out.q = Eigen::Vector3d::Zero();
  if (f.straight) return out;
  out.half_angle = f.half_angle;
  const double s = std::sin(f.half_angle / 2);
  out.p = f.rise / (2 * s * s);
  out.q = f.half_chord / std::sin(f.half_angle);
  out.centre = f.middle - std::cos(f.half_angle) * out.p;
  return out;
}

ControlPoints elliptic_arc(const Eigen::Vector3d& centre, const Eigen::Vector3d& p,
                           const Eigen::Vector3d& q, double psi0, double psi1) {
  const auto at = [&](double a) -> Eigen::Vector3d {
    return centre + std::cos(a) * p + std::sin(a) * q;
  };
  ControlPoints out;
  out.count = 4;
  out.p[0] = at(psi0), out.p[1] = at((psi0 + psi1) / 2), out.p[3] = at(psi1);
  out.p[2] = elliptic_quarter(out.p[0], out.p[1], out.p[3], (psi1 - psi0) / 2);
  return out;
}

ControlPoints elliptic_arc_between(const ControlPoints& c, const Eigen::Vector3d& begin,
                                   const Eigen::Vector3d& end) {
  const EllipticArcParameters e = elliptic_arc_parameters(c);
  const Eigen::Vector3d normal = e.p.cross(e.q);
  const double n2 = normal.squaredNorm();
  const auto angle_near = [&](double psi, const Eigen::Vector3d& x) {
    const Eigen::Vector3d v = x - e.centre;
    const double there = std::atan2(e.p.cross(v).dot(normal), v.cross(e.q).dot(normal));
    return psi + std::remainder(there - psi, 2 * M_PI);
  };
  const double psi0 = angle_near(-e.half_angle, begin), psi1 = angle_near(e.half_angle, end);
  ControlPoints out = c;
  if (!e.straight && n2 > 0 && psi1 - psi0 > 2e-3 && psi1 - psi0 < 6.2) {
    out.p[1] = e.at((psi0 + psi1) / 2);
    out.p[2] = elliptic_quarter(begin, out.p[1], end, (psi1 - psi0) / 2);
  } else {
    for (int k : {1, 2}) out.p[k] += (begin - c.p[0] + end - c.p[3]) / 2;
  }
  out.p[0] = begin, out.p[3] = end;
  return out;
}

EllipseAxes principal_axes(const Eigen::Vector3d& u, const Eigen::Vector3d& v, double* angle) {
  const double a = 0.5 * std::atan2(2 * u.dot(v), u.squaredNorm() - v.squaredNorm());
  if (angle) *angle = a;
  return {std::cos(a) * u + std::sin(a) * v, std::cos(a) * v - std::sin(a) * u};
}

}  // namespace sketchsplat

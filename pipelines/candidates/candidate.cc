// SPDX-License-Identifier: MIT
#include "pipelines/candidates/candidate.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve/curve.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {

using Eigen::Vector3d;

Candidate candidate_of(const Sketch& sketch, int stroke) {
  return {sketch.strokes[stroke].kind, control_points(sketch, stroke)};
}

const std::vector<Window>& windows_of(const Candidate& candidate) {
  static const std::vector<Window> none;
  return candidate.windows ? *candidate.windows : none;
}

void append(const Candidate& c, Sketch* sketch) {
  const int inner = num_handles(c.kind), first = is_closed(c.kind) ? 0 : 1;
  int begin = -1, end = -1;
  if (!is_closed(c.kind)) {
    begin = sketch->add_node(c.curve.p[0]);
    end = sketch->add_node(c.curve.p[c.curve.count - 1]);
  }
  sketch->add_stroke(c.kind, begin, end,
                     {c.curve.p.begin() + first, c.curve.p.begin() + first + inner});
}

CurvePoints candidate_points(const Candidate& candidate, double spacing) {
  constexpr int kFirst = 16;
  double length = 0;
  Eigen::Vector3d p, d;
  for (int k = 0; k < kFirst; ++k) {
    evaluate_curve<double>(candidate.kind, candidate.curve.p.data(), (k + 0.5) / kFirst, &p, &d);
    length += d.norm() / kFirst;
  }
  const int n = std::max(2, int(std::ceil(length / spacing)));
  CurvePoints out;
  out.position.resize(3, n);
  out.tangent.resize(3, n);
  for (int k = 0; k < n; ++k) {
    evaluate_curve<double>(candidate.kind, candidate.curve.p.data(), (k + 0.5) / n, &p, &d);
    out.position.col(k) = p;
    out.tangent.col(k) = d.normalized();
  }
  out.first = {0, n};
  return out;
}

Candidate moved(const Candidate& candidate, const Eigen::Affine3d& by) {
  Candidate out = candidate;
  // Axes of closed curves are vectors, not places.
  const int places = is_closed(candidate.kind) ? 1 : candidate.curve.count;
  for (int k = 0; k < out.curve.count; ++k) {
    out.curve.p[k] = by.linear() * candidate.curve.p[k];
    if (k < places) out.curve.p[k] += by.translation();
  }
  return out;
}

Candidate moved(const Candidate& candidate, const Vector3d& by) {
  return moved(candidate, Eigen::Affine3d(Eigen::Translation3d(by)));
}

Eigen::Affine3d mirror(const Vector3d& normal, double height) {
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  out.linear() -= 2 * normal * normal.transpose();
  out.translation() = 2 * height * normal;
  return out;
}

Vector3d plane_normal(StrokeKind kind, const ControlPoints& c) {
  Vector3d n = Vector3d::Zero();
  if (kind == StrokeKind::kCircle) n = c.p[1];
  if (kind == StrokeKind::kEllipse) n = c.p[1].cross(c.p[2]);
  if (kind == StrokeKind::kArc) n = (c.p[1] - c.p[0]).cross(c.p[2] - c.p[0]);
  if (kind == StrokeKind::kEllipticArc) n = (c.p[1] - c.p[0]).cross(c.p[3] - c.p[0]);
  return n.norm() > 0 ? Vector3d(n.normalized()) : n;
}

std::vector<Circle> circles_of(const Sketch& sketch) {
  std::vector<Circle> out;
  for (int i = 0; i < sketch.size(); ++i) {
    if (sketch.strokes[i].kind != StrokeKind::kCircle) continue;
    const ControlPoints c = control_points(sketch, i);
    if (c.p[1].norm() > 0) out.push_back({c.p[0], c.p[1].normalized(), c.p[1].norm()});
  }
  return out;
}

std::vector<Circle> distinct_axes(const std::vector<Circle>& circles, double tolerance) {
  std::vector<Circle> out;
  for (const Circle& c : circles) {
    const auto is_this = [&](const Circle& a) {
      return std::abs(a.axis.dot(c.axis)) > kParallel &&
             a.axis.cross(c.centre - a.centre).norm() < tolerance;
    };
    if (std::none_of(out.begin(), out.end(), is_this)) out.push_back(c);
  }
  return out;
}

Candidate candidate_of(const Circle& circle) {
  Candidate out{StrokeKind::kCircle, {}};
  out.curve.count = 2;
  out.curve.p.fill(Eigen::Vector3d::Zero());
  out.curve.p[0] = circle.centre, out.curve.p[1] = circle.radius * circle.axis;
  return out;
}

KnownCurves::KnownCurves(const Sketch& sketch, double spacing, double reach)
    : reach_(reach), tree_(evaluate_samples(sketch, plan_samples(sketch, spacing)).position) {}

double KnownCurves::share(const CurvePoints& curve) const {
  int near = 0;
  for (int i = 0; i < curve.position.cols(); ++i)
    near += tree_.distance(curve.position.col(i)) <= reach_;
  return double(near) / double(curve.position.cols());
}

}  // namespace sketchsplat

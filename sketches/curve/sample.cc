// SPDX-License-Identifier: MIT
#include "sketches/curve/sample.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Jet12 = ceres::Jet<double, 12>;  // three coordinates of up to four control points

// Unit vector and its derivative applied from the left: g^T d(d/|d|) = (g - u u^T g)^T / |d|.
Eigen::Vector3d unit_backward(const Eigen::Vector3d& d, const Eigen::Vector3d& g) {
  const double n = d.norm();
  if (!(n > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d u = d / n;
  return (g - u * u.dot(g)) / n;
}

// Gradient by the 12 control coordinates of g_p . position + g_d . derivative.
Eigen::Matrix<double, 12, 1> pull_back(StrokeKind kind, const ControlPoints& c, double t,
                                       const Eigen::Vector3d& g_p, const Eigen::Vector3d& g_u) {
  Vec3<Jet12> control[4], position, derivative;
  for (int i = 0; i < c.count; ++i)
    for (int k = 0; k < 3; ++k) control[i][k] = Jet12(c.p[i][k], 3 * i + k);
  evaluate_curve<Jet12>(kind, control, t, &position, &derivative);
  const Eigen::Vector3d d(derivative[0].a, derivative[1].a, derivative[2].a);
  const Eigen::Vector3d g_d = unit_backward(d, g_u);
  Eigen::Matrix<double, 12, 1> g = Eigen::Matrix<double, 12, 1>::Zero();
  for (int k = 0; k < 3; ++k) g += position[k].v * g_p[k] + derivative[k].v * g_d[k];
  return g;
}

}  // namespace

PointJacobian point_jacobian(StrokeKind kind, const ControlPoints& c, double t) {
  Vec3<Jet12> control[4], position, derivative;
  for (int i = 0; i < c.count; ++i)
    for (int k = 0; k < 3; ++k) control[i][k] = Jet12(c.p[i][k], 3 * i + k);
  evaluate_curve<Jet12>(kind, control, t, &position, &derivative);
  PointJacobian J;
  for (int k = 0; k < 3; ++k) J.row(k) = position[k].v.transpose();
  return J;
}

SampleLayout plan_samples(const Sketch& sketch, double spacing) {
  SampleLayout layout;
  layout.first.push_back(0);
  for (int s = 0; s < sketch.size(); ++s) {
    const double length = stroke_length(sketch, s);
    const int n = std::max(1, int(std::ceil(length / spacing)));
    std::vector<double> fractions(n);
    for (int i = 0; i < n; ++i) fractions[i] = (i + 0.5) / n;
    for (double t : arc_length_parameters(sketch, s, fractions)) {
      layout.stroke.push_back(s);
      layout.t.push_back(t);
      layout.length.push_back(length / n);
    }
    layout.first.push_back(layout.size());
  }
  return layout;
}

Samples evaluate_samples(const Sketch& sketch, const SampleLayout& layout) {
  Samples out;
  out.position.resize(3, layout.size());
  out.tangent.resize(3, layout.size());
  Eigen::Vector3d p, d;
  for (int i = 0; i < layout.size(); ++i) {
    evaluate_stroke(sketch, layout.stroke[i], layout.t[i], &p, &d);
    const double n = d.norm();
    out.position.col(i) = p;
    out.tangent.col(i) = n > 0 ? Eigen::Vector3d(d / n) : Eigen::Vector3d::Zero();
  }
  return out;
}

Eigen::Vector3d curvature_at(const Sketch& sketch, int stroke, double t) {
  constexpr double kStep = 1e-4;
  if (sketch.strokes[stroke].kind == StrokeKind::kLine) return Eigen::Vector3d::Zero();
  const double a = std::max(0.0, t - kStep), b = std::min(1.0, t + kStep);
  Eigen::Vector3d p, q, d, before, after;
  evaluate_stroke(sketch, stroke, a, &p, &before);
  evaluate_stroke(sketch, stroke, b, &q, &after);
  evaluate_stroke(sketch, stroke, t, &p, &d);
  const double length = d.norm() * (b - a);
  if (!(length > 0)) return Eigen::Vector3d::Zero();
  return (after.stableNormalized() - before.stableNormalized()) / length;
}

Eigen::Matrix3Xd sample_curvatures(const Sketch& sketch, const SampleLayout& layout) {
  Eigen::Matrix3Xd out(3, layout.size());
  for (int i = 0; i < layout.size(); ++i)
    out.col(i) = curvature_at(sketch, layout.stroke[i], layout.t[i]);
  return out;
}

SketchGradient evaluate_samples_backward(const Sketch& sketch, const SampleLayout& layout,
                                         const Samples& gradient) {
  SketchGradient out;
  out.nodes = Eigen::Matrix3Xd::Zero(3, sketch.nodes.cols());
  out.handles = Eigen::Matrix3Xd::Zero(3, sketch.handles.cols());
  for (int i = 0; i < layout.size(); ++i) {
    const int index = layout.stroke[i];
    const Stroke& s = sketch.strokes[index];
    const Eigen::Matrix<double, 12, 1> g =
        pull_back(s.kind, control_points(sketch, index), layout.t[i], gradient.position.col(i),
                  gradient.tangent.col(i));
    int k = 0;
    if (!is_closed(s.kind)) out.nodes.col(s.begin) += g.segment<3>(3 * k++);
    for (int h = 0; h < num_handles(s.kind); ++h)
      out.handles.col(s.handle + h) += g.segment<3>(3 * k++);
    if (!is_closed(s.kind)) out.nodes.col(s.end) += g.segment<3>(3 * k++);
  }
  return out;
}

}  // namespace sketchsplat

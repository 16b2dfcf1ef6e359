// SPDX-License-Identifier: MIT
#include "pipelines/candidates/circles.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {

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

}  // namespace sketchsplat

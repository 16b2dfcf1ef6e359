// SPDX-License-Identifier: MIT
#include "pipelines/candidates/known_curves.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve/curve.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {

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

KnownCurves::KnownCurves(const Sketch& sketch, double spacing, double reach)
    : reach_(reach), tree_(evaluate_samples(sketch, plan_samples(sketch, spacing)).position) {}

double KnownCurves::share(const CurvePoints& curve) const {
  int near = 0;
  for (int i = 0; i < curve.position.cols(); ++i)
    near += tree_.distance(curve.position.col(i)) <= reach_;
  return double(near) / double(curve.position.cols());
}

}  // namespace sketchsplat

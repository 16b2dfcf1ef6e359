// SPDX-License-Identifier: MIT
#include "pipelines/adjust/whitened.h"

#include <algorithm>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// [px^2] What all views together leave unknown of a place on a stroke: never less than `floor`. And
// a view may be wrong about the whole of a stroke: many places are no better than one then, so that
// of each is multiplied by their number. 1.4826 median is the standard deviation of normal numbers;
// the stroke itself follows the views by about two of them.
double unknown_of(const StrokeStats& s, double floor_px) {
  const double aside = 1.4826 * s.bias_px;
  return floor_px * floor_px + s.samples * (aside * aside / std::max(1, s.views - 2));
}

}  // namespace

SampleQuadratics whitened(const StrokeObservation& seen, double floor_px, double footprint) {
  const Matches& q = seen.matches;
  SampleQuadratics out{q.information, q.slope};
  for (size_t i = 0; i < q.information.size(); ++i) {
    const StrokeStats& stroke = seen.strokes[seen.layout.stroke[i]];
    const double unknown = unknown_of(stroke, floor_px) * footprint * footprint;
    const double scatter_px = std::max(q.sigma_px, stroke.rms_px);
    const auto es = eigen_symmetric(q.information[i]);
    const Vector3d values = es.values;
    Vector3d shrink = Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      if (values[k] > 1e-6 * values[2])
        shrink[k] = 1 / (scatter_px * scatter_px + unknown * values[k]);
    const Eigen::Matrix3d& v = es.vectors;
    out.information[i] = v * shrink.cwiseProduct(values.cwiseMax(0)).asDiagonal() * v.transpose();
    out.slope.col(i) = v * shrink.asDiagonal() * v.transpose() * q.slope.col(i);
  }
  return out;
}

SampleQuadratics moved_to(const Samples& to, const Samples& from, const SampleQuadratics& q,
                          double* cost) {
  SampleQuadratics out = q;
  *cost = 0;
  for (size_t i = 0; i < q.information.size(); ++i) {
    const Vector3d d = to.position.col(i) - from.position.col(i);
    out.slope.col(i) += q.information[i] * d;
    *cost += d.dot(q.information[i] * d) + 2 * d.dot(q.slope.col(i));
  }
  return out;
}

}  // namespace sketchsplat

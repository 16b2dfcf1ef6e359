// SPDX-License-Identifier: MIT
#include "sketches/solve/similarity.h"

#include <Eigen/Geometry>

#include "sketches/solve/covariance.h"

namespace sketchsplat {

Similarity Similarity::inverse() const {
  const Eigen::Matrix3d back = rotation.transpose();
  return {1 / scale, back, -(back * translation) / scale};
}

Eigen::Matrix3d rotation_about(const Eigen::Vector3d& angle) {
  const double a = angle.norm();
  if (!(a > 0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(a, angle / a).toRotationMatrix();
}

Sketch moved(const Sketch& sketch, const Similarity& by) {
  Sketch out = sketch;
  for (int i = 0; i < out.nodes.cols(); ++i) out.nodes.col(i) = by * sketch.nodes.col(i);
  const Eigen::Matrix3d turn = by.scale * by.rotation;
  for (const Stroke& s : sketch.strokes)
    for (int h = 0; h < num_handles(s.kind); ++h) {
      const Eigen::Vector3d x = sketch.handles.col(s.handle + h);
      // All but the first handle of a closed curve are vectors.
      out.handles.col(s.handle + h) =
          is_closed(s.kind) && h > 0 ? Eigen::Vector3d(turn * x) : by * x;
    }
  for (Evidence& e : out.evidence) {
    e.sigma *= by.scale;
    if (e.covariance.empty()) continue;
    Eigen::MatrixXd c = from_upper_triangle(e.covariance);
    for (int i = 0; i < c.rows(); i += 3)
      for (int k = 0; k < c.cols(); k += 3)
        c.block<3, 3>(i, k) = (turn * c.block<3, 3>(i, k) * turn.transpose()).eval();
    e.covariance = upper_triangle(c);
  }
  return out;
}

}  // namespace sketchsplat

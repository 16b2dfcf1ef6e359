// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "datasets/types/dense.h"
#include "edges/image/detect.h"

namespace sketchsplat {

/// The parabola of least squares through edgels of a chain, in the frame of one of them: offsets
/// along its normal [px] over places along its edge, in units of `unit_px`.
class EdgelParabola {
 public:
  EdgelParabola(const Edgel& at, double unit_px) : at_(at), unit_px_(unit_px) {}

  /// Along the edge [units], and along the normal [px].
  Eigen::Vector2d place(const Edgel& e) const {
    const double dx = e.x - at_.x, dy = e.y - at_.y;
    return {(-dx * at_.ny + dy * at_.nx) / unit_px_, dx * at_.nx + dy * at_.ny};
  }
  void add(const Edgel& e) {
    const Eigen::Vector2d p = place(e);
    const Eigen::Vector3d basis(1, p.x(), p.x() * p.x());
    normal_ += basis * basis.transpose();
    right_ += basis * p.y();
    ++count_;
  }
  int count() const { return count_; }
  /// Of 1, t and t^2. Three edgels at least, at different places.
  Eigen::Vector3d coefficients() const { return solve_symmetric(normal_, right_); }

 private:
  Edgel at_;
  double unit_px_;
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

}  // namespace sketchsplat

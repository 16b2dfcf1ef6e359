// SPDX-License-Identifier: MIT
#include "raster/splats/splats.h"

namespace sketchsplat {

Splats Splats::zero(int n) {
  Splats s;
  s.mean = s.tangent = Eigen::Matrix3Xd::Zero(3, n);
  s.along = s.across = s.opacity = Eigen::VectorXd::Zero(n);
  return s;
}

}  // namespace sketchsplat

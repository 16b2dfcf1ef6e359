// SPDX-License-Identifier: MIT
// Edges that another detector has found: polylines in pixels, here of a circle of radius 0.5.
#include <sketchsplat/reconstruct.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

int main() {
  std::vector<sketchsplat::InputView> views(12);
  for (int k = 0; k < 12; ++k) {
    sketchsplat::InputView& v = views[k];
    v.width = v.height = 400;
    v.intrinsics << 500, 0, 199.5, 0, 500, 199.5, 0, 0, 1;
    v.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(std::cos(k), std::sin(k), 0));
    v.translation = {0, 0, 3};
    Eigen::Matrix2Xd edge(2, 721);
    for (int i = 0; i <= 720; ++i) {
      const double a = i * M_PI / 360;
      const Eigen::Vector3d p =
          v.intrinsics *
          (v.rotation * Eigen::Vector3d(std::cos(a) / 2, std::sin(a) / 2, 0) + v.translation);
      edge.col(i) = p.hnormalized();
    }
    v.edges.push_back(edge);
  }
  for (const auto& c : sketchsplat::reconstruct(views).curves)
    std::cout << name_of(c.kind) << " of radius " << c.radius << "\n";
}

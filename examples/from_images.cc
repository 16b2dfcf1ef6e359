// SPDX-License-Identifier: MIT
// Images that a program holds already: here a white square in front of ten cameras.
#include <sketchsplat/reconstruct.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

int main() {
  const int size = 240;
  std::vector<std::vector<std::uint8_t>> images(10, std::vector<std::uint8_t>(size * size, 20));
  std::vector<sketchsplat::InputView> views(10);
  for (int k = 0; k < 10; ++k) {
    sketchsplat::InputView& v = views[k];
    v.width = v.height = size, v.channels = 1, v.pixels = images[k].data();
    v.intrinsics << 300, 0, 119.5, 0, 300, 119.5, 0, 0, 1;
    v.rotation = Eigen::AngleAxisd(0.628 * k, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(0.6, Eigen::Vector3d(std::cos(k), std::sin(k), 0));
    v.translation = {0, 0, 3};
    for (int i = 0; i < size * size; ++i) {  // where the ray meets z = 0
      const Eigen::Vector3d pixel(i % size, i / size, 1),
          eye = -v.rotation.transpose() * v.translation;
      const Eigen::Vector3d ray = v.rotation.transpose() * v.intrinsics.inverse() * pixel;
      const Eigen::Vector3d at = eye - eye.z() / ray.z() * ray;
      if (std::abs(at.x()) < 0.5 && std::abs(at.y()) < 0.4) images[k][i] = 220;
    }
  }
  for (const auto& c : sketchsplat::reconstruct(views).curves)
    std::cout << name_of(c.kind) << " of length " << c.length << "\n";
}

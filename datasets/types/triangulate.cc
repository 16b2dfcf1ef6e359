// SPDX-License-Identifier: MIT
#include "datasets/types/triangulate.h"

#include "datasets/types/dense.h"

namespace sketchsplat {

bool triangulate(const std::vector<View>& views, const std::vector<PointSight>& sights,
                 Eigen::Vector3d* point, Eigen::Matrix3d* information) {
  constexpr int kSteps = 5;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const PointSight& sight : sights) {
      const View& view = views[sight.view];
      const Eigen::Vector3d in_cam = view.cam_from_world * *point;
      Eigen::Vector2d ideal;
      if (!(in_cam.z() > 0) || !view.ideal_pixel(sight.pixel, &ideal)) return false;
      const Eigen::Matrix<double, 2, 3> J =
          view.camera.project_jacobian(in_cam) * view.cam_from_world.rotation;
      H += J.transpose() * J;
      g += J.transpose() * (view.camera.project(in_cam) - ideal);
    }
    *point -= solve_symmetric(H, g);
    if (information) *information = H;
  }
  return point->allFinite();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "edges/contrast/window.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace sketchsplat {

using Eigen::Vector2d;
using Eigen::Vector3d;

Window::Window(const Vector3d& normal, const std::vector<Eigen::Matrix3Xd>& curves)
    : normal_(normal.normalized()), middle_(Vector3d::Zero()) {
  Eigen::Index points = 0;
  for (const Eigen::Matrix3Xd& c : curves) middle_ += c.rowwise().sum(), points += c.cols();
  middle_ /= double(std::max<Eigen::Index>(1, points));
  const Vector3d x = normal_.unitOrthogonal();
  frame_ << x.transpose(), normal_.cross(x).transpose();
  for (const Eigen::Matrix3Xd& c : curves)
    for (Eigen::Index i = 0; i + 1 < c.cols(); ++i) {
      const Vector2d a = frame_ * (c.col(i) - middle_), b = frame_ * (c.col(i + 1) - middle_);
      sides_.emplace_back(a.x(), a.y(), b.x(), b.y());
    }
}

Window Window::one_side(const Vector3d& normal, const Vector3d& point) {
  Window out(normal, std::vector<Eigen::Matrix3Xd>());
  out.middle_ = point;
  out.one_side_ = true;
  return out;
}

bool Window::lets_through(const Vector3d& point, const Vector3d& camera) const {
  const double from = normal_.dot(point - middle_), to = normal_.dot(camera - middle_);
  if (one_side_) return to > 0;
  if (!(from * to < 0)) return false;
  const Vector2d at = frame_ * (point + from / (from - to) * (camera - point) - middle_);
  bool inside = false;
  for (const Eigen::Vector4d& s : sides_)
    if ((s[1] > at.y()) != (s[3] > at.y()) &&
        at.x() < s[0] + (at.y() - s[1]) / (s[3] - s[1]) * (s[2] - s[0]))
      inside = !inside;
  return inside;
}

bool any_lets_through(const std::vector<Window>& windows, const Vector3d& point,
                      const Vector3d& camera) {
  return std::any_of(windows.begin(), windows.end(),
                     [&](const Window& w) { return w.lets_through(point, camera); });
}

}  // namespace sketchsplat

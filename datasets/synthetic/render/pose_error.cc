// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/pose_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/render/noise.h"
#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Of what errors consist, in angles; all grow alike. Measured on what COLMAP 3.8 makes of such
// photographs: cameras swing about the object rather than look past it, their focal length and
// distance, and principal point and aim, err together, and a few are worse than most.
constexpr double kAim = 0.3, kSwing = 5, kDistance = 3;  // smooth over the cameras' places
constexpr double kOwn = 0.3, kOwnSpread = 0.6;           // each camera's own, of the aim
constexpr double kFocal = 3, kPrincipal = 4, kRadial = 5, kTangential = 0.5;  // of all alike
constexpr double kReach = 0.9;  // [rad] over which errors are alike

double draw(std::uint64_t seed, int index, int use) { return normal(hash(seed, index, use, 100)); }

Matrix3d rotation(const Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

// A smooth function of a direction with standard deviation 1: random Fourier features (Rahimi and
// Recht, NIPS 2007) of a Gaussian process.
double smooth(const Vector3d& direction, std::uint64_t seed, int channel) {
  constexpr int kWaves = 12;
  double sum = 0;
  for (int j = 0; j < kWaves; ++j) {
    const int use = 1000 + 10 * (channel * kWaves + j);
    const Vector3d wave(draw(seed, 0, use), draw(seed, 0, use + 1), draw(seed, 0, use + 2));
    const double phase = 2 * M_PI * uniform(hash(seed, 0, use + 3, 100));
    sum += std::cos(wave.dot(direction) / kReach + phase);
  }
  return sum * std::sqrt(2.0 / kWaves);
}

// Intrinsics that err by `angle`, and the pose that makes up for it at the distance `middle`.
void disturb_intrinsics(double angle, const Vector3d& middle, std::uint64_t seed, View* view) {
  Camera& camera = view->camera;
  const double focal = 1 + kFocal * angle * draw(seed, 0, 0);
  const Vector2d shift = kPrincipal * angle * Vector2d(draw(seed, 0, 1), draw(seed, 0, 2));
  Pose& pose = view->cam_from_world;
  pose.translation.z() += (pose * middle).z() * (focal - 1);
  const Matrix3d turn = rotation({shift.y(), -shift.x(), 0});
  pose.rotation = turn * pose.rotation;
  pose.translation = turn * pose.translation;
  camera.cx += shift.x() * camera.fx;
  camera.cy += shift.y() * camera.fy;
  camera.fx *= focal;
  camera.fy *= focal;
  if (view->lens.is_identity()) return;
  Lens::Terms terms = view->lens.terms();
  terms.k1 += kRadial * angle * draw(seed, 0, 3);
  terms.k2 += kRadial * angle * draw(seed, 0, 4);
  terms.p1 += kTangential * angle * draw(seed, 0, 5);
  terms.p2 += kTangential * angle * draw(seed, 0, 6);
  view->lens = Lens(view->lens.model(), terms);
}

View disturbed(const View& view, double angle, const Vector3d& middle, std::uint64_t seed,
               int index) {
  View out = view;
  disturb_intrinsics(angle, middle, seed, &out);
  const Vector3d place = (view.center_in_world() - middle).normalized();
  const double own = kOwn * std::exp(kOwnSpread * draw(seed, index, 10));
  // About the axes of the world: those of neighbouring cameras may differ.
  Vector3d aim, swing;
  for (int c = 0; c < 3; ++c) {
    aim[c] = angle * (kAim * smooth(place, seed, c) + own * draw(seed, index, 20 + c));
    swing[c] = angle * kSwing * smooth(place, seed, 3 + c);
  }
  Pose& pose = out.cam_from_world;
  const Matrix3d about_object = rotation(swing);
  const Vector3d centre = middle + about_object * (out.center_in_world() - middle) *
                                       (1 + angle * kDistance * smooth(place, seed, 6));
  pose.rotation = pose.rotation * about_object.transpose() * rotation(aim);
  pose.translation = -(pose.rotation * centre);
  return out;
}

// Every so many points are enough for sums over views.
int stride(const Eigen::Matrix3Xd& points) { return std::max<int>(1, int(points.cols() / 300)); }

template <typename Use>
void for_each_shift(const std::vector<View>& a, const std::vector<View>& b,
                    const Eigen::Matrix3Xd& points, const Use& use) {
  for (size_t k = 0; k < a.size(); ++k)
    for (int i = 0; i < points.cols(); i += stride(points)) {
      double near, far;
      Vector2d p, q;
      if (a[k].image_pixel(a[k].project(points.col(i), &near), &p) && near > 0 &&
          b[k].image_pixel(b[k].project(points.col(i), &far), &q) && far > 0)
        use(b[k], points.col(i), Vector2d(q - p));
    }
}

// Moves the world of `err` by the similarity about `middle` that brings the points nearest to where
// `views` see them: one step of Gauss and Newton of x' = x + m + w x (x - middle) + s (x - middle).
void undo_similarity(const std::vector<View>& views, const Eigen::Matrix3Xd& points,
                     const Vector3d& middle, std::vector<View>* err) {
  Eigen::Matrix<double, 7, 7> H = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> g = Eigen::Matrix<double, 7, 1>::Zero();
  for_each_shift(views, *err, points, [&](const View& b, const Vector3d& x, const Vector2d& shift) {
    const Vector3d d = x - middle;
    Eigen::Matrix<double, 3, 7> world;
    world << Matrix3d::Identity(), Matrix3d::Zero(), d;
    world.block<3, 3>(0, 3) << 0, d.z(), -d.y(), -d.z(), 0, d.x(), d.y(), -d.x(), 0;  // w x d
    const Eigen::Matrix<double, 2, 7> J =
        b.camera.project_jacobian(b.cam_from_world * x) * b.cam_from_world.rotation * world;
    H += J.transpose() * J;
    g += J.transpose() * shift;
  });
  const Eigen::Matrix<double, 7, 1> step = -solve_symmetric(H, g);
  const Matrix3d R = rotation(step.segment<3>(3));
  const double scale = 1 + step[6];
  for (View& view : *err) {
    // The camera sees the moved world: x_cam = P (scale R (x - middle) + middle + m), up to scale.
    Pose& pose = view.cam_from_world;
    const Vector3d t = pose * (middle + step.head<3>());
    pose.rotation = pose.rotation * R;
    pose.translation = t / scale - pose.rotation * middle;
  }
}

}  // namespace

double rms_shift(const std::vector<View>& a, const std::vector<View>& b,
                 const Eigen::Matrix3Xd& points) {
  double sum = 0;
  int count = 0;
  for_each_shift(a, b, points, [&](const View&, const Vector3d&, const Vector2d& shift) {
    sum += shift.squaredNorm();
    ++count;
  });
  return count > 0 ? std::sqrt(sum / count) : 0;
}

std::vector<View> with_pose_error(const std::vector<View>& views, const Eigen::Matrix3Xd& points,
                                  double px, std::uint64_t seed) {
  if (!(px > 0) || views.empty() || points.cols() == 0) return views;
  const Vector3d middle = points.rowwise().mean();
  double angle = px / views[0].camera.fx;
  std::vector<View> out;
  for (int round = 0; round < 5; ++round) {
    out.clear();
    for (size_t k = 0; k < views.size(); ++k)
      out.push_back(disturbed(views[k], angle, middle, seed, int(k)));
    for (int step = 0; step < 3; ++step) undo_similarity(views, points, middle, &out);
    const double rms = rms_shift(views, out, points);
    if (!(rms > 0)) break;
    angle *= px / rms;
  }
  return out;
}

}  // namespace sketchsplat

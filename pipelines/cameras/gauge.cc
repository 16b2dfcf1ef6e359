// SPDX-License-Identifier: MIT
#include "pipelines/cameras/gauge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Gauge = Eigen::Matrix<double, 7, 1>;  // shift, turn and growth about the middle
using Rows = Eigen::Matrix<double, 3, 7>;

constexpr int kFewestViews = 6, kFewestPoints = 20;
constexpr double kLeastParallax = 1e-6;  // of lines of sight that meet: squared sine, about
constexpr double kFreedom = 5;           // of Student's distribution
constexpr double kLeastPx = 0.02;        // poses err at least by this
constexpr int kRounds = 3, kSteps = 20;

// How far a stated pose is off [px], and what of this a small gauge makes.
struct PoseError {
  Vector3d turn, shift;  // of the object about its middle, and of this; along x, y, z of the camera
  Rows turn_by, shift_by;
  Matrix3d lever;  // the shift that a turn of the camera about itself makes
};

PoseError error_of(const View& found, const View& stated, const Vector3d& middle,
                   double radius_px) {
  const Pose &from = found.cam_from_world, &to = stated.cam_from_world;
  const Vector3d at = from * middle;
  const double px = std::sqrt(found.camera.fx * found.camera.fy) / at.z();
  const Vector3d units(px, px, radius_px / at.z());
  const Eigen::AngleAxisd turn(Matrix3d(to.rotation * from.rotation.transpose()));
  PoseError out;
  out.turn = radius_px * turn.angle() * turn.axis();
  out.shift = units.asDiagonal() * (to * middle - at);
  out.turn_by.setZero(), out.shift_by.setZero();
  out.turn_by.middleCols<3>(3) = -radius_px * from.rotation;
  out.shift_by.leftCols<3>() = -(units.asDiagonal() * from.rotation);
  out.shift_by.col(6) = units.asDiagonal() * at;
  for (int k = 0; k < 3; ++k)
    out.lever.col(k) = units.asDiagonal() * Vector3d::Unit(k).cross(at) / radius_px;
  return out;
}

// Of the errors: standard deviations [px], and how far shifts follow turns.
struct Scatter {
  double turn = 1, across = 1, along = 1, follow = 0;

  Vector3d shift() const { return {across, across, along}; }
};

// Errors with what a gauge makes of them taken away.
std::vector<PoseError> without(std::vector<PoseError> errors, const Gauge& gauge) {
  for (PoseError& e : errors) e.turn -= e.turn_by * gauge, e.shift -= e.shift_by * gauge;
  return errors;
}

Scatter scatter_of(const std::vector<PoseError>& errors, const std::vector<double>& weight) {
  double both = 0, turns = 0, square = 0;
  for (size_t v = 0; v < errors.size(); ++v) {
    const Eigen::Vector2d by = (errors[v].lever * errors[v].turn).head<2>();
    both += weight[v] * by.dot(errors[v].shift.head<2>());
    turns += weight[v] * by.squaredNorm();
    square += weight[v] * errors[v].turn.squaredNorm();
  }
  Scatter out;
  out.follow = turns > 0 ? both / turns : 0;
  double across = 0, along = 0;
  for (size_t v = 0; v < errors.size(); ++v) {
    const Vector3d own = errors[v].shift - out.follow * errors[v].lever * errors[v].turn;
    across += weight[v] * own.head<2>().squaredNorm();
    along += weight[v] * own.z() * own.z();
  }
  const double n = double(errors.size());
  out.turn = std::max(kLeastPx, std::sqrt(square / (3 * n)));
  out.across = std::max(kLeastPx, std::sqrt(across / (2 * n)));
  out.along = std::max(kLeastPx, std::sqrt(along / n));
  return out;
}

// The errors of a view in standard deviations that are independent of one another.
Eigen::Matrix<double, 6, 1> whitened(const PoseError& e, const Scatter& s) {
  Eigen::Matrix<double, 6, 1> out;
  out << e.turn / s.turn, (e.shift - s.follow * e.lever * e.turn).cwiseQuotient(s.shift());
  return out;
}

Gauge solve(const std::vector<PoseError>& errors, const std::vector<double>& weight,
            const Scatter& s) {
  Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
  Gauge right = Gauge::Zero();
  for (size_t v = 0; v < errors.size(); ++v) {
    const PoseError& e = errors[v];
    Eigen::Matrix<double, 6, 7> by;
    by << e.turn_by / s.turn,
        s.shift().cwiseInverse().asDiagonal() * (e.shift_by - s.follow * e.lever * e.turn_by);
    normal += weight[v] * by.transpose() * by;
    right += weight[v] * by.transpose() * whitened(e, s);
  }
  return solve_symmetric(normal, right);
}

Gauge likeliest(const std::vector<PoseError>& errors) {
  std::vector<double> weight(errors.size(), 1);
  Scatter scatter;
  Gauge gauge = Gauge::Zero();
  for (int step = 0; step < kSteps; ++step) {
    gauge = solve(errors, weight, scatter);
    const std::vector<PoseError> left = without(errors, gauge);
    for (size_t v = 0; step > 0 && v < left.size(); ++v)
      weight[v] = (kFreedom + 6) / (kFreedom + whitened(left[v], scatter).squaredNorm());
    scatter = scatter_of(left, weight);
  }
  return gauge;
}

Similarity about(const Vector3d& middle, const Gauge& gauge) {
  Similarity out;
  out.scale = 1 + gauge[6];
  out.rotation = rotation_about(gauge.segment<3>(3));
  out.translation = middle + gauge.head<3>() - out.scale * (out.rotation * middle);
  return out;
}

}  // namespace

View moved(View view, const Similarity& to) {
  Pose& pose = view.cam_from_world;
  pose.rotation = (pose.rotation * to.rotation.transpose()).eval();
  pose.translation = to.scale * pose.translation - pose.rotation * to.translation;
  return view;
}

Similarity likeliest_gauge(const std::vector<View>& found, const std::vector<View>& stated,
                           const Vector3d& middle, const std::vector<double>& radius_px) {
  Similarity out;
  if (int(found.size()) < kFewestViews) return out;
  for (int round = 0; round < kRounds; ++round) {  // each is linear
    std::vector<PoseError> errors;
    for (size_t v = 0; v < found.size(); ++v) {
      const View now = moved(found[v], out);
      if ((now.cam_from_world * (out * middle)).z() > 0)
        errors.push_back(error_of(now, stated[v], out * middle, radius_px[v]));
    }
    if (int(errors.size()) < kFewestViews) return out;
    out = about(out * middle, likeliest(errors)) * out;
  }
  return out;
}

namespace {

// A point as stated and as cameras see it, and how well these tell where [1/px^2].
struct PlacedPoint {
  Vector3d stated, found;
  Matrix3d information;
};

// False if the views do not tell one.
bool place(const std::vector<View>& views, const ScenePoint& point, PlacedPoint* out) {
  out->stated = out->found = point.position;
  if (!triangulate(views, point.sights, &out->found, &out->information)) return false;
  const auto parts = eigen_symmetric(out->information);
  return parts.values[0] > kLeastParallax * parts.values[2];
}

// From where cameras see points to where they are stated, about their middle.
Gauge gauge_between(const std::vector<PlacedPoint>& points, const Vector3d& middle) {
  std::vector<double> weight(points.size(), 1);
  Gauge gauge = Gauge::Zero();
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
    Gauge right = Gauge::Zero();
    std::vector<Rows> by(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const PlacedPoint& p = points[i];
      const Vector3d arm = p.found - middle;
      by[i].leftCols<3>().setIdentity();
      for (int k = 0; k < 3; ++k) by[i].col(3 + k) = Vector3d::Unit(k).cross(arm);
      by[i].col(6) = arm;
      const Eigen::Matrix<double, 7, 3> back = weight[i] * by[i].transpose() * p.information;
      normal += back * by[i];
      right += back * (p.stated - p.found);
    }
    gauge = solve_symmetric(normal, right);
    double sum = 0;
    std::vector<double> square;
    for (size_t i = 0; i < points.size(); ++i) {
      const Vector3d left = points[i].stated - points[i].found - by[i] * gauge;
      square.push_back(left.dot(points[i].information * left));
      sum += weight[i] * square[i];
    }
    const double variance = std::max(kLeastPx * kLeastPx, sum / (3 * double(points.size())));
    for (size_t i = 0; i < points.size(); ++i)
      weight[i] = (kFreedom + 3) / (kFreedom + square[i] / variance);
  }
  return gauge;
}

}  // namespace

Similarity gauge_of_points(const std::vector<View>& found, const std::vector<ScenePoint>& points) {
  Similarity out;
  std::vector<PlacedPoint> placed;
  Vector3d middle = Vector3d::Zero();
  for (const ScenePoint& point : points) {
    PlacedPoint p;
    if (!place(found, point, &p)) continue;
    placed.push_back(p);
    middle += p.stated;
  }
  if (int(placed.size()) < kFewestPoints) return out;
  middle /= double(placed.size());
  for (int round = 0; round < kRounds; ++round) {
    std::vector<PlacedPoint> now = placed;
    for (PlacedPoint& p : now) p.found = out * p.found;
    out = about(middle, gauge_between(now, middle)) * out;
  }
  return out;
}

}  // namespace sketchsplat

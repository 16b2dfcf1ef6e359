// SPDX-License-Identifier: MIT
#include "pipelines/cameras/camera_unknowns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/readers/colmap_write.h"
#include "datasets/types/median.h"

namespace sketchsplat {
namespace {

using Terms = Lens::Terms;

constexpr double kLeastRadius = 8;  // [px] of the object's image

double Terms::*const kTerms[] = {&Terms::k1, &Terms::k2, &Terms::p1, &Terms::p2,
                                 &Terms::k3, &Terms::k4, &Terms::k5, &Terms::k6};

/// Terms that a model has: the first so many of COLMAP's order.
std::vector<int> terms_of(LensModel model) {
  switch (model) {
    case LensModel::kPinhole:
      return {};
    case LensModel::kSimpleRadial:
      return {0};
    case LensModel::kRadial:
      return {0, 1};
    case LensModel::kOpencv:
      return {0, 1, 2, 3};
    case LensModel::kFullOpencv:
      return {0, 1, 2, 3, 4, 5, 6, 7};
    case LensModel::kOpencvFisheye:
      return {0, 1, 4, 5};
  }
  return {};
}

/// Power of the radius by which a term moves a point.
int power_of(LensModel model, int term) {
  constexpr int kPlain[] = {3, 5, 2, 2, 7, 3, 5, 7}, kFisheye[] = {3, 5, 0, 0, 7, 9, 0, 0};
  return model == LensModel::kOpencvFisheye ? kFisheye[term] : kPlain[term];
}

Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (!(angle > 0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

std::vector<double> image_radii(const Observation& o, const EdgeWorld& world,
                                const Eigen::Vector3d& middle) {
  std::vector<double> sum(world.views.size()), count(world.views.size()), radius, known;
  for (const SampleMatch& m : o.matches.matches) {
    double depth;
    const View& view = world.views[m.view];
    sum[m.view] +=
        (view.project(o.samples.position.col(m.sample), &depth) - view.project(middle, &depth))
            .squaredNorm();
    ++count[m.view];
  }
  for (size_t v = 0; v < sum.size(); ++v) {
    radius.push_back(count[v] > 0 ? std::max(kLeastRadius, std::sqrt(sum[v] / count[v])) : 0);
    if (count[v] > 0) known.push_back(radius[v]);
  }
  const double usual = std::max(kLeastRadius, median(known));
  for (double& r : radius)
    if (!(r > 0)) r = usual;
  return radius;
}

CameraUnknowns::CameraUnknowns(const std::vector<View>& stated, const Eigen::Vector3d& middle,
                               const std::vector<double>& radius_px, const CameraPrior& prior)
    : stated_(stated), middle_(middle), camera_(shared_cameras(stated)) {
  const int n = int(stated.size());
  const int cameras = n ? *std::max_element(camera_.begin(), camera_.end()) + 1 : 0;
  const int most = kPose * n + kMostShared * cameras;
  unit_.resize(most), information_.resize(most);
  for (int v = 0; v < n; ++v) {
    const Camera& c = stated[v].camera;
    const double depth = std::abs((stated[v].cam_from_world * middle).z());
    const double turn = 1 / radius_px[v], shift = depth / std::sqrt(c.fx * c.fy);
    unit_.segment<kPose>(kPose * v) << turn, turn, turn, shift, shift, depth * turn;
    information_.segment<kPose>(kPose * v).setConstant(1 / (prior.pose_px * prior.pose_px));
    intrinsic_.insert(intrinsic_.end(), kPose, -1);
  }
  for (int camera = 0; camera < cameras; ++camera) {
    first_.push_back(int(intrinsic_.size()));
    const int v = int(std::find(camera_.begin(), camera_.end(), camera) - camera_.begin());
    list_shared(stated[v], radius_px[v], prior);
  }
  first_.push_back(int(intrinsic_.size()));
  unit_.conservativeResize(first_.back()), information_.conservativeResize(first_.back());
  value_ = Eigen::VectorXd::Zero(first_.back());
  views_ = stated_;
}

void CameraUnknowns::list_shared(const View& view, double radius_px, const CameraPrior& prior) {
  if (!prior.shared) return;
  const Camera& c = view.camera;
  const auto add = [&](int intrinsic, double unit, double sigma_px) {
    unit_[Eigen::Index(intrinsic_.size())] = unit;
    information_[Eigen::Index(intrinsic_.size())] = 1 / (sigma_px * sigma_px);
    intrinsic_.push_back(intrinsic);
  };
  const double centre_px = prior.centre * std::max(c.width, c.height);
  add(kFocal, 1 / radius_px, prior.focal * radius_px);
  if (c.fx != c.fy) add(kAspect, 1 / radius_px, 0.1 * prior.focal * radius_px);
  add(kCentreX, 1, centre_px);
  add(kCentreY, 1, centre_px);
  Eigen::Vector2d corner;
  if (!view.lens.undistort(c.ray({0, 0}).head<2>(), &corner)) corner = c.ray({0, 0}).head<2>();
  const double radius = corner.norm();
  for (const int term : terms_of(view.lens.model()))
    add(kTerm + term, 1 / (c.fx * std::pow(radius, power_of(view.lens.model(), term))),
        prior.lens_px);
}

void CameraUnknowns::set(const Eigen::VectorXd& value) {
  value_ = value;
  const Eigen::VectorXd in_units = value.cwiseProduct(unit_);
  for (int v = 0; v < views(); ++v) {
    View& view = views_[v];
    const Pose& from = stated_[v].cam_from_world;
    const Eigen::Vector3d turn = in_units.segment<3>(kPose * v);
    Pose& pose = view.cam_from_world;
    pose.rotation = rotation_by(turn) * from.rotation;
    pose.translation =
        from * middle_ + in_units.segment<3>(kPose * v + 3) - pose.rotation * middle_;
    view.camera = stated_[v].camera;
    Camera& c = view.camera;
    Terms terms = stated_[v].lens.terms();
    const int k = camera_[v];
    for (int i = first_[k]; i < first_[k + 1]; ++i) {
      const int what = intrinsic_[i];
      const double by = in_units[i];
      if (what == kFocal || what == kAspect) {
        c.fx += by * stated_[v].camera.fx;
        c.fy += (what == kFocal ? by : -by) * stated_[v].camera.fy;
      } else if (what == kCentreX) {
        c.cx += by;
      } else if (what == kCentreY) {
        c.cy += by;
      } else {
        terms.*kTerms[what - kTerm] += by;
      }
    }
    if (!terms_of(view.lens.model()).empty()) view.lens = Lens(view.lens.model(), terms);
  }
}

Eigen::VectorXd CameraUnknowns::values_of(const std::vector<View>& views) const {
  Eigen::VectorXd in_units = Eigen::VectorXd::Zero(size());
  for (int v = 0; v < int(views.size()); ++v) {
    const Pose &from = stated_[v].cam_from_world, &to = views[v].cam_from_world;
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.rotation * from.rotation.transpose()));
    in_units.segment<3>(kPose * v) = turn.angle() * turn.axis();
    in_units.segment<3>(kPose * v + 3) = to * middle_ - from * middle_;
    const Camera &a = stated_[v].camera, &b = views[v].camera;
    const double x = b.fx / a.fx - 1, y = b.fy / a.fy - 1;
    const int k = camera_[v];
    for (int i = first_[k]; i < first_[k + 1]; ++i) {
      const int what = intrinsic_[i];
      in_units[i] = what == kFocal     ? 0.5 * (x + y)
                    : what == kAspect  ? 0.5 * (x - y)
                    : what == kCentreX ? b.cx - a.cx
                    : what == kCentreY ? b.cy - a.cy
                                       : views[v].lens.terms().*kTerms[what - kTerm] -
                                             stated_[v].lens.terms().*kTerms[what - kTerm];
    }
  }
  return in_units.cwiseQuotient(unit_);
}

bool CameraUnknowns::image(int v, const Eigen::Vector3d& point, Eigen::Vector2d* pixel,
                           Derivatives* out) const {
  const View& view = views_[v];
  const Camera& c = view.camera;
  const Eigen::Vector3d x = view.cam_from_world * point;
  if (!(x.z() > 0)) return false;
  const Eigen::Vector2d xy = x.head<2>() / x.z();
  if (!view.lens.draws(xy)) return false;
  const Eigen::Vector2d drawn = view.lens.distort(xy);
  *pixel = c.project({drawn.x(), drawn.y(), 1});
  if (!out) return true;
  const Eigen::Vector2d focal(c.fx, c.fy), stated(stated_[v].camera.fx, stated_[v].camera.fy);
  Eigen::Matrix<double, 2, 3> by_cam;
  by_cam << 1, 0, -xy.x(), 0, 1, -xy.y();
  by_cam = focal.asDiagonal() * view.lens.jacobian(xy) * by_cam / x.z();
  out->point = by_cam * view.cam_from_world.rotation;
  // The value counts from the stated pose; a small turn on top of it is nearly the sum.
  const Eigen::Vector3d arm = view.cam_from_world.rotation * (point - middle_);
  out->pose.leftCols<3>() = -by_cam * cross_matrix(arm);
  out->pose.rightCols<3>() = by_cam;
  out->pose *= unit_.segment<kPose>(kPose * v).asDiagonal();
  out->shared.setZero();
  const int k = camera_[v];
  Eigen::Matrix<double, 2, 8> terms;
  if (num_shared(k) > 0 && intrinsic_[first_[k + 1] - 1] >= kTerm)
    terms = focal.asDiagonal() * view.lens.terms_jacobian(xy);
  for (int i = first_[k]; i < first_[k + 1]; ++i) {
    auto column = out->shared.col(i - first_[k]);
    const int what = intrinsic_[i];
    if (what == kFocal)
      column = stated.cwiseProduct(drawn);
    else if (what == kAspect)
      column << stated.x() * drawn.x(), -stated.y() * drawn.y();
    else if (what == kCentreX)
      column << 1, 0;
    else if (what == kCentreY)
      column << 0, 1;
    else
      column = terms.col(what - kTerm);
    column *= unit_[i];
  }
  return true;
}

}  // namespace sketchsplat

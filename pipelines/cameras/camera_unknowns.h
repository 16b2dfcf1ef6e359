// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/types/view.h"
#include "pipelines/survey/observe.h"

namespace sketchsplat {

/// How far off stated cameras may be: standard deviations.
struct CameraPrior {
  double pose_px = 1;     ///< by which each of six ways to move a view shifts the object's image
  double focal = 0.01;    ///< relative; a tenth of it for the ratio of fx and fy where they differ
  double centre = 0.004;  ///< of the principal point, in image widths
  double lens_px = 2;     ///< by which a term of the distortion moves the corner of the image
  bool shared = true;     ///< false: focal length, centre and lens are as stated
};

/// [px] Root mean square distance of the matched samples' images from that of the middle of the
/// object (world), in each view; the median of the others in views without a match.
std::vector<double> image_radii(const Observation& observation, const EdgeWorld& world,
                                const Eigen::Vector3d& middle);

/// Cameras as unknowns of least squares: six per view about a point of the object, and of each
/// shared camera what its lens has. All of them are measured in pixels by which they move the
/// object's image, or its corners, so that they compare.
class CameraUnknowns {
 public:
  /// `middle`: of the object, in the world; `radius_px`: of its image in each view.
  CameraUnknowns(const std::vector<View>& stated, const Eigen::Vector3d& middle,
                 const std::vector<double>& radius_px, const CameraPrior& prior);

  static constexpr int kPose = 6, kMostShared = 12;
  int size() const { return int(value_.size()); }
  int views() const { return int(views_.size()); }
  int cameras() const { return int(first_.size()) - 1; }
  int pose_column(int view) const { return kPose * view; }
  int camera_of(int view) const { return camera_[view]; }
  int shared_column(int camera) const { return first_[camera]; }
  int num_shared(int camera) const { return first_[camera + 1] - first_[camera]; }

  /// The cameras of these values; `value` counts from the stated ones.
  const std::vector<View>& current() const { return views_; }
  const Eigen::VectorXd& value() const { return value_; }
  void set(const Eigen::VectorXd& value);
  /// The values that make these cameras, which differ from the stated ones in nothing else.
  Eigen::VectorXd values_of(const std::vector<View>& views) const;

  /// Inverse variance of each unknown.
  const Eigen::VectorXd& information() const { return information_; }

  /// Where the image shows a point of the world; with the derivatives by the point, by the pose of
  /// the view and by what its camera shares (num_shared columns). False if it does not.
  struct Derivatives {
    Eigen::Matrix<double, 2, 3> point;
    Eigen::Matrix<double, 2, kPose> pose;
    Eigen::Matrix<double, 2, kMostShared> shared;
  };
  bool image(int view, const Eigen::Vector3d& point, Eigen::Vector2d* pixel,
             Derivatives* derivatives = nullptr) const;

 private:
  enum Intrinsic { kFocal, kAspect, kCentreX, kCentreY, kTerm };  // and the other seven terms
  void list_shared(const View& view, double radius_px, const CameraPrior& prior);

  std::vector<View> stated_, views_;
  Eigen::Vector3d middle_;
  std::vector<int> camera_, first_;
  std::vector<int> intrinsic_;  // of each column; -1: pose
  Eigen::VectorXd value_, unit_, information_;
};

}  // namespace sketchsplat

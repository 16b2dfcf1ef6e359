// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/cameras/camera_fit.h"
#include "pipelines/cameras/camera_unknowns.h"
#include "pipelines/cameras/eliminate.h"
#include "pipelines/cameras/point_prior.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {

/// The least squares of fit_cameras and camera_evidence, whose comments say what is summed. All
/// arguments must outlive it.
class CameraSystem {
 public:
  CameraSystem(const Sketch& sketch, const Observation& o, const EdgeWorld& world,
               const StatedCameras& stated, const CameraPrior& prior,
               const CameraFitOptions& options);

  void solve();
  CameraFit result(const Sketch& joined);
  CameraEvidence evidence();

 private:
  // One edgel that a stroke was matched with.
  struct Row {
    int stroke, sample, view;
    Eigen::Vector2d edgel, normal;  // in the image
    double match, weight;           // biweight of the match; what the edgel counts
    int offset;                     // index of the pair (stroke, view)
  };

  struct Linear {
    double distance = 0;
    StrokeVector stroke = StrokeVector::Zero();
    Eigen::Matrix<double, CameraUnknowns::kPose, 1> pose =
        Eigen::Matrix<double, CameraUnknowns::kPose, 1>::Zero();
    Eigen::Matrix<double, CameraUnknowns::kMostShared, 1> shared =
        Eigen::Matrix<double, CameraUnknowns::kMostShared, 1>::Zero();
  };

  struct State {
    std::vector<ControlPoints> strokes;
    Eigen::VectorXd cameras;
  };

  // Which rows count: all, those of every other stroke, or those of every other view of a camera.
  struct Part {
    enum By { kAll, kStrokes, kViews } by;
    int half;
  };

  void list_rows(const Observation& o, const EdgeWorld& world);
  void weigh();
  std::vector<double> sigma_of_strokes(const std::vector<double>& offsets) const;
  void place(const State& state);
  double distance(const Row& row, Linear* linear, const PointJacobian* moves = nullptr) const;
  double cost() const;
  void linearise(std::vector<Linear>* rows) const;
  bool counts(const Row& row, const Part& part) const;
  void assemble(const std::vector<Linear>& rows, double damping,
                const Part& part = {Part::kAll, 0});
  State step() const;
  double offset_px() const;
  double scale_sigma() const;
  std::vector<double> distances() const;

  const CameraFitOptions options_;
  const SampleLayout& layout_;
  std::vector<StrokeKind> kinds_;
  Eigen::Vector3d middle_;
  std::vector<double> radius_;
  CameraUnknowns cameras_;
  CameraQuadratic prior_;
  State now_;
  std::vector<Eigen::Vector3d> points_, tangents_;  // of the samples
  std::vector<Row> rows_;
  std::vector<int> of_stroke_;  // rows of stroke s: of_stroke_[s] .. of_stroke_[s + 1] - 1
  std::vector<std::vector<int>> of_view_;
  std::vector<int> rank_;  // of a view, among those of its camera
  int offsets_ = 0;
  double scatter_ = 0, offset_sigma_ = 0, before_ = 0;
  std::vector<StrokeNormal> normals_;
  Eigen::MatrixXd hessian_;  // of the cameras alone, strokes eliminated
  Eigen::VectorXd gradient_;
};

}  // namespace sketchsplat

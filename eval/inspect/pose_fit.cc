// SPDX-License-Identifier: MIT
#include "eval/inspect/pose_fit.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSpacing = 1.0 / 150;  // [extents]
constexpr int kLeast = 8;               // samples a stroke
const double kSameWay = std::cos(25 * M_PI / 180);
constexpr double kTukey = 4.685;

Vector3d across(const Vector3d& gap, const Vector3d& tangent) {
  return gap - tangent * tangent.dot(gap);
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

PoseFit::PoseFit(const Nominal& nominal, double reach)
    : nominal_(nominal),
      samples_(sample_edges(nominal.sketch, kSpacing * nominal.extent, kLeast)),
      grid_(samples_, reach),
      centre_((samples_.position.rowwise().minCoeff() + samples_.position.rowwise().maxCoeff()) /
              2),
      lever_(nominal.extent / 2) {}

std::vector<PosePlace> PoseFit::places(const EdgeSamples& samples, const Similarity& pose,
                                       double reach, bool exact, int every) const {
  std::vector<PosePlace> out;
  for (int i = every / 2; i < samples.size(); i += every) {
    PosePlace p;
    p.measured = pose * samples.position.col(i);
    const int near =
        grid_.nearest(p.measured, pose.rotation * samples.tangent.col(i), reach, kSameWay);
    if (near < 0) continue;
    const int stroke = samples_.stroke[near];
    Vector3d at = samples_.position.col(near);
    p.tangent = samples_.tangent.col(near);
    if (exact) {
      const ClosestPoint c = distance_to_stroke(nominal_.sketch, stroke, p.measured);
      Vector3d d;
      evaluate_stroke(nominal_.sketch, stroke, c.t, &at, &d);
      p.tangent = d.stableNormalized();
    }
    p.gap = across(p.measured - at, p.tangent);
    p.sample = i;
    p.edge = nominal_.edge_of_stroke[stroke];
    p.weight = samples.length[i];
    out.push_back(p);
  }
  return out;
}

Eigen::Matrix<double, 3, 7> PoseFit::jacobian(const Vector3d& measured) const {
  const Vector3d arm = (measured - centre_) / lever_;
  Eigen::Matrix<double, 3, 7> j;
  j << -cross_matrix(arm), Matrix3d::Identity(), arm;
  return j;
}

void PoseFit::add(const PosePlace& place, const Matrix3d& across, PoseSystem* system) const {
  const Eigen::Matrix<double, 3, 7> j = across * jacobian(place.measured);
  system->information += place.weight * j.transpose() * j;
  system->slope += place.weight * j.transpose() * (across * place.gap);
  system->weight += place.weight;
}

Similarity PoseFit::after(const Similarity& pose, const Eigen::Matrix<double, 7, 1>& move) const {
  Similarity step;
  step.scale = std::exp(move[6] / lever_);
  step.rotation = rotation_about(move.head<3>() / lever_);
  step.translation = centre_ + move.segment<3>(3) - step.scale * (step.rotation * centre_);
  Similarity out = step * pose;
  out.rotation = nearest_rotation(out.rotation);
  return out;
}

double robust_scale(const std::vector<PosePlace>& places) {
  std::vector<std::pair<double, double>> gaps;
  double total = 0, below = 0;
  for (const PosePlace& p : places) gaps.push_back({p.gap.norm(), p.weight}), total += p.weight;
  std::sort(gaps.begin(), gaps.end());
  // Of two normal components, the median of the length is 1.1774 standard deviations.
  for (const auto& [gap, weight] : gaps)
    if ((below += weight) >= total / 2) return gap / 1.1774;
  return 0;
}

void weigh_down(double scale, std::vector<PosePlace>* places) {
  const double most = kTukey * scale;
  for (PosePlace& p : *places) {
    const double u2 = most > 0 ? p.gap.squaredNorm() / (most * most) : 0;
    p.weight *= u2 < 1 ? (1 - u2) * (1 - u2) : 0;
  }
}

Eigen::Matrix<double, 7, 1> solve(const PoseSystem& system, const Eigen::MatrixXd& basis,
                                  double least, Eigen::MatrixXd* left) {
  const Eigen::MatrixXd information = basis.transpose() * system.information * basis;
  const auto es = eigen_symmetric(information);
  const Eigen::VectorXd slope = basis.transpose() * system.slope;
  Eigen::VectorXd move = Eigen::VectorXd::Zero(basis.cols());
  int open = 0;  // eigenvalues ascend
  for (int k = 0; k < basis.cols(); ++k) {
    const auto v = es.vectors.col(k);
    if (es.values[k] > least * system.weight)
      move -= v * v.dot(slope) / es.values[k];
    else
      open = k + 1;
  }
  const Eigen::Matrix<double, 7, 1> out = basis * move;
  if (left) *left = (basis * es.vectors.leftCols(open)).eval();  // may be the basis
  return out;
}

}  // namespace sketchsplat

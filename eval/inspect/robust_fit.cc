// SPDX-License-Identifier: MIT
#include "eval/inspect/robust_fit.h"

#include <algorithm>

#include "datasets/types/median.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {

using Eigen::Matrix3d;
using Eigen::MatrixXd;

namespace {

double typical_sigma(const Sketch& measured) {
  std::vector<double> sigmas;
  for (const Evidence& e : measured.evidence) sigmas.push_back(e.sigma);
  return median(std::move(sigmas));
}

}  // namespace

RobustFit::RobustFit(const Sketch& measured, const Nominal& nominal, const AlignOptions& options,
                     double reach)
    : measured_(measured),
      nominal_(nominal),
      options_(options),
      fit_(nominal, reach * nominal.extent),
      extent_(largest_extent(measured)),
      typical_sigma_(typical_sigma(measured)),
      samples_(sample_edges(measured, extent_ / 150, 8)),
      basis_(MatrixXd::Identity(7, options.fit_scale ? 7 : 6)) {}

int RobustFit::every(int samples) const { return std::max(1, samples_.size() / samples); }

std::vector<PosePlace> RobustFit::near_places(const Similarity& pose, int every) const {
  return fit_.places(samples_, pose, options_.reach * nominal_.extent, true, every);
}

std::vector<PosePlace> RobustFit::weighed_places(const Similarity& pose, int every) const {
  std::vector<PosePlace> places = near_places(pose, every);
  const double typical = typical_sigma_;
  for (PosePlace& p : places) {
    const double sigma = measured_.evidence[samples_.stroke[p.sample]].sigma;
    p.weight *= typical > 0 ? typical * typical / (typical * typical + sigma * sigma) : 1;
  }
  weigh_down(std::max(robust_scale(places), kLeastGap * nominal_.extent), &places);
  return places;
}

Similarity RobustFit::step(const Similarity& pose, const std::vector<PosePlace>& places,
                           const MatrixXd& basis) const {
  PoseSystem system;
  for (const PosePlace& p : places)
    fit_.add(p, Matrix3d::Identity() - p.tangent * p.tangent.transpose(), &system);
  if (!(system.weight > 0)) return pose;
  return fit_.after(pose, solve(system, basis, kFreeDirection, nullptr));
}

Similarity RobustFit::fitted(Similarity pose, int every, const MatrixXd& basis) const {
  for (int k = 0; k < kMostPoseSteps; ++k) {
    const Similarity next = step(pose, weighed_places(pose, every), basis);
    const double moved =
        ((next * samples_.position.col(0)) - (pose * samples_.position.col(0))).norm();
    pose = next;
    if (moved < 1e-3 * kLeastGap * nominal_.extent) break;
  }
  return pose;
}

}  // namespace sketchsplat

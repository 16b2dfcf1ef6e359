// SPDX-License-Identifier: MIT
#include "eval/inspect/pose_choice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/types/parallel.h"
#include "eval/inspect/pose_candidates.h"

namespace sketchsplat {
namespace {

constexpr double kWide[] = {kWidestReach, 0.03,
                            0.015};  // [extents] reach of the first fits, coarse to fine
constexpr int kStepsEach = 3;
constexpr int kCoarse = 120, kMiddle = 400;  // samples that score a pose, that fit one
constexpr size_t kTried = 24, kFinal = 10;   // poses that are fitted, that are fitted exactly
constexpr double kSameTurn = 2 * M_PI / 180, kSamePlace = 5e-3;  // rad, extents
constexpr double kEqual = 1e-3;  // costs that differ by less, relatively, are equal

struct Pose {
  Similarity pose;
  double cost = 0;
};

class PoseChooser {
 public:
  explicit PoseChooser(const RobustFit& robust)
      : robust_(robust), grid_(robust.samples(), kWidestReach * robust.extent()) {}

  Pose choose(Alignment* out) const {
    const std::vector<Similarity> candidates =
        pose_candidates(robust_.measured(), robust_.nominal().sketch, robust_.options().fit_scale);
    std::vector<Pose> poses(candidates.size());
    const int n = int(candidates.size());
    parallel_for(n, 16, [&](int i) { poses[i] = {candidates[i], -score(candidates[i])}; });
    sort_by_cost(&poses);
    poses = distinct(poses, kTried);
    const int tried = int(poses.size());
    parallel_for(tried, 1, [&](int i) {
      poses[i].pose = roughly_fitted(poses[i].pose);
      poses[i].cost = cost(poses[i].pose, kWide[2] / 4 * robust_.nominal().extent);
    });
    sort_by_cost(&poses);
    poses = distinct(poses, kFinal);
    return best_of(poses, out);
  }

 private:
  int every(int samples) const { return robust_.every(samples); }

  // Share of the measured length that lies near nominal edges.
  double score(const Similarity& pose) const {
    const double reach = kWide[1] * robust_.nominal().extent;
    double near = 0;
    for (const PosePlace& p :
         robust_.fit().places(robust_.samples(), pose, reach, false, every(kCoarse)))
      near += p.weight * (1 - p.gap.squaredNorm() / (reach * reach));
    return near;
  }

  bool same(const Similarity& a, const Similarity& b) const {
    const Similarity between = b.inverse() * a;
    return between.rotation.trace() > 1 + 2 * std::cos(kSameTurn) &&
           (a * robust_.samples().position.col(0) - b * robust_.samples().position.col(0)).norm() <
               4 * kSamePlace * robust_.nominal().extent;
  }

  // The first `most` of them that differ.
  std::vector<Pose> distinct(const std::vector<Pose>& sorted, size_t most) const {
    std::vector<Pose> out;
    for (const Pose& p : sorted) {
      const bool is_known =
          std::any_of(out.begin(), out.end(), [&](const Pose& q) { return same(p.pose, q.pose); });
      if (!is_known) out.push_back(p);
      if (out.size() == most) break;
    }
    return out;
  }

  static void sort_by_cost(std::vector<Pose>* poses) {
    std::stable_sort(poses->begin(), poses->end(),
                     [](const Pose& a, const Pose& b) { return a.cost < b.cost; });
  }

  Similarity roughly_fitted(Similarity pose) const {
    for (const double wide : kWide)
      for (int k = 0; k < kStepsEach; ++k) {
        const double reach = wide * robust_.nominal().extent;
        std::vector<PosePlace> places =
            robust_.fit().places(robust_.samples(), pose, reach, false, every(kMiddle));
        weigh_down(reach / 4.685, &places);
        pose = robust_.step(pose, places, robust_.basis());
      }
    return pose;
  }

  // Mean of squared gaps over `scale`, at most 1 each, measured to nominal and back.
  double cost(const Similarity& pose, double scale) const {
    const double reach = robust_.options().reach * robust_.nominal().extent;
    double total = 0, sum = 0, there = 0;
    const int skip = every(kMiddle);
    for (int i = skip / 2; i < robust_.samples().size(); i += skip)
      total += robust_.samples().length[i];
    sum = total;
    for (const PosePlace& p : robust_.fit().places(robust_.samples(), pose, reach, true, skip))
      sum -= p.weight * (1 - std::min(1.0, p.gap.squaredNorm() / (scale * scale)));
    const EdgeSamples& nominal = robust_.fit().samples();
    const Similarity back = pose.inverse();
    double missing = 0;
    for (int i = 0; i < nominal.size(); ++i) {
      there += nominal.length[i];
      const int near =
          grid_.nearest(back * nominal.position.col(i), back.rotation * nominal.tangent.col(i),
                        reach * back.scale, 0.9);
      if (near < 0) missing += nominal.length[i];
    }
    return sum / total + missing / there;
  }

  Pose best_of(std::vector<Pose> poses, Alignment* out) const {
    const int n = int(poses.size());
    parallel_for(n, 1, [&](int i) {
      poses[i].pose = robust_.fitted(poses[i].pose, every(kMiddle), robust_.basis());
    });
    // What is far for the best is far for all.
    double scale = std::numeric_limits<double>::infinity();
    for (const Pose& p : poses) {
      const std::vector<PosePlace> places = robust_.near_places(p.pose, every(kMiddle));
      if (!places.empty()) scale = std::min(scale, robust_scale(places));
    }
    if (!std::isfinite(scale)) scale = 0;
    scale = std::max(3 * scale, 1e-5 * robust_.nominal().extent);
    for (Pose& p : poses) p.cost = cost(p.pose, scale);
    sort_by_cost(&poses);
    poses = distinct(poses, poses.size());
    const double equal = poses[0].cost * (1 + kEqual) + kEqual;
    Pose best = poses[0];
    out->equal_poses = 0;
    out->runner_up = std::numeric_limits<double>::infinity();
    for (const Pose& p : poses) {
      if (p.cost > equal) {
        out->runner_up = p.cost / std::max(best.cost, 1e-12);
        break;
      }
      ++out->equal_poses;
      if (turn_of(p) < turn_of(best) - 1e-3) best = p;
    }
    return best;
  }

  static double turn_of(const Pose& p) { return Eigen::AngleAxisd(p.pose.rotation).angle(); }

  const RobustFit& robust_;
  SampleGrid grid_;
};

}  // namespace

Similarity choose_pose(const RobustFit& robust, Alignment* out) {
  return PoseChooser(robust).choose(out).pose;
}

}  // namespace sketchsplat

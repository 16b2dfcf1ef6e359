// SPDX-License-Identifier: MIT
#include "eval/inspect/alignment.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "datasets/types/errors.h"
#include "datasets/types/median.h"
#include "eval/inspect/pose_candidates.h"
#include "eval/inspect/pose_fit.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_jacobian.h"
#include "sketches/solve/covariance.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Vector7 = Eigen::Matrix<double, 7, 1>;

constexpr double kWide[] = {0.06, 0.03,
                            0.015};  // [extents] reach of the first fits, coarse to fine
constexpr int kStepsEach = 3;
constexpr int kCoarse = 120, kMiddle = 400;  // samples that score a pose, that fit one
constexpr size_t kTried = 24, kFinal = 10;   // poses that are fitted, that are fitted exactly
constexpr double kSameTurn = 2 * M_PI / 180, kSamePlace = 5e-3;  // rad, extents
constexpr double kEqual = 1e-3;  // costs that differ by less, relatively, are equal
constexpr double kFree = 1e-6;   // share of the weight below which a direction is not held
constexpr double kHeldByDatum = 1e-3;
constexpr double kLeastScale = 1e-7;  // [extents] of gaps: curves of computers agree to that
constexpr int kMostSteps = 15;
constexpr double kMostGrowth = 3;  // [sigma] of the scale: by more, it is the part
constexpr int kFewEdges = 9;       // fewer say nothing of how they scatter about seven unknowns

struct Pose {
  Similarity pose;
  double cost = 0;
};

class Aligner {
 public:
  Aligner(const Sketch& measured, const Nominal& nominal, const AlignOptions& options)
      : measured_(measured),
        nominal_(nominal),
        options_(options),
        fit_(nominal, kWide[0] * nominal.extent),
        extent_(largest_extent(measured)),
        samples_(sample_edges(measured, extent_ / 150, 8)),
        grid_(samples_, kWide[0] * extent_),
        basis_(MatrixXd::Identity(7, options.fit_scale ? 7 : 6)) {}

  Alignment run() {
    Alignment out;
    out.centre = fit_.centre();
    out.holds.assign(nominal_.edges.size(), false);
    if (options_.to == AlignTo::kBestFit) {
      out.pose = options_.fit_scale || measured_.size() > 0 ? choose(&out).pose : Similarity();
      out.pose = options_.datums.empty() ? fitted(out.pose, 1, kMostSteps) : on_datums(out.pose);
    }
    out.scale_sigma = options_.scale_sigma;
    if (options_.to == AlignTo::kBestFit && options_.datums.empty() && options_.scale_sigma > 0 &&
        !options_.fit_scale)
      out.pose = with_likely_scale(out.pose, &out.scale_sigma);
    describe(&out);
    return out;
  }

 private:
  int every(int samples) const { return std::max(1, samples_.size() / samples); }

  // Share of the measured length that lies near nominal edges.
  double score(const Similarity& pose) const {
    const double reach = kWide[1] * nominal_.extent;
    double near = 0;
    for (const PosePlace& p : fit_.places(samples_, pose, reach, false, every(kCoarse)))
      near += p.weight * (1 - p.gap.squaredNorm() / (reach * reach));
    return near;
  }

  bool same(const Similarity& a, const Similarity& b) const {
    const Similarity between = b.inverse() * a;
    return between.rotation.trace() > 1 + 2 * std::cos(kSameTurn) &&
           (a * samples_.position.col(0) - b * samples_.position.col(0)).norm() <
               4 * kSamePlace * nominal_.extent;
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

  Similarity step(const Similarity& pose, const std::vector<PosePlace>& places,
                  const MatrixXd& basis) const {
    PoseSystem system;
    for (const PosePlace& p : places)
      fit_.add(p, Matrix3d::Identity() - p.tangent * p.tangent.transpose(), &system);
    if (!(system.weight > 0)) return pose;
    return fit_.after(pose, solve(system, basis, kFree, nullptr));
  }

  Similarity roughly_fitted(Similarity pose) const {
    for (const double wide : kWide)
      for (int k = 0; k < kStepsEach; ++k) {
        const double reach = wide * nominal_.extent;
        std::vector<PosePlace> places = fit_.places(samples_, pose, reach, false, every(kMiddle));
        weigh_down(reach / 4.685, &places);
        pose = step(pose, places, basis_);
      }
    return pose;
  }

  std::vector<PosePlace> weighed_places(const Similarity& pose, int every) const {
    std::vector<PosePlace> places =
        fit_.places(samples_, pose, options_.reach * nominal_.extent, true, every);
    const double typical = typical_sigma();
    for (PosePlace& p : places) {
      const double sigma = measured_.evidence[samples_.stroke[p.sample]].sigma;
      p.weight *= typical > 0 ? typical * typical / (typical * typical + sigma * sigma) : 1;
    }
    weigh_down(std::max(robust_scale(places), kLeastScale * nominal_.extent), &places);
    return places;
  }

  Similarity fitted(Similarity pose, int every, int steps) const {
    return fitted(pose, every, steps, basis_);
  }
  Similarity fitted(Similarity pose, int every, int steps, const MatrixXd& basis) const {
    for (int k = 0; k < steps; ++k) {
      const Similarity next = step(pose, weighed_places(pose, every), basis);
      const double moved =
          ((next * samples_.position.col(0)) - (pose * samples_.position.col(0))).norm();
      pose = next;
      if (moved < 1e-3 * kLeastScale * nominal_.extent) break;
    }
    return pose;
  }

  // Relative standard deviation of a growth that the edges tell: as their gaps scatter, which count
  // together on one edge, H^-1 (sum g g^T) H^-1 with g = sum w J^T gap (Liang & Zeger 1986).
  double growth_sigma(const Similarity& pose) const {
    PoseSystem all;
    std::vector<Vector7> pulls(nominal_.edges.size(), Vector7::Zero());
    for (const PosePlace& p : weighed_places(pose, 1)) {
      const Matrix3d across = Matrix3d::Identity() - p.tangent * p.tangent.transpose();
      fit_.add(p, across, &all);
      pulls[p.edge] += p.weight * fit_.jacobian(p.measured).transpose() * p.gap;
    }
    Eigen::Matrix<double, 7, 7> scatter = Eigen::Matrix<double, 7, 7>::Zero();
    for (const Vector7& g : pulls) scatter += g * g.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 7, 7>> es(all.information);
    Vector7 row = Vector7::Zero();  // of the inverse
    for (int k = 0; k < 7; ++k)
      if (es.eigenvalues()[k] > kFree * all.weight)
        row += es.eigenvectors()(6, k) / es.eigenvalues()[k] * es.eigenvectors().col(k);
    const double edges = double(pulls.size());
    if (edges < kFewEdges) return std::numeric_limits<double>::infinity();
    return std::sqrt(row.dot(scatter * row) * edges / (edges - 7)) / fit_.lever();
  }

  // Between the scale as it stands and the one that the edges want, as both are known.
  Similarity with_likely_scale(const Similarity& pose, double* sigma) const {
    const Similarity grown = fitted(pose, 1, kMostSteps, MatrixXd::Identity(7, 7));
    const double told = growth_sigma(grown);
    const double growth = std::abs(std::log(grown.scale / pose.scale));
    if (!std::isfinite(told) || growth > kMostGrowth * *sigma) return pose;
    const double share = *sigma * *sigma / (*sigma * *sigma + told * told);
    const double factor = std::pow(grown.scale / pose.scale, share);
    *sigma = std::sqrt(share) * told;
    Similarity out = pose;
    out.scale *= factor;
    out.translation = fit_.centre() + factor * (pose.translation - fit_.centre());
    return fitted(out, 1, kMostSteps);
  }

  double typical_sigma() const {
    std::vector<double> sigmas;
    for (const Evidence& e : measured_.evidence) sigmas.push_back(e.sigma);
    return median(std::move(sigmas));
  }

  // Mean of squared gaps over `scale`, at most 1 each, measured to nominal and back.
  double cost(const Similarity& pose, double scale) const {
    const double reach = options_.reach * nominal_.extent;
    double total = 0, sum = 0, there = 0;
    const int skip = every(kMiddle);
    for (int i = skip / 2; i < samples_.size(); i += skip) total += samples_.length[i];
    sum = total;
    for (const PosePlace& p : fit_.places(samples_, pose, reach, true, skip))
      sum -= p.weight * (1 - std::min(1.0, p.gap.squaredNorm() / (scale * scale)));
    const EdgeSamples& nominal = fit_.samples();
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

  Pose choose(Alignment* out) const {
    const std::vector<Similarity> candidates =
        pose_candidates(measured_, nominal_.sketch, options_.fit_scale);
    std::vector<Pose> poses(candidates.size());
    const int n = int(candidates.size());
#pragma omp parallel for schedule(dynamic, 16)
    for (int i = 0; i < n; ++i) poses[i] = {candidates[i], -score(candidates[i])};
    sort_by_cost(&poses);
    poses = distinct(poses, kTried);
    const int tried = int(poses.size());
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < tried; ++i) {
      poses[i].pose = roughly_fitted(poses[i].pose);
      poses[i].cost = cost(poses[i].pose, kWide[2] / 4 * nominal_.extent);
    }
    sort_by_cost(&poses);
    poses = distinct(poses, kFinal);
    return best_of(poses, out);
  }

  Pose best_of(std::vector<Pose> poses, Alignment* out) const {
    const int n = int(poses.size());
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < n; ++i) poses[i].pose = fitted(poses[i].pose, every(kMiddle), kMostSteps);
    // What is far for the best is far for all.
    double scale = std::numeric_limits<double>::infinity();
    for (const Pose& p : poses) {
      const std::vector<PosePlace> places =
          fit_.places(samples_, p.pose, options_.reach * nominal_.extent, true, every(kMiddle));
      if (!places.empty()) scale = std::min(scale, robust_scale(places));
    }
    if (!std::isfinite(scale)) scale = 0;
    scale = std::max(3 * scale, 1e-5 * nominal_.extent);
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

  struct Datum {
    int edge = -1, plane = -1;
  };
  Datum datum_of(const std::string& name) const {
    Datum d{find_edge(nominal_, name), find_plane(nominal_, name)};
    if (d.edge < 0 && d.plane < 0)
      throw InputError("--datum " + name,
                       "an edge (E1 to E" + std::to_string(nominal_.edges.size()) +
                           ") or a plane (P1 to P" + std::to_string(nominal_.planes.size()) +
                           ") of the nominal part",
                       "no such name");
    return d;
  }

  bool belongs(const PosePlace& p, const Datum& d) const {
    if (d.edge >= 0) return p.edge == d.edge;
    const std::vector<int>& edges = nominal_.planes[d.plane].edges;
    return std::binary_search(edges.begin(), edges.end(), p.edge);
  }

  PoseSystem system_of(const std::vector<PosePlace>& places, const Datum& d) const {
    PoseSystem system;
    for (const PosePlace& p : places) {
      if (!belongs(p, d)) continue;
      Matrix3d across = Matrix3d::Identity() - p.tangent * p.tangent.transpose();
      if (d.edge < 0) {
        const Vector3d& n = nominal_.planes[d.plane].normal;
        across = n * n.transpose();
      }
      fit_.add(p, across, &system);
    }
    return system;
  }

  Similarity on_datums(Similarity pose) const {
    pose = fitted(pose, 1, kMostSteps);
    for (int k = 0; k < kMostSteps; ++k) {
      const std::vector<PosePlace> places =
          fit_.places(samples_, pose, options_.reach * nominal_.extent, true, 1);
      MatrixXd open = basis_;
      Vector7 move = Vector7::Zero();
      for (const std::string& name : options_.datums) {
        PoseSystem system = system_of(places, datum_of(name));
        if (!(system.weight > 0))
          throw InputError("--datum " + name, "an edge or plane that was measured",
                           "nothing near it");
        if (open.cols() == 0) continue;
        system.slope += system.information * move;
        move += solve(system, open, kHeldByDatum, &open);
      }
      if (open.cols() > 0) {
        PoseSystem all;
        for (const PosePlace& p : weighed_places(pose, 1))
          fit_.add(p, Matrix3d::Identity() - p.tangent * p.tangent.transpose(), &all);
        all.slope += all.information * move;
        move += solve(all, open, kFree, nullptr);
      }
      pose = fit_.after(pose, move);
      if (move.norm() < 1e-3 * kLeastScale * nominal_.extent) break;
    }
    return pose;
  }

  // What held the pose, how well it is known, how much it explains.
  void describe(Alignment* out) const {
    std::vector<PosePlace> places = weighed_places(out->pose, 1);
    double near = 0, total = 0, squares = 0, weight = 0;
    for (const double length : samples_.length) total += length;
    for (const PosePlace& p : places) near += samples_.length[p.sample];
    out->share = near / total;
    if (options_.to == AlignTo::kAsGiven) {
      for (const PosePlace& p : places)
        squares += p.weight * p.gap.squaredNorm(), weight += p.weight;
      out->rms = weight > 0 ? std::sqrt(squares / weight) : 0;
      out->runner_up = std::numeric_limits<double>::infinity();
      return;
    }
    keep_holding(&places, out);
    PoseSystem system;
    for (const PosePlace& p : places) {
      fit_.add(p, Matrix3d::Identity() - p.tangent * p.tangent.transpose(), &system);
      squares += p.weight * p.gap.squaredNorm(), weight += p.weight;
    }
    out->rms = weight > 0 ? std::sqrt(squares / weight) : 0;
    find_covariance(places, system, out);
  }

  // Edges that a datum names hold the pose; without datums those whose places mostly count.
  void keep_holding(std::vector<PosePlace>* places, Alignment* out) const {
    std::vector<double> counted(nominal_.edges.size()), there(nominal_.edges.size());
    for (const PosePlace& p : *places) {
      counted[p.edge] += p.weight;
      there[p.edge] += samples_.length[p.sample];
    }
    for (size_t e = 0; e < counted.size(); ++e)
      out->holds[e] = there[e] > 0 && counted[e] > 0.25 * there[e];
    if (options_.datums.empty()) return;
    const auto is_datum = [&](int edge) {
      PosePlace p;
      p.edge = edge;
      return std::any_of(options_.datums.begin(), options_.datums.end(),
                         [&](const std::string& name) { return belongs(p, datum_of(name)); });
    };
    for (size_t e = 0; e < counted.size(); ++e) out->holds[e] = is_datum(int(e));
    places->erase(std::remove_if(places->begin(), places->end(),
                                 [&](const PosePlace& p) { return !out->holds[p.edge]; }),
                  places->end());
  }

  // H^-1 (sum A C A^T) H^-1, A = sum w J^T B: how errors of strokes move the pose.
  void find_covariance(const std::vector<PosePlace>& places, const PoseSystem& system,
                       Alignment* out) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> es(
        system.information.topLeftCorner<6, 6>());
    Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>::Zero();
    for (int k = 0; k < 6; ++k) {
      const auto v = es.eigenvectors().col(k);
      if (es.eigenvalues()[k] > kFree * system.weight)
        inverse += v * v.transpose() / es.eigenvalues()[k];
      else
        ++out->free_directions;
    }
    const Sketch moved_sketch = moved(measured_, out->pose);
    Eigen::Matrix<double, 6, 6> middle = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 12> sum = Eigen::Matrix<double, 6, 12>::Zero();
    for (size_t i = 0; i < places.size(); ++i) {
      const PosePlace& p = places[i];
      const int s = samples_.stroke[p.sample];
      const Matrix3d across = Matrix3d::Identity() - p.tangent * p.tangent.transpose();
      sum += p.weight * (across * fit_.jacobian(p.measured).leftCols<6>()).transpose() *
             curve_jacobian(moved_sketch.strokes[s].kind, control_points(moved_sketch, s),
                            samples_.t[p.sample]);
      if (i + 1 < places.size() && samples_.stroke[places[i + 1].sample] == s) continue;
      const Evidence& e = moved_sketch.evidence[s];
      if (!e.covariance.empty()) {
        const MatrixXd c = from_upper_triangle(e.covariance);
        middle += sum.leftCols(c.cols()) * c * sum.leftCols(c.cols()).transpose();
      }
      sum.setZero();
    }
    out->covariance = inverse * middle * inverse;
    // From lengths at the lever to radians.
    out->covariance.topRows<3>() /= fit_.lever();
    out->covariance.leftCols<3>() /= fit_.lever();
  }

  const Sketch& measured_;
  const Nominal& nominal_;
  const AlignOptions& options_;
  PoseFit fit_;
  double extent_;
  EdgeSamples samples_;
  SampleGrid grid_;
  MatrixXd basis_;
};

}  // namespace

Alignment align(const Sketch& measured, const Nominal& nominal, const AlignOptions& options) {
  return Aligner(measured, nominal, options).run();
}

}  // namespace sketchsplat

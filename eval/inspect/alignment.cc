// SPDX-License-Identifier: MIT
#include "eval/inspect/alignment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/types/dense.h"
#include "eval/inspect/datums.h"
#include "eval/inspect/pose_choice.h"
#include "eval/inspect/robust_fit.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_jacobian.h"
#include "sketches/solve/covariance.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Vector7 = Eigen::Matrix<double, 7, 1>;

constexpr double kMostGrowth = 3;  // [sigma] of the scale: by more, it is the part
constexpr int kFewEdges = 9;       // fewer say nothing of how they scatter about seven unknowns

class Aligner {
 public:
  Aligner(const Sketch& measured, const Nominal& nominal, const AlignOptions& options)
      : robust_(measured, nominal, options, kWidestReach) {}

  Alignment run() {
    Alignment out;
    const AlignOptions& options = robust_.options();
    out.centre = robust_.fit().centre();
    out.holds.assign(robust_.nominal().edges.size(), false);
    if (options.to == AlignTo::kBestFit) {
      if (options.fit_scale || robust_.measured().size() > 0) out.pose = choose_pose(robust_, &out);
      out.pose = options.datums.empty() ? robust_.fitted(out.pose, 1, robust_.basis())
                                        : fit_to_datums(robust_, out.pose);
    }
    out.scale_sigma = options.scale_sigma;
    if (options.to == AlignTo::kBestFit && options.datums.empty() && options.scale_sigma > 0 &&
        !options.fit_scale)
      out.pose = with_likely_scale(out.pose, &out.scale_sigma);
    describe(&out);
    return out;
  }

 private:
  // Relative standard deviation of a growth that the edges tell: as their gaps scatter, which count
  // together on one edge, H^-1 (sum g g^T) H^-1 with g = sum w J^T gap (Liang & Zeger 1986).
  double growth_sigma(const Similarity& pose) const {
    PoseSystem all;
    std::vector<Vector7> pulls(robust_.nominal().edges.size(), Vector7::Zero());
    for (const PosePlace& p : robust_.weighed_places(pose, 1)) {
      const Matrix3d across = Matrix3d::Identity() - p.tangent * p.tangent.transpose();
      robust_.fit().add(p, across, &all);
      pulls[p.edge] += p.weight * robust_.fit().jacobian(p.measured).transpose() * p.gap;
    }
    Eigen::Matrix<double, 7, 7> scatter = Eigen::Matrix<double, 7, 7>::Zero();
    for (const Vector7& g : pulls) scatter += g * g.transpose();
    const auto es = eigen_symmetric(all.information);
    Vector7 row = Vector7::Zero();  // of the inverse
    for (int k = 0; k < 7; ++k)
      if (es.values[k] > kFreeDirection * all.weight)
        row += es.vectors(6, k) / es.values[k] * es.vectors.col(k);
    const double edges = double(pulls.size());
    if (edges < kFewEdges) return std::numeric_limits<double>::infinity();
    return std::sqrt(row.dot(scatter * row) * edges / (edges - 7)) / robust_.fit().lever();
  }

  // Between the scale as it stands and the one that the edges want, as both are known.
  Similarity with_likely_scale(const Similarity& pose, double* sigma) const {
    const Similarity grown = robust_.fitted(pose, 1, MatrixXd::Identity(7, 7));
    const double told = growth_sigma(grown);
    const double growth = std::abs(std::log(grown.scale / pose.scale));
    if (!std::isfinite(told) || growth > kMostGrowth * *sigma) return pose;
    const double share = *sigma * *sigma / (*sigma * *sigma + told * told);
    const double factor = std::pow(grown.scale / pose.scale, share);
    *sigma = std::sqrt(share) * told;
    Similarity out = pose;
    out.scale *= factor;
    out.translation = robust_.fit().centre() + factor * (pose.translation - robust_.fit().centre());
    return robust_.fitted(out, 1, robust_.basis());
  }

  // What held the pose, how well it is known, how much it explains.
  void describe(Alignment* out) const {
    std::vector<PosePlace> places = robust_.weighed_places(out->pose, 1);
    double near = 0, total = 0, squares = 0, weight = 0;
    for (const double length : robust_.samples().length) total += length;
    for (const PosePlace& p : places) near += robust_.samples().length[p.sample];
    out->share = near / total;
    if (robust_.options().to == AlignTo::kAsGiven) {
      for (const PosePlace& p : places)
        squares += p.weight * p.gap.squaredNorm(), weight += p.weight;
      out->rms = weight > 0 ? std::sqrt(squares / weight) : 0;
      out->runner_up = std::numeric_limits<double>::infinity();
      return;
    }
    keep_holding(&places, out);
    PoseSystem system;
    for (const PosePlace& p : places) {
      robust_.fit().add(p, Matrix3d::Identity() - p.tangent * p.tangent.transpose(), &system);
      squares += p.weight * p.gap.squaredNorm(), weight += p.weight;
    }
    out->rms = weight > 0 ? std::sqrt(squares / weight) : 0;
    find_covariance(places, system, out);
  }

  // Edges that a datum names hold the pose; without datums those whose places mostly count.
  void keep_holding(std::vector<PosePlace>* places, Alignment* out) const {
    std::vector<double> counted(robust_.nominal().edges.size()),
        there(robust_.nominal().edges.size());
    for (const PosePlace& p : *places) {
      counted[p.edge] += p.weight;
      there[p.edge] += robust_.samples().length[p.sample];
    }
    for (size_t e = 0; e < counted.size(); ++e)
      out->holds[e] = there[e] > 0 && counted[e] > 0.25 * there[e];
    if (robust_.options().datums.empty()) return;
    const auto is_datum = [&](int edge) {
      const std::vector<std::string>& names = robust_.options().datums;
      return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        return belongs(robust_.nominal(), edge, datum_of(robust_.nominal(), name));
      });
    };
    for (size_t e = 0; e < counted.size(); ++e) out->holds[e] = is_datum(int(e));
    places->erase(std::remove_if(places->begin(), places->end(),
                                 [&](const PosePlace& p) { return !out->holds[p.edge]; }),
                  places->end());
  }

  // H^-1 (sum A C A^T) H^-1, A = sum w J^T B: how errors of strokes move the pose.
  void find_covariance(const std::vector<PosePlace>& places, const PoseSystem& system,
                       Alignment* out) const {
    const auto es = eigen_symmetric(system.information.topLeftCorner<6, 6>());
    Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>::Zero();
    for (int k = 0; k < 6; ++k) {
      const auto v = es.vectors.col(k);
      if (es.values[k] > kFreeDirection * system.weight)
        inverse += v * v.transpose() / es.values[k];
      else
        ++out->free_directions;
    }
    const Sketch moved_sketch = moved(robust_.measured(), out->pose);
    Eigen::Matrix<double, 6, 6> middle = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 12> sum = Eigen::Matrix<double, 6, 12>::Zero();
    for (size_t i = 0; i < places.size(); ++i) {
      const PosePlace& p = places[i];
      const int s = robust_.samples().stroke[p.sample];
      const Matrix3d across = Matrix3d::Identity() - p.tangent * p.tangent.transpose();
      sum += p.weight * (across * robust_.fit().jacobian(p.measured).leftCols<6>()).transpose() *
             curve_jacobian(moved_sketch.strokes[s].kind, control_points(moved_sketch, s),
                            robust_.samples().t[p.sample]);
      if (i + 1 < places.size() && robust_.samples().stroke[places[i + 1].sample] == s) continue;
      const Evidence& e = moved_sketch.evidence[s];
      if (!e.covariance.empty()) {
        const MatrixXd c = from_upper_triangle(e.covariance);
        middle += sum.leftCols(c.cols()) * c * sum.leftCols(c.cols()).transpose();
      }
      sum.setZero();
    }
    out->covariance = inverse * middle * inverse;
    // From lengths at the lever to radians.
    out->covariance.topRows<3>() /= robust_.fit().lever();
    out->covariance.leftCols<3>() /= robust_.fit().lever();
  }

  RobustFit robust_;
};

}  // namespace

Alignment align(const Sketch& measured, const Nominal& nominal, const AlignOptions& options) {
  return Aligner(measured, nominal, options).run();
}

}  // namespace sketchsplat

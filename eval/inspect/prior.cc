// SPDX-License-Identifier: MIT
#include "eval/inspect/prior.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kFinest = 0.125;      // [tolerances] the least scale: what is less is in, surely
constexpr int kScales = 9;             // up to 32 tolerances
constexpr double kEachCounts = 0.1;    // things that each scale has been seen in already
constexpr int kRounds = 200;           // of the EM algorithm
constexpr double kLeastWeight = 1e-4;  // of a part of a mixture
constexpr double kLeastRigid = 1e-6;  // of singular values: turns of a line about itself do nothing
constexpr double kLittle = 0.125;     // of the scale, of what deviates little

double log_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double x : logs) sum += std::exp(x - most);
  return most + std::log(sum);
}

// Makes weights of their logarithms.
void normalise(std::vector<double>* logs) {
  const double all = log_sum(*logs);
  for (double& x : *logs) x = std::exp(x - all);
}

double log_normal(double x, double variance) {
  return -0.5 * x * x / variance - 0.5 * std::log(variance);
}

}  // namespace

DeviationPrior vague_prior(double tolerance) {
  DeviationPrior out;
  for (int k = 0; k < kScales; ++k) out.scales.push_back(std::ldexp(kFinest * tolerance, k));
  out.weights.assign(kScales, 1.0 / kScales);
  return out;
}

DeviationPrior learn_prior(const DeviationPrior& vague,
                           const std::vector<std::vector<double>>& log_evidence) {
  DeviationPrior out = vague;
  const size_t n = vague.scales.size();
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> counts(n, kEachCounts);
    for (const std::vector<double>& evidence : log_evidence) {
      std::vector<double> share(n);
      for (size_t k = 0; k < n; ++k) share[k] = std::log(out.weights[k]) + evidence[k];
      normalise(&share);
      for (size_t k = 0; k < n; ++k) counts[k] += share[k];
    }
    double total = 0;
    for (const double c : counts) total += c;
    for (size_t k = 0; k < n; ++k) out.weights[k] = counts[k] / total;
  }
  return out;
}

MatrixXd rigid_deviations(const std::vector<EdgePlace>& places) {
  const int n = int(places.size());
  Vector3d centre = Vector3d::Zero();
  for (const EdgePlace& p : places) centre += p.nominal / n;
  double lever = 0;
  for (const EdgePlace& p : places) lever += (p.nominal - centre).squaredNorm() / n;
  lever = std::max(std::sqrt(lever), 1e-300);
  MatrixXd out(2 * n, 7);
  for (int i = 0; i < n; ++i) {
    const Vector3d arm = (places[i].nominal - centre) / lever;
    Eigen::Matrix<double, 3, 7> move;
    move << 1, 0, 0, 0, arm.z(), -arm.y(), arm.x(),  //
        0, 1, 0, -arm.z(), 0, arm.x(), arm.y(),      //
        0, 0, 1, arm.y(), -arm.x(), 0, arm.z();
    out.middleRows<2>(2 * i) = std::sqrt(0.5) * frame_across(places[i].tangent) * move;
  }
  return out;
}

PieceLikelihood::PieceLikelihood(const PieceErrors& errors, double tail_share,
                                 const MatrixXd& rigid, double floor)
    : measured_(errors.model), wide_(errors.wide) {
  const Eigen::JacobiSVD<MatrixXd> svd(rigid, Eigen::ComputeThinU);
  Eigen::Index k = 0;
  while (k < svd.singularValues().size() &&
         svd.singularValues()[k] > kLeastRigid * svd.singularValues()[0])
    ++k;
  basis_ = svd.matrixU().leftCols(k);
  // Everything deviates, or the place, the direction or the size alone, and the rest little.
  for (int wrong = 0; wrong < kWays; ++wrong) {
    VectorXd by = VectorXd::Constant(7, wrong == 0 ? 1 : kLittle);
    if (wrong == 1) by.head<3>().setOnes();
    if (wrong == 2) by.segment<3>(3).setOnes();
    if (wrong == 3) by[6] = 1;
    const MatrixXd moves = basis_.transpose() * rigid * by.asDiagonal();
    shapes_.push_back(moves * moves.transpose());
  }
  const VectorXd mean = measured_.mean.reshaped();
  rigid_ = basis_.transpose() * mean;
  wave_ = mean - basis_ * rigid_;
  const MatrixXd own = basis_.transpose() * measured_.modes;
  others_ = measured_.modes - basis_ * own;
  const MatrixXd least = floor * floor * MatrixXd::Identity(k, k);
  const auto add = [&](double factor, double share) {
    if (share > 0)
      kinds_.push_back({factor, share, factor * factor * own * own.transpose() + least});
  };
  add(1, 1 - tail_share);
  add(wide_, tail_share);
}

double PieceLikelihood::log_evidence(double scale, int wrong, const Kind& kind) const {
  const Eigen::LLT<MatrixXd> llt(scale * scale * shapes_[wrong] + kind.covariance);
  const VectorXd z = llt.matrixL().solve(rigid_);
  const MatrixXd l = llt.matrixL();
  return std::log(kind.share / kWays) - 0.5 * z.squaredNorm() - l.diagonal().array().log().sum();
}

double PieceLikelihood::log_evidence(double scale) const {
  std::vector<double> logs;
  for (const Kind& kind : kinds_)
    for (int wrong = 0; wrong < kWays; ++wrong) logs.push_back(log_evidence(scale, wrong, kind));
  return log_sum(logs);
}

DeviationModel PieceLikelihood::posterior(double scale, int wrong, const Kind& kind) const {
  const MatrixXd prior = scale * scale * shapes_[wrong];
  const Eigen::LLT<MatrixXd> llt(prior + kind.covariance);
  DeviationModel out;
  const VectorXd mean = basis_ * (prior * llt.solve(rigid_)) + wave_;
  out.mean = mean.reshaped(2, mean.size() / 2);
  out.between = measured_.between;
  MatrixXd covariance = prior - prior * llt.solve(prior);
  // Rounding must not make it indefinite.
  covariance.diagonal().array() += 1e-12 * prior.diagonal().maxCoeff();
  out.modes.resize(basis_.rows(), basis_.cols() + others_.cols());
  out.modes << basis_ * MatrixXd(covariance.llt().matrixL()), kind.factor * others_;
  return out;
}

DeviationMixture PieceLikelihood::posterior(const DeviationPrior& prior) const {
  struct Part {
    size_t scale, kind;
    int wrong;
  };
  std::vector<Part> parts;
  std::vector<double> weights;
  for (size_t s = 0; s < prior.scales.size(); ++s)
    for (size_t k = 0; k < kinds_.size(); ++k)
      for (int wrong = 0; wrong < kWays; ++wrong) {
        parts.push_back({s, k, wrong});
        weights.push_back(std::log(prior.weights[s]) +
                          log_evidence(prior.scales[s], wrong, kinds_[k]));
      }
  normalise(&weights);
  DeviationMixture out;
  double total = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (weights[i] < kLeastWeight) continue;
    out.parts.push_back(
        posterior(prior.scales[parts[i].scale], parts[i].wrong, kinds_[parts[i].kind]));
    out.weights.push_back(weights[i]);
    total += weights[i];
  }
  for (double& w : out.weights) w /= total;
  return out;
}

DeviationMixture PieceLikelihood::errors() const {
  DeviationMixture out;
  for (const Kind& kind : kinds_) {
    DeviationModel m = measured_;
    m.mean.setZero();
    m.modes *= kind.factor;
    out.parts.push_back(m);
    out.weights.push_back(kind.share);
  }
  return out;
}

double number_log_evidence(double off, double sigma, double wide, double tail_share, double scale) {
  const double narrow = log_normal(off, scale * scale + sigma * sigma);
  if (!(tail_share > 0)) return narrow;
  return log_sum(
      {std::log1p(-tail_share) + narrow,
       std::log(tail_share) + log_normal(off, scale * scale + std::pow(wide * sigma, 2))});
}

double number_probability(double off, double sigma, double wide, double tail_share, double half,
                          const DeviationPrior& prior) {
  std::vector<double> weights, within;
  for (size_t s = 0; s < prior.scales.size(); ++s)
    for (const double factor : {1.0, wide}) {
      const double share = factor == 1 ? 1 - tail_share : tail_share;
      if (!(share > 0)) continue;
      const double t2 = prior.scales[s] * prior.scales[s], s2 = std::pow(factor * sigma, 2);
      weights.push_back(std::log(share * prior.weights[s]) + log_normal(off, t2 + s2));
      within.push_back(
          interval_probability(off * t2 / (t2 + s2), std::sqrt(t2 * s2 / (t2 + s2)), half));
    }
  normalise(&weights);
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) sum += weights[i] * within[i];
  return sum;
}

}  // namespace sketchsplat

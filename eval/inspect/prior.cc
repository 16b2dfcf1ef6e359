// SPDX-License-Identifier: MIT
#include "eval/inspect/prior.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"

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
constexpr double kUnmodelled = 0.7;   // of the errors, in each direction: shapes may be others
constexpr double kFloor = 0.01;       // [tolerances] of errors: better is not told apart

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

namespace {

// Orthonormal columns that span those of `moves`.
MatrixXd span_of(const MatrixXd& moves) {
  if (moves.cols() == 0) return moves;
  const Svd of = svd(moves);
  Eigen::Index k = 0;
  while (k < of.values.size() && of.values[k] > kLeastRigid * of.values[0]) ++k;
  return of.u.leftCols(k);
}

}  // namespace

PieceLikelihood::PieceLikelihood(const PieceErrors& errors, const MatrixXd& rigid, double tolerance)
    : measured_(errors.model), stated_(errors.stated), basis_(span_of(rigid)) {
  // Everything deviates, or the place, the direction or the size alone.
  for (int wrong = 0; wrong < kWays; ++wrong) {
    VectorXd by = VectorXd::Constant(7, wrong == 0);
    if (wrong == 1) by.head<3>().setOnes();
    if (wrong == 2) by.segment<3>(3).setOnes();
    if (wrong == 3) by[6] = 1;
    moves_.push_back(basis_.transpose() * rigid * by.asDiagonal());
  }
  little_ = kFinest * tolerance * basis_.transpose() * rigid;
  const VectorXd mean = measured_.mean.reshaped();
  known_ = basis_.transpose() * mean;
  const MatrixXd all = basis_.transpose() * measured_.modes;
  const MatrixXd own = all.leftCols(all.cols() - stated_), stated = all.rightCols(stated_);
  wave_ = mean - basis_ * known_;
  const double noise = (measured_.modes - basis_ * all).squaredNorm();
  wave_ *= errors.simpler ? 0 : std::max(0.0, 1 - noise / std::max(1e-300, wave_.squaredNorm()));
  const Eigen::Index n = own.rows();
  const MatrixXd expected = own * own.transpose() + kUnmodelled * kUnmodelled * own.squaredNorm() /
                                                        double(n) * MatrixXd::Identity(n, n);
  const MatrixXd always =
      stated * stated.transpose() + std::pow(kFloor * tolerance, 2) * MatrixXd::Identity(n, n);
  const auto sizes = sizes_of(errors.shares);
  for (size_t k = 0; k < sizes.size(); ++k)
    if (errors.shares[k] > 0)
      kinds_.push_back({sizes[k], errors.shares[k], sizes[k] * sizes[k] * expected + always});
}

MatrixXd PieceLikelihood::prior_moves(double scale, int wrong) const {
  MatrixXd out(little_.rows(), moves_[wrong].cols() + little_.cols());
  out << scale * moves_[wrong], little_;
  return out;
}

double PieceLikelihood::log_evidence(double scale, int wrong, const Kind& kind) const {
  const MatrixXd moves = prior_moves(scale, wrong);
  const Cholesky root(moves * moves.transpose() + kind.covariance);
  const VectorXd z = root.whitened(known_);
  const double log_share = std::log(kind.share / double(moves_.size()));
  return log_share - 0.5 * z.squaredNorm() - 0.5 * root.log_determinant();
}

double PieceLikelihood::log_evidence(double scale) const {
  std::vector<double> logs;
  for (const Kind& kind : kinds_)
    for (size_t wrong = 0; wrong < moves_.size(); ++wrong)
      logs.push_back(log_evidence(scale, int(wrong), kind));
  return log_sum(logs);
}

// Of the standard normal numbers that the moves are taken by: what is not moved stays exactly.
DeviationModel PieceLikelihood::posterior(double scale, int wrong, const Kind& kind) const {
  const MatrixXd moves = prior_moves(scale, wrong);
  const MatrixXd weighted = Cholesky(kind.covariance).solve(moves);
  const Eigen::Index n = moves.cols();
  const Cholesky information(MatrixXd::Identity(n, n) + moves.transpose() * weighted);
  DeviationModel out;
  const VectorXd by = information.solve(weighted.transpose() * known_);
  out.mean = VectorXd(basis_ * (moves * by) + wave_).reshaped(2, basis_.rows() / 2);
  out.between = measured_.between;
  out.modes = basis_ * information.whitened(moves.transpose()).transpose();
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
      for (int wrong = 0; wrong < int(moves_.size()); ++wrong) {
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
    m.modes.leftCols(m.modes.cols() - stated_) *= kind.size;
    out.parts.push_back(m);
    out.weights.push_back(kind.share);
  }
  return out;
}

namespace {

// Variances of the error, by size.
ErrorShares variances(const NumberError& error) {
  ErrorShares out = sizes_of(error.shares);
  for (double& v : out) v = std::pow(v * error.sigma, 2) + error.stated * error.stated;
  return out;
}

}  // namespace

double number_log_evidence(double off, const NumberError& error, double scale) {
  std::vector<double> logs;
  const ErrorShares variance = variances(error);
  for (size_t k = 0; k < variance.size(); ++k)
    if (error.shares[k] > 0)
      logs.push_back(std::log(error.shares[k]) + log_normal(off, scale * scale + variance[k]));
  return log_sum(logs);
}

double number_probability(double off, const NumberError& error, double half,
                          const DeviationPrior& prior) {
  std::vector<double> weights, within;
  const ErrorShares variance = variances(error);
  for (size_t s = 0; s < prior.scales.size(); ++s)
    for (size_t k = 0; k < variance.size(); ++k) {
      if (!(error.shares[k] > 0)) continue;
      const double t2 = prior.scales[s] * prior.scales[s], s2 = variance[k];
      weights.push_back(std::log(error.shares[k] * prior.weights[s]) + log_normal(off, t2 + s2));
      within.push_back(
          interval_probability(off * t2 / (t2 + s2), std::sqrt(t2 * s2 / (t2 + s2)), half));
    }
  normalise(&weights);
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) sum += weights[i] * within[i];
  return sum;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "eval/inspect/tolerance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;

constexpr int kMostModes = 32;

// kDraws x kMostModes standard normal numbers, by Box and Muller: the engine's numbers are fixed by
// the standard, those of std::normal_distribution are not.
MatrixXd make_normal_numbers() {
  std::mt19937_64 engine(1);
  const auto uniform = [&] { return (double(engine() >> 11) + 0.5) / 9007199254740992.0; };
  MatrixXd out(kDraws, kMostModes);
  for (Eigen::Index i = 0; i < out.size(); i += 2) {
    const double r = std::sqrt(-2 * std::log(uniform())), a = 2 * M_PI * uniform();
    out.data()[i] = r * std::cos(a);
    out.data()[i + 1] = r * std::sin(a);
  }
  return out;
}

const MatrixXd& normal_numbers() {
  static const MatrixXd numbers = make_normal_numbers();
  return numbers;
}

// Modes that span the same covariance, not more than there are numbers for.
MatrixXd few_modes(const MatrixXd& modes) {
  if (modes.cols() <= kMostModes) return modes;
  const auto es = eigen_symmetric(modes * modes.transpose());
  const Eigen::Index n = std::min<Eigen::Index>(kMostModes, modes.rows());
  return es.vectors.rightCols(n) * es.values.tail(n).cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace

double interval_probability(double mean, double sigma, double half) {
  if (!(half >= 0)) return 0;
  if (!(sigma > 0)) return std::abs(mean) <= half ? 1 : 0;
  const double root = std::sqrt(2.0) * sigma;
  return 0.5 * (std::erf((half - mean) / root) + std::erf((half + mean) / root));
}

double square_probability(const Vector2d& mean, const Matrix2d& covariance, double half) {
  const auto es = eigen_symmetric(covariance);
  double product = 1;
  for (int k = 0; k < 2; ++k)
    product *= interval_probability(es.vectors.col(k).dot(mean),
                                    std::sqrt(std::max(0.0, es.values[k])), half);
  return product;
}

void bound_tube(const std::vector<DeviationMixture>& pieces, double radius,
                TubeProbability* probability) {
  double missed = 0, high = 1;
  for (const DeviationMixture& piece : pieces)
    for (int j = 0; j < piece.parts[0].mean.cols(); ++j) {
      double inscribed = 0, circumscribed = 0;
      for (size_t k = 0; k < piece.parts.size(); ++k) {
        const DeviationModel& m = piece.parts[k];
        const auto rows = m.modes.middleRows<2>(2 * j);
        const Matrix2d c = rows * rows.transpose();
        inscribed += piece.weights[k] *
                     square_probability(m.mean.col(j), c, m.between * radius / std::sqrt(2.0));
        circumscribed += piece.weights[k] * square_probability(m.mean.col(j), c, radius);
      }
      missed += 1 - inscribed;
      high = std::min(high, circumscribed);
    }
  probability->low = std::max(0.0, 1 - missed);
  probability->high = high;
}

std::vector<double> draw_largest(const std::vector<DeviationMixture>& pieces) {
  std::vector<double> largest(kDraws, 0);
  std::uint32_t shift = 0;
  for (const DeviationMixture& piece : pieces) {
    double share = 0;
    int from = 0;
    for (size_t k = 0; k < piece.parts.size(); ++k) {
      share += piece.weights[k];
      const int to = k + 1 < piece.parts.size() ? int(std::lround(share * kDraws)) : kDraws;
      const DeviationModel& m = piece.parts[k];
      const MatrixXd modes = few_modes(m.modes);
      const MatrixXd moves =  // 2 P x draws
          modes * normal_numbers().block(from, 0, to - from, modes.cols()).transpose();
      for (int i = from; i < to; ++i) {
        double squared = 0;
        for (int j = 0; j < m.mean.cols(); ++j)
          squared =
              std::max(squared, (m.mean.col(j) + moves.block<2, 1>(2 * j, i - from)).squaredNorm());
        // Each piece has the draws in another order: pieces err independently.
        double& there =
            largest[(std::uint32_t(i) * (2 * shift + 1) + 977 * shift) % std::uint32_t(kDraws)];
        there = std::max(there, std::sqrt(squared));
      }
      from = to;
    }
    ++shift;
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

double share_within(const std::vector<double>& ascending, double radius) {
  if (ascending.empty()) return 0;
  const auto end = std::upper_bound(ascending.begin(), ascending.end(), radius);
  return double(end - ascending.begin()) / double(ascending.size());
}

}  // namespace sketchsplat

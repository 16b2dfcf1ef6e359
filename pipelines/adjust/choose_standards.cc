// SPDX-License-Identifier: MIT
#include "pipelines/adjust/choose_standards.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kGate = 2;           // [sigma]
constexpr double kNews = 0.1;         // of its sigma must be left, or the others tell it
constexpr double kTinySigma = 1e-12;  // relative: exact numbers cost no infinite amount

// The best standard for a length as it is by now, within reach of what was measured, too.
ChosenStandard best_for(int i, double mean, double variance, const MeasuredLengths& lengths,
                        StandardSystem system, double price) {
  ChosenStandard best;
  best.length = i;
  const double sigma = std::max(std::sqrt(variance), kTinySigma * lengths.value[i]);
  const double own = std::max(
      std::hypot(std::sqrt(lengths.covariance(i, i)), lengths.scale_sigma * lengths.value[i]),
      sigma);
  for (const StandardLength& s : standards_near(system, lengths.diameter[i], mean, kGate * sigma)) {
    if (std::abs(s.value - lengths.value[i]) > kGate * own) continue;
    const double off = (s.value - mean) / sigma;
    const double nats =
        std::log(s.spacing / (sigma * std::sqrt(2 * M_PI))) - price - 0.5 * off * off;
    if (nats > best.nats) best.nats = nats, best.standard = s;
  }
  return best;
}

bool goes_first(const ChosenStandard& a, const ChosenStandard& b) {
  return a.nats != b.nats ? a.nats > b.nats : a.standard.value < b.standard.value;
}

}  // namespace

StandardChoice choose_standards(const MeasuredLengths& lengths, StandardSystem system,
                                double price) {
  const int n = int(lengths.value.size());
  // The last variable is what the scale is off by.
  VectorXd by_scale(n + 1), mean(n + 1);
  by_scale << lengths.value, 1;
  mean << lengths.value, 0;
  MatrixXd covariance = lengths.scale_sigma * lengths.scale_sigma * by_scale * by_scale.transpose();
  covariance.topLeftCorner(n, n) += lengths.covariance;
  std::vector<char> taken(n);
  StandardChoice out;
  for (;;) {
    ChosenStandard best;
    for (int i = 0; i < n; ++i) {
      const double variance = std::max(0.0, covariance(i, i));
      const bool told = variance < kNews * kNews * lengths.covariance(i, i);
      if (taken[i] || (told && !out.lengths.empty())) continue;
      const ChosenStandard one = best_for(i, mean[i], variance, lengths, system, price);
      if (one.nats > 0 && (!(best.nats > 0) || goes_first(one, best))) best = one;
    }
    if (!(best.nats > 0)) break;
    const int k = best.length;
    taken[k] = true;
    out.lengths.push_back(best);
    if (!(covariance(k, k) > 0)) continue;
    const VectorXd gain = covariance.col(k) / covariance(k, k);
    mean += gain * (best.standard.value - mean[k]);
    covariance -= covariance(k, k) * gain * gain.transpose();
  }
  out.scale = 1 + mean[n];
  out.scale_sigma = std::sqrt(std::max(0.0, covariance(n, n)));
  return out;
}

}  // namespace sketchsplat

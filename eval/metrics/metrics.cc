// SPDX-License-Identifier: MIT
#include "eval/metrics/metrics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include "datasets/truth/ground_truth.h"
#include "datasets/truth/published_samples.h"
#include "eval/metrics/nearest.h"

namespace sketchsplat {
namespace {

using Cubic = Eigen::Matrix<double, 3, 4>;

double norm_of(const Eigen::Vector3d& v) {
  return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
}

Eigen::Vector3d point_of(const Cubic& c, double t) {
  const double s = 1 - t;
  return std::pow(s, 3) * c.col(0) + 3 * s * s * t * c.col(1) + 3 * s * t * t * c.col(2) +
         std::pow(t, 3) * c.col(3);
}

double speed_of(const Cubic& c, double t) {
  const double s = 1 - t;
  const double a = 3 * s * s, b = 6 * s * t, d = 3 * t * t;
  return norm_of(a * (c.col(1) - c.col(0)) + b * (c.col(2) - c.col(1)) + d * (c.col(3) - c.col(2)));
}

// Sum in numpy's order (pairwise, eight accumulators a block): the number of samples jumps where a
// length meets a multiple of the step, so the last bit counts.
double pairwise_sum(const double* v, size_t n, size_t stride) {
  if (n < 8) {
    double sum = 0;
    for (size_t i = 0; i < n; ++i) sum += v[i * stride];
    return sum;
  }
  if (n <= 128) {
    double r[8];
    for (size_t k = 0; k < 8; ++k) r[k] = v[k * stride];
    size_t i = 8;
    for (; i + 8 <= n; i += 8) {
      for (size_t k = 0; k < 8; ++k) r[k] += v[(i + k) * stride];
    }
    double sum = ((r[0] + r[1]) + (r[2] + r[3])) + ((r[4] + r[5]) + (r[6] + r[7]));
    for (; i < n; ++i) sum += v[i * stride];
    return sum;
  }
  const size_t half = n / 2 - n / 2 % 8;
  return pairwise_sum(v, half, stride) + pairwise_sum(v + half * stride, n - half, stride);
}

double simpson_length(const Cubic& c) {
  constexpr int kSteps = 10000;
  std::vector<double> speed(kSteps + 1);
  for (int i = 0; i <= kSteps; ++i) speed[i] = speed_of(c, linspace01(i, kSteps + 1));
  return (speed.front() + speed.back() + 4 * pairwise_sum(&speed[1], kSteps / 2, 2) +
          2 * pairwise_sum(&speed[2], kSteps / 2 - 1, 2)) /
         (3 * kSteps);
}

// Cuts a polyline into equal pieces of its length; `pieces` + 1 points.
Eigen::Matrix3Xd resample(const Eigen::Matrix3Xd& polyline, const std::vector<double>& at,
                          int pieces) {
  Eigen::Matrix3Xd out(3, pieces + 1);
  size_t k = 0;
  for (int i = 0; i <= pieces; ++i) {
    const double want = linspace01(i, pieces + 1) * at.back();
    while (k + 2 < at.size() && at[k + 1] <= want) ++k;
    const double span = at[k + 1] - at[k];
    const double w = span > 0 ? std::min((want - at[k]) / span, 1.0) : 0.0;
    out.col(i) = polyline.col(k) * (1 - w) + polyline.col(k + 1) * w;
  }
  return out;
}

Eigen::Matrix3Xd cubic_by_arc_length(const Cubic& c, double step) {
  constexpr int kPoints = 200;
  Eigen::Matrix3Xd polyline(3, kPoints);
  std::vector<double> at(kPoints, 0.0);
  for (int i = 0; i < kPoints; ++i) {
    polyline.col(i) = point_of(c, linspace01(i, kPoints));
    if (i > 0) at[i] = at[i - 1] + (polyline.col(i) - polyline.col(i - 1)).norm();
  }
  return resample(polyline, at, std::max(1, int(at.back() / step)));
}

Eigen::VectorXd selected(const Eigen::VectorXd& values, const std::vector<bool>& wanted) {
  Eigen::VectorXd out(std::count(wanted.begin(), wanted.end(), true));
  Eigen::Index at = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i]) out[at++] = values[Eigen::Index(i)];
  }
  return out;
}

double share_below(const Eigen::VectorXd& values, double threshold) {
  if (values.size() == 0) return 0;
  return double((values.array() < threshold).count()) / double(values.size());
}

double f_of(double p, double r) { return 2 * p * r / (p + r + 1e-7); }

// Rearranges the values.
double percentile(std::vector<double>* values, double share) {
  const double rank = share * double(values->size() - 1);
  const auto low = values->begin() + std::ptrdiff_t(rank);
  std::nth_element(values->begin(), low, values->end());
  const double weight = rank - std::floor(rank);
  if (weight == 0) return *low;
  return *low + (*std::min_element(low + 1, values->end()) - *low) * weight;
}

}  // namespace

Spread spread_of(const Eigen::VectorXd& distances) {
  Spread spread;
  if (distances.size() == 0) return spread;
  std::vector<double> values(distances.data(), distances.data() + distances.size());
  spread.median = percentile(&values, 0.5);
  spread.p95 = percentile(&values, 0.95);
  spread.worst = distances.maxCoeff();
  return spread;
}

Eigen::Matrix3Xd as_float(const Eigen::Matrix3Xd& points) {
  return points.cast<float>().cast<double>();
}

Eigen::Matrix3Xd sample_published(const Prediction& prediction, double step) {
  std::vector<Eigen::Matrix3Xd> parts;
  for (const Cubic& c : prediction.curves) {
    const int count = int(floor_divide(simpson_length(c), step));
    parts.emplace_back(3, count);
    for (int i = 0; i < count; ++i) parts.back().col(i) = point_of(c, linspace01(i, count));
  }
  for (const auto& line : prediction.lines) {
    const Eigen::Vector3d a = line.col(0), b = line.col(1);
    const int count = int(floor_divide(norm_of(a - b), step));
    parts.emplace_back(3, count);
    for (int i = 0; i < count; ++i) parts.back().col(i) = linspace01(i, count) * (b - a) + a;
  }
  return concatenate(parts);
}

Eigen::Matrix3Xd sample_arc_length(const Prediction& prediction, double step) {
  std::vector<Eigen::Matrix3Xd> parts;
  for (const auto& line : prediction.lines) {
    const double length = norm_of(line.col(1) - line.col(0));
    parts.push_back(resample(line, {0.0, length}, std::max(1, int(length / step))));
  }
  for (const Cubic& c : prediction.curves) parts.push_back(cubic_by_arc_length(c, step));
  return concatenate(parts);
}

Eigen::Matrix3Xd densify(const Eigen::Matrix3Xd& polyline, double spacing,
                         std::vector<int>* nearest) {
  if (nearest) nearest->clear();
  if (polyline.cols() == 0) return polyline;
  std::vector<Eigen::Matrix3Xd> parts;
  for (Eigen::Index k = 0; k + 1 < polyline.cols(); ++k) {
    const Eigen::Vector3d a = polyline.col(k), b = polyline.col(k + 1);
    const int count = std::max(1, int(norm_of(b - a) / spacing));
    parts.emplace_back(3, count);
    for (int i = 0; i < count; ++i) {
      const double w = double(i) / count;
      parts.back().col(i) = a * (1 - w) + b * w;
      if (nearest) nearest->push_back(int(k) + (w < 0.5 ? 0 : 1));
    }
  }
  parts.push_back(polyline.rightCols<1>());
  if (nearest) nearest->push_back(int(polyline.cols()) - 1);
  return concatenate(parts);
}

Eigen::Matrix3Xd resample(const Eigen::Matrix3Xd& polyline, double spacing) {
  if (polyline.cols() < 2) return polyline;
  std::vector<double> at(size_t(polyline.cols()), 0.0);
  for (Eigen::Index i = 1; i < polyline.cols(); ++i) {
    at[size_t(i)] = at[size_t(i) - 1] + (polyline.col(i) - polyline.col(i - 1)).norm();
  }
  return resample(polyline, at, std::max(1, int(std::ceil(at.back() / spacing))));
}

double polyline_length(const Eigen::Matrix3Xd& polyline) {
  double length = 0;
  for (Eigen::Index i = 1; i < polyline.cols(); ++i) {
    length += (polyline.col(i) - polyline.col(i - 1)).norm();
  }
  return length;
}

Eigen::Matrix3Xd voxel_average(const Eigen::Matrix3Xd& points, int count, double low, double high) {
  struct Voxel {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int points = 0;
  };
  const double side = (high - low) / count;
  std::map<std::array<long, 3>, Voxel> voxels;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    std::array<long, 3> key;
    for (int k = 0; k < 3; ++k) key[k] = long(std::floor((points(k, i) - low) / side));
    Voxel& voxel = voxels[key];
    voxel.sum += points.col(i);
    ++voxel.points;
  }
  Eigen::Matrix3Xd means(3, voxels.size());
  Eigen::Index at = 0;
  for (const auto& [key, voxel] : voxels) means.col(at++) = voxel.sum / double(voxel.points);
  return means;
}

Score score(const Eigen::Matrix3Xd& prediction, const Eigen::Matrix3Xd& truth,
            const std::vector<double>& thresholds, const std::vector<bool>& visible) {
  assert(truth.cols() > 0);
  assert(visible.empty() || Eigen::Index(visible.size()) == truth.cols());
  Score result;
  result.samples = int(prediction.cols());
  result.truth_samples = int(truth.cols());
  const bool empty = prediction.cols() == 0;
  const Eigen::VectorXd to_truth = NearestPoints(truth).distances(prediction);
  const Eigen::VectorXd to_prediction = NearestPoints(prediction).distances(truth);
  const Eigen::VectorXd visible_to_prediction = selected(to_prediction, visible);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  result.accuracy = empty ? nan : to_truth.mean();
  result.completeness = empty ? nan : to_prediction.mean();
  result.visible_samples = int(visible_to_prediction.size());
  const bool seen = result.visible_samples > 0;
  if (!empty) {
    result.to_truth = spread_of(to_truth);
    result.to_prediction = spread_of(to_prediction);
    if (seen) result.completeness_visible = visible_to_prediction.mean();
  }
  for (double threshold : thresholds) {
    Level level;
    level.threshold = threshold;
    const double p = share_below(to_truth, threshold), r = share_below(to_prediction, threshold);
    level.precision = 100 * p;
    level.recall = 100 * r;
    level.f = 100 * f_of(p, r);
    if (seen) {
      const double r_visible = share_below(visible_to_prediction, threshold);
      level.recall_visible = 100 * r_visible;
      level.f_visible = 100 * f_of(p, r_visible);
    }
    result.levels.push_back(level);
  }
  return result;
}

}  // namespace sketchsplat

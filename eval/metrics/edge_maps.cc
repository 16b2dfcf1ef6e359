// SPDX-License-Identifier: MIT
#include "eval/metrics/edge_maps.h"

#include <algorithm>
#include <cmath>

#include "eval/metrics/nearest.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

constexpr double kSpacing = 0.1;  // [px] of the samples that stand for a polyline

Eigen::Matrix3Xd flat(const Eigen::Matrix2Xd& points) {
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, points.cols());
  out.topRows<2>() = points;
  return out;
}

// Evenly spaced along each segment, in its middle parts: every sample stands for the same length.
Eigen::Matrix2Xd sample(const std::vector<Eigen::Matrix2Xd>& polylines) {
  std::vector<Eigen::Vector2d> samples;
  for (const Eigen::Matrix2Xd& line : polylines) {
    double due = kSpacing / 2, walked = 0;
    for (Eigen::Index i = 0; i + 1 < line.cols(); ++i) {
      const Eigen::Vector2d d = line.col(i + 1) - line.col(i);
      const double length = d.norm();
      for (; due < walked + length; due += kSpacing)
        samples.push_back(line.col(i) + d * ((due - walked) / length));
      walked += length;
    }
  }
  Eigen::Matrix2Xd out(2, samples.size());
  for (size_t i = 0; i < samples.size(); ++i) out.col(i) = samples[i];
  return out;
}

double share_within(const Eigen::VectorXd& distances, double tolerance) {
  if (distances.size() == 0) return 0;
  return double((distances.array() <= tolerance).count()) / double(distances.size());
}

}  // namespace

EdgeMapScore score_edge_points(const Eigen::Matrix2Xd& points,
                               const std::vector<Eigen::Matrix2Xd>& truth, double tolerance_px) {
  EdgeMapScore score;
  const Eigen::Matrix2Xd samples = sample(truth);
  if (points.cols() == 0 && samples.cols() == 0) return {1, 1, 1, 0};
  const Eigen::VectorXd off = NearestPoints(flat(samples)).distances(flat(points));
  score.precision = share_within(off, tolerance_px);
  score.recall = share_within(NearestPoints(flat(points)).distances(flat(samples)), tolerance_px);
  const double sum = score.precision + score.recall;
  if (sum > 0) score.f = 2 * score.precision * score.recall / sum;
  double squares = 0;
  int count = 0;
  for (double d : off)
    if (d <= tolerance_px) squares += d * d, ++count;
  if (count > 0) score.rms_px = std::sqrt(squares / count);
  return score;
}

std::vector<Eigen::Matrix2Xd> read_edge_polylines(const std::string& path) {
  const JsonValue root = load_json(path);
  std::vector<Eigen::Matrix2Xd> polylines;
  for (const JsonValue& line : root["polylines"].elements()) {
    const int n = int(line.elements().size());
    if (n < 2) line.complain("two points or more");
    polylines.push_back(line.matrix(n, 2).transpose());
    if (!polylines.back().allFinite()) line.complain("finite numbers");
  }
  return polylines;
}

}  // namespace sketchsplat

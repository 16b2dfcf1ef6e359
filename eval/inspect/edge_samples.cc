// SPDX-License-Identifier: MIT
#include "eval/inspect/edge_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

constexpr int kMostCells = 64;  // along the longest side

}  // namespace

EdgeSamples sample_edges(const Sketch& sketch, double spacing, int least) {
  std::vector<Eigen::Vector3d> positions, tangents;
  EdgeSamples out;
  out.first.push_back(0);
  for (int s = 0; s < sketch.size(); ++s) {
    const double length = stroke_length(sketch, s);
    const bool closed = is_closed(sketch.strokes[s].kind);
    const int pieces = std::max(closed ? least : least - 1, int(std::ceil(length / spacing)));
    const int count = closed ? pieces : pieces + 1;
    std::vector<double> fractions;
    for (int i = 0; i < count; ++i) fractions.push_back((i + (closed ? 0.5 : 0.0)) / pieces);
    const std::vector<double> t = arc_length_parameters(sketch, s, fractions);
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3d p, d;
      evaluate_stroke(sketch, s, t[i], &p, &d);
      positions.push_back(p);
      tangents.push_back(d.stableNormalized());
      out.stroke.push_back(s);
      out.t.push_back(t[i]);
      out.length.push_back(length / pieces * (!closed && (i == 0 || i == pieces) ? 0.5 : 1.0));
    }
    out.first.push_back(out.size());
  }
  out.position.resize(3, out.size());
  out.tangent.resize(3, out.size());
  for (int i = 0; i < out.size(); ++i)
    out.position.col(i) = positions[i], out.tangent.col(i) = tangents[i];
  return out;
}

SampleGrid::SampleGrid(const EdgeSamples& samples, double reach) : samples_(samples) {
  if (samples.size() == 0) return;
  low_ = samples.position.rowwise().minCoeff();
  const Eigen::Vector3d span = samples.position.rowwise().maxCoeff() - low_;
  cell_ = std::max({reach, span.maxCoeff() / kMostCells, 1e-300});
  size_ = (span / cell_).array().floor().cast<int>() + 1;
  const auto cell_of = [&](int i) {
    const Eigen::Array3i c = ((samples.position.col(i) - low_) / cell_).array().floor().cast<int>();
    return (c.z() * size_.y() + c.y()) * size_.x() + c.x();
  };
  first_.assign(size_t(size_.prod()) + 1, 0);
  for (int i = 0; i < samples.size(); ++i) ++first_[cell_of(i) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  order_.resize(samples.size());
  for (int i = 0; i < samples.size(); ++i) order_[next[cell_of(i)]++] = i;
}

int SampleGrid::nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& tangent, double reach,
                        double least_cosine) const {
  const Eigen::Array3d at = ((point - low_) / cell_).array();
  if (!(at > -1).all() || !(at < size_.cast<double>() + 1).all()) return -1;
  const Eigen::Array3i c = at.floor().cast<int>();
  const Eigen::Array3i from = (c - 1).max(0), to = (c + 1).min(size_ - 1);
  int best = -1;
  double least = reach * reach;
  for (int z = from.z(); z <= to.z(); ++z)
    for (int y = from.y(); y <= to.y(); ++y) {
      const int row = (z * size_.y() + y) * size_.x();
      if (from.x() > to.x()) continue;
      for (int k = first_[row + from.x()]; k < first_[row + to.x() + 1]; ++k) {
        const int i = order_[k];
        const double d2 = (samples_.position.col(i) - point).squaredNorm();
        if (d2 > least || std::abs(samples_.tangent.col(i).dot(tangent)) < least_cosine) continue;
        least = d2, best = i;
      }
    }
  return best;
}

}  // namespace sketchsplat

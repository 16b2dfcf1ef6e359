// SPDX-License-Identifier: MIT
#include "eval/metrics/duplicates.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "eval/metrics/metrics.h"

namespace sketchsplat {
namespace {

constexpr double kNear = 5e-3;
constexpr double kSpacing = 1e-3;
constexpr double kReach = 0.6;  // of a piece, from its middle: to its end and a little more
const double kParallel = std::cos(15 * M_PI / 180);

struct Sample {
  Eigen::Vector3d position, tangent;
  double length;  // that it stands for
  int stroke;
};

// Middles of equal pieces of each stroke.
std::vector<Sample> samples_of(const std::vector<Eigen::Matrix3Xd>& strokes) {
  std::vector<Sample> samples;
  for (size_t s = 0; s < strokes.size(); ++s) {
    const Eigen::Matrix3Xd p = resample(strokes[s], kSpacing);
    for (Eigen::Index i = 0; i + 1 < p.cols(); ++i) {
      const Eigen::Vector3d chord = p.col(i + 1) - p.col(i);
      const double length = chord.norm();
      if (!(length > 0)) continue;
      samples.push_back({(p.col(i) + p.col(i + 1)) / 2, chord / length, length, int(s)});
    }
  }
  return samples;
}

using Cell = std::array<std::int64_t, 3>;
struct CellHash {
  size_t operator()(const Cell& c) const {
    std::uint64_t h = 0;
    for (std::int64_t k : c) h = (h ^ std::uint64_t(k)) * 0x9e3779b97f4a7c15u;
    return size_t(h ^ (h >> 32));
  }
};

Cell cell_of(const Eigen::Vector3d& p) {
  Cell cell;
  for (int k = 0; k < 3; ++k) cell[k] = std::int64_t(std::floor(p[k] / kNear));
  return cell;
}

// Beside, not ahead: a smooth continuation is as near and as parallel.
bool runs_beside(const Sample& a, const Sample& b) {
  if (a.stroke == b.stroke) return false;
  const Eigen::Vector3d offset = b.position - a.position;
  return offset.squaredNorm() < kNear * kNear && std::abs(a.tangent.dot(b.tangent)) > kParallel &&
         std::abs(offset.dot(b.tangent)) <= kReach * b.length;
}

}  // namespace

double duplicated_share(const std::vector<Eigen::Matrix3Xd>& strokes) {
  const std::vector<Sample> samples = samples_of(strokes);
  std::unordered_map<Cell, std::vector<int>, CellHash> cells;
  for (size_t i = 0; i < samples.size(); ++i) {
    cells[cell_of(samples[i].position)].push_back(int(i));
  }
  const auto is_duplicated = [&](const Sample& sample) {
    const Cell middle = cell_of(sample.position);
    for (int n = 0; n < 27; ++n) {
      const auto cell =
          cells.find({middle[0] + n / 9 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n % 3 - 1});
      if (cell == cells.end()) continue;
      for (int other : cell->second) {
        if (runs_beside(sample, samples[size_t(other)])) return true;
      }
    }
    return false;
  };
  double length = 0, duplicated = 0;
  for (const Sample& sample : samples) {
    length += sample.length;
    if (is_duplicated(sample)) duplicated += sample.length;
  }
  return length > 0 ? 100 * duplicated / length : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace sketchsplat

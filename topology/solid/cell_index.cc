// SPDX-License-Identifier: MIT
#include "topology/solid/cell_index.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

namespace {

constexpr int kBins = 64;

}  // namespace

CellIndex::CellIndex(const Cell& cell, const Layout& layout)
    : period_(layout.period()), again_(layout.periods().y()), bins_(kBins) {
  const FlatBox box = box_of(cell);
  low_ = box.low.y(), high_ = low_ + box.size.y();
  first_ = period_ > 0 ? 0 : box.low.x();
  width_ = std::max((period_ > 0 ? period_ : box.size.x()) / kBins, 1e-300);
  for (const Matrix2Xd& polygon : cell.polygons)
    for (int i = 0; i < polygon.cols(); ++i) {
      const Vector2d a = polygon.col(i);
      Vector2d b = polygon.col((i + 1) % polygon.cols());
      // The last piece of a full turn.
      if (period_ > 0) b.x() += period_ * std::round((a.x() - b.x()) / period_);
      add(a, b);
    }
}

void CellIndex::add(const Vector2d& a, const Vector2d& b) {
  constexpr double kMargin = 1e-9;  // of a bin: rounding must not lose a piece
  const auto bin = [&](double x) { return (x - first_) / width_; };
  const auto low = std::lround(std::floor(bin(std::min(a.x(), b.x())) - kMargin)),
             high = std::lround(std::floor(bin(std::max(a.x(), b.x())) + kMargin));
  if (period_ == 0) {
    for (long k = std::max(low, 0L); k <= std::min(high, long(kBins) - 1); ++k)
      bins_[size_t(k)].push_back({a, b});
    return;
  }
  for (long k = low; k <= high; ++k) {
    const long turns = std::lround(std::floor(double(k) / kBins));
    const Vector2d shift(double(turns) * period_, 0);
    bins_[size_t(k - turns * kBins)].push_back({a - shift, b - shift});
  }
}

bool CellIndex::holds(const Vector2d& flat) const {
  if (again_ == 0) return flat.y() >= low_ && flat.y() <= high_ && is_below_odd(flat);
  for (int k = -1; k <= 1; ++k)
    if (is_below_odd(flat + Vector2d(0, k * again_))) return true;
  return false;
}

// Do an odd number of pieces lie above the point?
bool CellIndex::is_below_odd(const Vector2d& p) const {
  double x = p.x() - first_;
  if (period_ > 0) x -= period_ * std::floor(x / period_);
  if (!(x >= 0) || !(x <= kBins * width_)) return false;
  const size_t bin = std::min(size_t(x / width_), size_t(kBins) - 1);
  x += first_;
  bool odd = false;
  for (const Piece& s : bins_[bin]) {
    if ((s.a.x() > x) == (s.b.x() > x)) continue;
    const double y = s.a.y() + (x - s.a.x()) / (s.b.x() - s.a.x()) * (s.b.y() - s.a.y());
    odd = odd != (p.y() < y);
  }
  return odd;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "topology/faces/pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sketchsplat {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

// Is a cycle inside another, larger one, which does not run around the surface? Of two that cross,
// each may have most of the other inside.
bool lies_in(const Cycle& inner, const Cycle& outer, double period) {
  if (outer.area <= -inner.area) return false;
  const int n = int(inner.polygon.cols());
  int inside = 0;
  for (const int k : {0, n / 3, 2 * n / 3}) {
    Vector2d p = (inner.polygon.col(k) + inner.polygon.col((k + 1) % n)) / 2;
    if (k == n - 1) p = inner.polygon.col(k);
    const double middle = outer.polygon.row(0).mean();
    if (period > 0) p.x() += period * std::round((middle - p.x()) / period);
    inside += is_inside(p, outer.polygon);
  }
  return inside >= 2;
}

double height(const Cycle& c) { return c.polygon.row(1).mean(); }

class Assembly {
 public:
  Assembly(const std::vector<Cycle>& cycles, const Vector2d& period,
           const std::function<double(int)>& pole)
      : cycles_(cycles), period_(period), pole_(pole) {}

  std::vector<SurfacePiece> pieces() {
    for (int i = 0; i < int(cycles_.size()); ++i) {
      if (cycles_[i].area > 0) start(i);
      if (std::abs(cycles_[i].turns) == 1) start_band(i);
    }
    for (int i = 0; i < int(cycles_.size()); ++i)
      if (cycles_[i].turns == 0 && cycles_[i].area <= 0) add_hole(i);
    return pieces_;
  }

 private:
  void start(int cycle) {
    pieces_.emplace_back();
    add(cycle, &pieces_.back());
  }
  void add(int cycle, SurfacePiece* piece) const {
    piece->cycles.push_back(cycle);
    piece->polygons.push_back(cycles_[cycle].polygon);
  }
  const Cycle& first(const SurfacePiece& piece) const { return cycles_[piece.cycles[0]]; }

  // Between a cycle that runs around and the next one above it; a cone may end in its apex instead,
  // and a sphere in a pole.
  void start_band(int cycle) {
    const Cycle& c = cycles_[cycle];
    int other = -1;
    for (int k = 0; k < int(cycles_.size()); ++k) {
      if (cycles_[k].turns != -c.turns || cycles_[k].part == c.part || !(rise(cycle, k) > 0))
        continue;
      if (other < 0 || rise(cycle, k) < rise(cycle, other)) other = k;
    }
    // The next one upwards must look back at this one: else a cycle of the same sense is between.
    if (other >= 0 && c.turns > 0 && !blocked(cycle, other)) {
      start(cycle);
      const double up = height(c) + rise(cycle, other) - height(cycles_[other]);
      add(other, &pieces_.back());
      pieces_.back().polygons.back().row(1).array() += up;
    } else if (other < 0 && !std::isnan(pole_(c.turns))) {
      start(cycle);
      pieces_.back().polygons.push_back(line_at(pole_(c.turns)));
    }
  }
  // How far a cycle lies to the left of another one, in its direction; on a torus by the way there.
  double rise(int from, int to) const {
    const double up = (height(cycles_[to]) - height(cycles_[from])) * cycles_[from].turns;
    return period_.y() > 0 ? up - period_.y() * std::floor(up / period_.y()) : up;
  }
  // What is one point, as a line along the whole layout.
  Matrix2Xd line_at(double at) const {
    Matrix2Xd line(2, 8);
    for (int i = 0; i < 8; ++i) line.col(i) = Vector2d(i * period_.x() / 8, at);
    return line;
  }
  bool blocked(int low, int high) const {
    for (int k = 0; k < int(cycles_.size()); ++k)
      if (cycles_[k].part != cycles_[low].part && cycles_[k].part != cycles_[high].part &&
          cycles_[k].turns == cycles_[low].turns && rise(low, k) > 0 &&
          rise(low, k) < rise(low, high))
        return true;
    return false;
  }

  // The clockwise outside of a part of the graph is a hole of the smallest piece around it.
  void add_hole(int hole) {
    const Cycle& h = cycles_[hole];
    if (walk_has_inside(h.walk)) {  // cut from the walk of a piece that it touches in a node
      for (SurfacePiece& piece : pieces_)
        if (first(piece).walk == h.walk) return add(hole, &piece);
      return;
    }
    const auto area = [&](const SurfacePiece& p) {
      return first(p).turns == 0 ? first(p).area : HUGE_VAL;
    };
    SurfacePiece* best = nullptr;
    for (SurfacePiece& piece : pieces_) {
      const Cycle& outer = first(piece);
      if (outer.part == h.part) continue;
      if (outer.turns == 0 ? !lies_in(h, outer, period_.x()) : !in_band(h, piece)) continue;
      if (!best || area(piece) < area(*best)) best = &piece;
    }
    if (best) add(hole, best);
  }
  bool walk_has_inside(int walk) const {
    return std::any_of(cycles_.begin(), cycles_.end(),
                       [&](const Cycle& c) { return c.walk == walk && c.area > 0; });
  }
  bool in_band(const Cycle& h, const SurfacePiece& band) const {
    if (band.polygons.size() < 2) return false;
    double low = band.polygons[0].row(1).mean(), high = band.polygons[1].row(1).mean();
    if (low > high) std::swap(low, high);
    const double at = period_.y() > 0
                          ? height(h) - period_.y() * std::floor((height(h) - low) / period_.y())
                          : height(h);
    return at > low && at < high;
  }

  const std::vector<Cycle>& cycles_;
  Vector2d period_;
  const std::function<double(int)>& pole_;
  std::vector<SurfacePiece> pieces_;
};

}  // namespace

std::vector<SurfacePiece> pieces_of(const std::vector<Cycle>& cycles, const Vector2d& period,
                                    const std::function<double(int)>& pole) {
  return Assembly(cycles, period, pole).pieces();
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "topology/solid/cells.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "topology/faces/stroke_graph.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Is a corner of a cycle inside another one, which does not run around the surface?
bool lies_in(const Cycle& inner, const Cycle& outer, double period) {
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
  Assembly(const std::vector<Cycle>& cycles, const Layout& layout, int index)
      : cycles_(cycles), layout_(layout), period_(layout.periods()), index_(index) {}

  std::vector<Cell> cells() {
    for (int i = 0; i < int(cycles_.size()); ++i) {
      if (cycles_[i].area > 0) start(i);
      if (std::abs(cycles_[i].turns) == 1) start_band(i);
    }
    for (int i = 0; i < int(cycles_.size()); ++i)
      if (cycles_[i].turns == 0 && cycles_[i].area <= 0) add_hole(i);
    return cells_;
  }

 private:
  void start(int cycle) {
    cells_.emplace_back();
    cells_.back().surface = index_;
    first_.push_back(cycle);
    add(cycle, &cells_.back());
  }
  void add(int cycle, Cell* cell) const {
    cell->loops.push_back(cycles_[cycle].loop);
    cell->polygons.push_back(cycles_[cycle].polygon);
  }

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
      add(other, &cells_.back());
      cells_.back().polygons.back().row(1).array() += up;
    } else if (other < 0 && !std::isnan(layout_.pole(c.turns))) {
      start(cycle);
      cells_.back().polygons.push_back(pole(layout_.pole(c.turns)));
    }
  }
  // How far a cycle lies to the left of another one, in its direction; on a torus by the way there.
  double rise(int from, int to) const {
    const double up = (height(cycles_[to]) - height(cycles_[from])) * cycles_[from].turns;
    return period_.y() > 0 ? up - period_.y() * std::floor(up / period_.y()) : up;
  }
  // What is one point, as a line along the whole layout.
  Matrix2Xd pole(double at) const {
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

  // The clockwise outside of a part of the graph is a hole of the smallest cell around it.
  void add_hole(int hole) {
    const Cycle& h = cycles_[hole];
    if (walk_has_inside(h.walk)) {  // cut from the walk of a cell that it touches in a node
      for (size_t i = 0; i < cells_.size(); ++i)
        if (cycles_[first_[i]].walk == h.walk) return add(hole, &cells_[i]);
      return;
    }
    int best = -1;
    for (int i = 0; i < int(cells_.size()); ++i) {
      const Cycle& outer = cycles_[first_[i]];
      if (outer.part == h.part) continue;
      if (outer.turns == 0 ? !lies_in(h, outer, period_.x()) : !in_band(h, cells_[i])) continue;
      const auto area = [&](int k) {
        const Cycle& c = cycles_[first_[k]];
        return c.turns == 0 ? c.area : HUGE_VAL;
      };
      if (best < 0 || area(i) < area(best)) best = i;
    }
    if (best >= 0) add(hole, &cells_[best]);
  }
  bool walk_has_inside(int walk) const {
    return std::any_of(cycles_.begin(), cycles_.end(),
                       [&](const Cycle& c) { return c.walk == walk && c.area > 0; });
  }
  bool in_band(const Cycle& h, const Cell& band) const {
    if (band.polygons.size() < 2) return false;
    double low = band.polygons[0].row(1).mean(), high = band.polygons[1].row(1).mean();
    if (low > high) std::swap(low, high);
    const double at = period_.y() > 0
                          ? height(h) - period_.y() * std::floor((height(h) - low) / period_.y())
                          : height(h);
    return at > low && at < high;
  }

  const std::vector<Cycle>& cycles_;
  const Layout& layout_;
  Vector2d period_;
  int index_;
  std::vector<Cell> cells_;
  std::vector<int> first_;  // cycle of each cell
};

// How often the ray from a point along the second coordinate meets the polygon, on a surface that
// closes along the first.
int crossings_above(const Matrix2Xd& polygon, const Vector2d& p, double period) {
  int count = 0;
  const int n = int(polygon.cols());
  for (int i = 0; i < n; ++i) {
    Vector2d a = polygon.col(i), b = polygon.col((i + 1) % n);
    b.x() += period * std::round((a.x() - b.x()) / period);  // the last piece of a full turn
    const double shift = period * std::round((p.x() - (a.x() + b.x()) / 2) / period);
    a.x() += shift;
    b.x() += shift;
    if ((a.x() > p.x()) == (b.x() > p.x())) continue;
    count += p.y() < a.y() + (p.x() - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
  }
  return count;
}

}  // namespace

FlatBox box_of(const Cell& cell) {
  Vector2d low = Vector2d::Constant(HUGE_VAL), high = -low;
  for (const Matrix2Xd& polygon : cell.polygons) {
    low = low.cwiseMin(polygon.rowwise().minCoeff());
    high = high.cwiseMax(polygon.rowwise().maxCoeff());
  }
  return {low, high - low};
}

std::vector<Cell> cells_of(const Sketch& sketch, const std::vector<Eigen::Matrix3Xd>& polylines,
                           const SurfaceStrokes& surface, int index) {
  const Layout layout = layout_of(surface);
  std::vector<Matrix2Xd> lines;
  for (const int s : surface.strokes) lines.push_back(layout.flat(polylines[s]));
  const std::vector<Cycle> cycles = simple_cycles(sketch, surface.strokes, lines, layout.periods());
  const auto across = [](const Cycle& c) { return c.turns_across != 0; };
  if (std::any_of(cycles.begin(), cycles.end(), across)) return {};  // laid out the other way round
  return Assembly(cycles, layout, index).cells();
}

bool holds(const Cell& cell, const Layout& layout, const Vector2d& flat) {
  if (layout.period() == 0) {
    int around = 0;
    for (const Matrix2Xd& polygon : cell.polygons) around += is_inside(flat, polygon);
    return around % 2 == 1;
  }
  const double again = layout.periods().y();
  for (int k = again > 0 ? -1 : 0; k <= (again > 0 ? 1 : 0); ++k) {
    int above = 0;
    for (const Matrix2Xd& polygon : cell.polygons)
      above += crossings_above(polygon, flat + Vector2d(0, k * again), layout.period());
    if (above % 2 == 1) return true;
  }
  return false;
}

std::vector<Vector3d> points_within(const Cell& cell, const Layout& layout, int count) {
  const FlatBox box = box_of(cell);
  std::vector<Vector3d> points;
  for (int finer = 1; finer <= 8 && int(points.size()) < (count + 1) / 2; finer *= 2) {
    points.clear();
    const double step = std::sqrt(box.size.x() * box.size.y() / count) / finer;
    // A sliver has one row, of as many columns as it takes.
    const auto places = [&](double side) {
      return int(std::max(1.0, std::min(side / step, double(count) * finer)));
    };
    const int nx = places(box.size.x()), ny = places(box.size.y());
    for (int i = 0; i < nx; ++i)
      for (int k = 0; k < ny; ++k) {
        const Vector2d p = box.at((i + 0.5) / nx, (k + 0.5) / ny);
        if (holds(cell, layout, p)) points.push_back(layout.point(p));
      }
  }
  return points;
}

std::vector<std::pair<Vector3d, Vector3d>> grid_within(const Cell& cell, const Layout& layout,
                                                       int lines) {
  const FlatBox box = box_of(cell);
  const auto at = [&](int i, int k) { return box.at((i + 0.5) / lines, (k + 0.5) / lines); };
  std::vector<bool> inside(size_t(lines) * lines);
  for (int i = 0; i < lines; ++i)
    for (int k = 0; k < lines; ++k) inside[i * lines + k] = holds(cell, layout, at(i, k));
  std::vector<std::pair<Vector3d, Vector3d>> out;
  const auto add = [&](int i, int k, int i2, int k2) {
    if (i2 < lines && k2 < lines && inside[i * lines + k] && inside[i2 * lines + k2])
      out.emplace_back(layout.point(at(i, k)), layout.point(at(i2, k2)));
  };
  for (int i = 0; i < lines; ++i)
    for (int k = 0; k < lines; ++k) {
      add(i, k, i + 1, k);
      add(i, k, i, k + 1);
    }
  return out;
}

}  // namespace sketchsplat

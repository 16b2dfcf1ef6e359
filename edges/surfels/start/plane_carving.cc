// SPDX-License-Identifier: MIT
#include "edges/surfels/start/plane_carving.h"

#include <CGAL/boost/graph/alpha_expansion_graphcut.h>

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <cmath>
#include <map>

#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

constexpr double kStep = 0.5;       // [cells] along a line
constexpr double kLast = 1;         // [cells] before its end that may be solid
constexpr double kLastBlurred = 2;  // the same where neighbours are counted, too
constexpr double kSurface = 0.1;    // price of the side of a cell, for that of a cell
constexpr int kBand = 2;            // [cells] from a new surface in which distances are its
constexpr float kFar = 3;           // [cells] the longest distance that is told

// f(cell, position in the grid, in cells) of the steps along a line through the hull.
template <typename F>
void walk(const SightLine& line, double last, const CellGrid& g, const F& f) {
  const double reach = Eigen::Vector3d(g.nx, g.ny, g.nz).norm();
  const Eigen::Vector3d end = (line.point - g.low) / g.cell;
  const Eigen::Vector3d way = (line.eye - g.low) / g.cell - end;
  const double length = way.norm();
  for (double s = last; s < std::min(length, reach); s += kStep) {
    const Eigen::Vector3d x = end + s / length * way;
    const Eigen::Vector3i q = x.array().floor().cast<int>();
    if (g.inside(q.x(), q.y(), q.z())) f(g.index(q.x(), q.y(), q.z()), x);
  }
}

}  // namespace

PlaneCarving::PlaneCarving(const SureEdges& edges, const std::vector<EdgePlane>& planes,
                           const CellGrid& hull)
    : planes_(planes), hull_(hull) {
  divide();
  cross(edges.lines);
}

PlaneCarving::Sides PlaneCarving::sides(const Eigen::Vector3d& p) const {
  Sides s = 0;
  for (size_t k = 0; k < planes_.size(); ++k) s |= Sides(planes_[k].signedDistance(p) > 0) << k;
  return s;
}

void PlaneCarving::divide() {
  const int n = hull_.size();
  sides_.assign(n, 0), region_.assign(n, -1);
  parallel_for(n, [&](int c) {
    if (hull_.field[c] > 0) sides_[c] = sides(hull_.center(c));
  });
  std::map<Sides, int> number;
  for (int c = 0; c < n; ++c)
    if (hull_.field[c] > 0)
      region_[c] = number.emplace(sides_[c], int(number.size())).first->second;
  regions_ = int(number.size());
}

void PlaneCarving::cross(const std::vector<SightLine>& lines) {
  crossed_.assign(hull_.size(), 0);
  parallel_for(int(lines.size()), [&](int k) {
    walk(lines[k], kLast, hull_, [&](int c, const Eigen::Vector3d& x) {
      // Of a cell that a plane cuts, the other part says nothing about this region.
      if (sides(hull_.low + hull_.cell * x) != sides_[c]) return;
#pragma omp atomic write
      crossed_[c] = 1;
    });
  });
}

std::vector<char> PlaneCarving::empty_regions(double share) const {
  struct Region {
    std::vector<double> price = {0, 0};  // if it is solid, if it is empty
    std::size_t label = 0;
  };
  struct Side {
    double price = 0;
  };
  using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, Region, Side>;
  Graph graph(regions_);
  std::map<std::pair<int, int>, double> area;
  const int stride[3] = {1, hull_.nx, hull_.nx * hull_.ny};
  for (int c = 0; c < hull_.size(); ++c) {
    if (region_[c] < 0) continue;
    graph[region_[c]].price[0] += crossed_[c];
    graph[region_[c]].price[1] += share;
    for (const int s : stride) {  // nothing of the hull is at the rim of the grid
      const int other = region_[c + s];
      if (other >= 0 && other != region_[c]) area[std::minmax(region_[c], other)] += kSurface;
    }
  }
  for (const auto& [pair, price] : area)
    boost::add_edge(pair.first, pair.second, Side{price}, graph);
  // Of two labels, alpha expansion finds the minimum.
  CGAL::alpha_expansion_graphcut(
      graph, get(&Side::price, graph), get(&Region::price, graph), get(&Region::label, graph),
      CGAL::parameters::vertex_index_map(get(boost::vertex_index, graph))
          .implementation_tag(CGAL::Alpha_expansion_boost_compressed_sparse_row_tag()));
  std::vector<char> empty(regions_);
  for (int r = 0; r < regions_; ++r) empty[r] = graph[r].label == 1;
  return empty;
}

// [cells] to the new surface, which lies in the planes between cells that stay and cells that go.
double PlaneCarving::distance(int cell, const std::vector<char>& gone) const {
  const int i = cell % hull_.nx, j = cell / hull_.nx % hull_.ny, k = cell / (hull_.nx * hull_.ny);
  const Eigen::Vector3d x = hull_.center(cell);
  double least = kFar * hull_.cell;
  for (int dk = -kBand; dk <= kBand; ++dk)
    for (int dj = -kBand; dj <= kBand; ++dj)
      for (int di = -kBand; di <= kBand; ++di) {
        if (!hull_.inside(i + di, j + dj, k + dk)) continue;
        const int other = hull_.index(i + di, j + dj, k + dk);
        if (gone[other] == gone[cell]) continue;
        double most = 0;
        for (size_t p = 0; p < planes_.size(); ++p)
          if ((sides_[cell] ^ sides_[other]) >> p & 1)
            most = std::max(most, planes_[p].absDistance(x));
        least = std::min(least, most);
      }
  return least / hull_.cell;
}

int PlaneCarving::carve(double share, CellGrid* grid) const {
  *grid = hull_;
  if (regions_ < 2) return 0;  // nothing to tell apart
  constexpr float kLeast = 1e-3f;
  const std::vector<char> empty = empty_regions(share);
  if (std::count(empty.begin(), empty.end(), 1) == 0) return 0;
  std::vector<char> gone(hull_.size(), 0);
  for (int c = 0; c < hull_.size(); ++c) gone[c] = region_[c] >= 0 && empty[region_[c]];
  parallel_for(hull_.size(), 1024, [&](int c) {
    if (region_[c] < 0) return;
    const float d = std::max(kLeast, float(distance(c, gone)));
    grid->field[c] = gone[c] ? -d : std::min(hull_.field[c], d);
  });
  return int(std::count(gone.begin(), gone.end(), 1));
}

int carve_crossed(const std::vector<SightLine>& lines, double least, CellGrid* grid) {
  std::vector<int> count(grid->size(), 0);
  parallel_for(int(lines.size()), [&](int k) {
    int before = -1;
    walk(lines[k], kLastBlurred, *grid, [&](int c, const Eigen::Vector3d&) {
      if (c == before) return;
      before = c;
#pragma omp atomic
      ++count[c];
    });
  });
  // Lines are thin: those of a neighbourhood count together.
  for (const int s : {1, grid->nx, grid->nx * grid->ny}) {
    const std::vector<int> single = count;
    for (int c = s; c + s < grid->size(); ++c) count[c] = single[c - s] + single[c] + single[c + s];
  }
  int carved = 0;
  for (int c = 0; c < grid->size(); ++c) {
    if (!(grid->field[c] > 0) || count[c] < 27 * least) continue;
    grid->field[c] = -1;
    ++carved;
  }
  return carved;
}

}  // namespace sketchsplat

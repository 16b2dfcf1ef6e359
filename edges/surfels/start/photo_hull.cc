// SPDX-License-Identifier: MIT
#include "edges/surfels/start/photo_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>

#include "datasets/neighbours/kd_tree.h"
#include "datasets/types/parallel.h"
#include "edges/image/mats.h"
#include "edges/surfels/start/edge_planes.h"
#include "edges/surfels/start/plane_carving.h"

namespace sketchsplat {
namespace {

constexpr double kCellPx = 2;            // [px] of a cell in the pictures that are compared, about
constexpr int kFewestViews = 4;          // that may condemn a cell
constexpr double kMostUncovered = 0.01;  // share of the masks that carving may lay bare
constexpr double kMostPierced = 0.002;   // the same of carving by lines of sight
constexpr int kShares = 3;      // of crossed cells that are tried, one, two and three times
constexpr double kCrossed = 1;  // lines of sight through a cell that empty it, mean

// What a view says about cells.
struct Witness {
  View view;
  cv::Mat1f inside;     // distance to the outline [px], negative outside the mask
  cv::Mat1f low, high;  // least and largest grey within a cell's footprint
  cv::Mat1f depth;      // of the nearest cell
  int radius = 1;       // [px] of a cell

  bool project(const Eigen::Vector3d& p, int* x, int* y, double* z) const {
    const Eigen::Vector2d q = view.project(p, z);
    if (!(*z > 0 && view.camera.contains(q))) return false;
    *x = int(q.x() + 0.5), *y = int(q.y() + 0.5);
    return true;
  }
};

cv::Mat1f signed_distance(const Image<float>& alpha) {
  const cv::Mat1f a = mat_of(alpha);
  cv::Mat1b in = a >= 0.5f, out = a < 0.5f;
  cv::Mat1f to_out, to_in;
  cv::distanceTransform(in, to_out, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(out, to_in, cv::DIST_L2, cv::DIST_MASK_5);
  // Distances are to centres of pixels; the outline is half a pixel nearer.
  cv::Mat1f d(a.size());
  for (int i = 0; i < a.rows * a.cols; ++i) {
    const int y = i / a.cols, x = i % a.cols;
    d(y, x) = in(y, x) ? to_out(y, x) - 0.5f : 0.5f - to_in(y, x);
  }
  return d;
}

Witness make_witness(const TrainingView& full, double cell, const Eigen::Vector3d& middle) {
  const Camera& camera = full.view.camera;
  const double distance = std::max(1e-9, (full.view.cam_from_world * middle).z());
  const double ratio = kCellPx * distance / (camera.fx * cell);
  const TrainingView small = shrink(
      full,
      std::max(16, int(std::lround(std::min(ratio, 1.0) * std::max(camera.width, camera.height)))));
  Witness w;
  w.view = small.view;
  w.inside = signed_distance(small.alpha);
  const cv::Mat1f grey =
      (mat_of(small.color[0]) + mat_of(small.color[1]) + mat_of(small.color[2])) / 3;
  w.radius = std::max(1, int(std::ceil(0.7 * cell * w.view.camera.fx / distance)));
  const cv::Mat kernel =
      cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * w.radius + 1, 2 * w.radius + 1));
  cv::erode(grey, w.low, kernel, cv::Point(-1, -1), 1, cv::BORDER_REPLICATE);
  cv::dilate(grey, w.high, kernel, cv::Point(-1, -1), 1, cv::BORDER_REPLICATE);
  return w;
}

CellGrid visual_hull(const std::vector<Witness>& witnesses, const Eigen::AlignedBox3d& bounds,
                     int cells) {
  CellGrid g;
  g.cell = bounds.sizes().maxCoeff() / cells;
  g.low = bounds.min() - Eigen::Vector3d::Constant(2 * g.cell);
  const Eigen::Vector3d n = (bounds.sizes() / g.cell).array().ceil() + 4;
  g.nx = int(n.x()), g.ny = int(n.y()), g.nz = int(n.z());
  g.field.assign(g.size(), 0);
  constexpr float kFar = 3;  // cells
  parallel_for(g.size(), 256, [&](int c) {
    float f = kFar;
    for (const Witness& w : witnesses) {
      int x, y;
      double z;
      if (!w.project(g.center(c), &x, &y, &z)) continue;
      f = std::min(f, float(w.inside(y, x) * z / (w.view.camera.fx * g.cell)));
      if (f <= -kFar) break;
    }
    g.field[c] = std::max(f, -kFar);
  });
  // What no view looks at is not known to be there.
  for (int c = 0; c < g.size(); ++c) {
    const int i = c % g.nx, j = c / g.nx % g.ny, k = c / (g.nx * g.ny);
    if (!i || !j || !k || i == g.nx - 1 || j == g.ny - 1 || k == g.nz - 1) g.field[c] = -kFar;
  }
  return g;
}

void draw_depth(const CellGrid& g, const std::vector<int>& surface, Witness* w) {
  w->depth = cv::Mat1f(w->inside.size(), std::numeric_limits<float>::max());
  for (const int c : surface) {
    int x, y;
    double z;
    if (!w->project(g.center(c), &x, &y, &z)) continue;
    for (int v = std::max(0, y - w->radius); v <= std::min(w->depth.rows - 1, y + w->radius); ++v)
      for (int u = std::max(0, x - w->radius); u <= std::min(w->depth.cols - 1, x + w->radius); ++u)
        w->depth(v, u) = std::min(w->depth(v, u), float(z));
  }
}

// Can so many of the views that see the cell see one grey there?
bool consistent(const Eigen::Vector3d& p, const std::vector<Witness>& witnesses, double cell,
                const PhotoHullOptions& options) {
  std::vector<std::pair<float, int>> ends;
  int seen = 0;
  for (const Witness& w : witnesses) {
    int x, y;
    double z;
    if (!w.project(p, &x, &y, &z) || z > w.depth(y, x) + 1.5 * cell) continue;
    ends.push_back({w.low(y, x) - float(options.tolerance), -1});
    ends.push_back({w.high(y, x) + float(options.tolerance), 1});
    ++seen;
  }
  if (seen < kFewestViews) return true;
  std::sort(ends.begin(), ends.end());
  int open = 0, most = 0;
  for (const auto& end : ends) most = std::max(most, open -= end.second);
  return most >= options.agree * seen;
}

std::vector<int> surface_of(const CellGrid& g) {
  std::vector<int> surface;
  for (int c = 0; c < g.size(); ++c)
    if (g.on_surface(c)) surface.push_back(c);
  return surface;
}

void draw_depths(const CellGrid& g, const std::vector<int>& surface,
                 std::vector<Witness>* witnesses) {
  parallel_for(int(witnesses->size()), 1, [&](int w) { draw_depth(g, surface, &(*witnesses)[w]); });
}

int carve(const PhotoHullOptions& options, std::vector<Witness>* witnesses, CellGrid* g) {
  int carved = 0;
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    const std::vector<int> surface = surface_of(*g);
    draw_depths(*g, surface, witnesses);
    std::vector<char> gone(surface.size(), 0);
    parallel_for(int(surface.size()), 64, [&](int s) {
      gone[s] = !consistent(g->center(surface[s]), *witnesses, g->cell, options);
    });
    int count = 0;
    for (size_t s = 0; s < surface.size(); ++s)
      if (gone[s]) g->field[surface[s]] = -1, ++count;
    carved += count;
    if (count * 2000 < int(surface.size())) break;
  }
  return carved;
}

// Share of the masks, without their rims, where no cell is.
double uncovered(const CellGrid& g, std::vector<Witness>* witnesses) {
  draw_depths(g, surface_of(g), witnesses);
  double bare = 0, all = 0;
  for (const Witness& w : *witnesses) {
    const cv::Mat1b inner = w.inside > float(w.radius);
    all += cv::countNonZero(inner);
    bare += cv::countNonZero(inner & (w.depth == std::numeric_limits<float>::max()));
  }
  return all > 0 ? bare / all : 0;
}

// Between planes first: the more lines are wrong, the larger the share of a region's cells that
// they must cross. Then cell by cell.
void carve_sights(const SureEdges& sure, const PhotoHullOptions& options,
                  std::vector<Witness>* witnesses, CellGrid* grid, SurfaceSamples* samples) {
  const double share = options.sights;
  if (share <= 0 || sure.lines.empty()) return;
  const CellGrid hull = *grid;
  const double most = uncovered(hull, witnesses) + kMostPierced;
  const std::vector<EdgePlane> planes = edge_planes(sure, options.seed);
  samples->planes = int(planes.size());
  const PlaneCarving carving(sure, planes, hull);
  for (int times = 1; times <= kShares && times * share < 1; ++times) {
    samples->emptied = carving.carve(times * share, grid);
    if (uncovered(*grid, witnesses) <= most) break;
    *grid = hull, samples->emptied = 0;
  }
  const CellGrid flat = *grid;
  const int crossed = carve_crossed(sure.lines, kCrossed, grid);
  if (crossed > 0 && uncovered(*grid, witnesses) > most)
    *grid = flat;
  else
    samples->emptied += crossed;
}

// Cells are steps; a surface is not.
void smooth(CellGrid* g) {
  const float kernel[3] = {0.25f, 0.5f, 0.25f};
  const int stride[3] = {1, g->nx, g->nx * g->ny};
  for (int pass = 0; pass < 2; ++pass)
    for (const int s : stride) {
      std::vector<float> out = g->field;
      for (int c = s; c + s < g->size(); ++c)
        out[c] =
            kernel[0] * g->field[c - s] + kernel[1] * g->field[c] + kernel[2] * g->field[c + s];
      g->field.swap(out);
    }
}

struct Crossing {
  Eigen::Vector3d position, normal;
};

// Where the field changes its sign along the grid's lines, and the area of the surface (each axis
// counts the surface's shadow along it).
std::vector<Crossing> crossings(const CellGrid& g, double* area) {
  const int stride[3] = {1, g.nx, g.nx * g.ny};
  const auto gradient = [&](int c) {
    Eigen::Vector3d d;
    for (int a = 0; a < 3; ++a) d[a] = g.field[c + stride[a]] - g.field[c - stride[a]];
    return d;
  };
  std::vector<Crossing> out;
  *area = 0;
  for (int k = 1; k < g.nz - 2; ++k)
    for (int j = 1; j < g.ny - 2; ++j)
      for (int i = 1; i < g.nx - 2; ++i)
        for (int a = 0; a < 3; ++a) {
          const int c = g.index(i, j, k), d = c + stride[a];
          if ((g.field[c] > 0) == (g.field[d] > 0)) continue;
          const double t = g.field[c] / (double(g.field[c]) - g.field[d]);
          Crossing x;
          x.position = (1 - t) * g.center(c) + t * g.center(d);
          x.normal = -((1 - t) * gradient(c) + t * gradient(d));
          if (!(x.normal.norm() > 1e-9)) continue;
          x.normal.normalize();
          *area += g.cell * g.cell * std::abs(x.normal[a]);
          out.push_back(x);
        }
  return out;
}

// Points no nearer to each other than `spacing`, drawn in a disorder that the seed fixes.
std::vector<Crossing> thinned(std::vector<Crossing> all, double spacing, int seed) {
  std::mt19937 random(1u + seed);
  for (size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[random() % i]);
  Eigen::Matrix3Xd positions(3, all.size());
  for (size_t i = 0; i < all.size(); ++i) positions.col(i) = all[i].position;
  const KdTree tree(positions);
  std::vector<char> gone(all.size(), 0);
  std::vector<Crossing> out;
  for (size_t i = 0; i < all.size(); ++i) {
    if (gone[i]) continue;
    out.push_back(all[i]);
    for (const int j : tree.within(all[i].position, spacing)) gone[j] = 1;
  }
  return out;
}

}  // namespace

SurfaceSamples photo_hull_surface(const std::vector<TrainingView>& views,
                                  const Eigen::AlignedBox3d& bounds, int count,
                                  const PhotoHullOptions& options, const SureEdges& sure) {
  SurfaceSamples samples;
  if (views.empty() || bounds.isEmpty() || !(bounds.sizes().maxCoeff() > 0)) return samples;
  const double cell = bounds.sizes().maxCoeff() / options.cells;
  std::vector<Witness> witnesses(views.size());
  parallel_for(int(views.size()), 1,
               [&](int v) { witnesses[v] = make_witness(views[v], cell, bounds.center()); });
  CellGrid grid = visual_hull(witnesses, bounds, options.cells);
  carve_sights(sure, options, &witnesses, &grid, &samples);
  const CellGrid pierced = grid;
  samples.carved = carve(options, &witnesses, &grid);
  if (samples.carved > 0 &&
      uncovered(grid, &witnesses) > uncovered(pierced, &witnesses) + kMostUncovered)
    grid = pierced, samples.carved = 0;
  samples.cell = grid.cell;
  smooth(&grid);
  double area = 0;
  const std::vector<Crossing> all = crossings(grid, &area);
  if (all.empty()) return samples;
  // Points dropped at random until none fits any more cover 0.547 of the plane with their disks.
  samples.spacing = std::sqrt(0.7 * area / count);
  const std::vector<Crossing> kept = thinned(all, samples.spacing, options.seed);
  samples.position.resize(3, kept.size());
  samples.normal.resize(3, kept.size());
  for (size_t i = 0; i < kept.size(); ++i) {
    samples.position.col(i) = kept[i].position;
    samples.normal.col(i) = kept[i].normal;
  }
  return samples;
}

}  // namespace sketchsplat

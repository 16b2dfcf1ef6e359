// SPDX-License-Identifier: MIT
#include "edges/tags/tag_square.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/image/edgel_map.h"
#include "edges/tags/tag_edges.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

constexpr int kFewestViews = 3;
constexpr int kManyViews = 10;       // that tell how much views scatter
constexpr int kFewestEdges = 24;     // of a view
constexpr int kRounds = 12;          // of measuring and solving
constexpr double kSmallestCell = 3;  // [px] smaller cells blur into one another
constexpr double kWidestWindow = 4;  // [px] to either side of an edge
constexpr double kLeastRise = 0.04;  // of linear light from black to white
constexpr double kStrayShare =
    0.15;                            // of the side in pixels, by which a corner may be off at first
constexpr double kStrayTimes = 5;    // the usual scatter: a view that does not fit
constexpr double kBiweight = 4.685;  // Huber & Ronchetti, Robust Statistics, 2009
constexpr double kShiftPx = 0.5;     // standard deviation of what a view makes of black's breadth
constexpr double kPixelFloor = 0.003;  // [px] by which no number of views measures a side better
constexpr double kBorder = 0.125;      // of the side: the white one
constexpr double kClearPx = 3;         // around what is left out

const Vector2d kCorners[4] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};

// Where the view's image shows a place of the tag, and how that moves with it.
bool seen_at(const View& view, const Vector3d& world, Vector2d* image,
             Eigen::Matrix<double, 2, 3>* jacobian) {
  const Vector3d p = view.cam_from_world * world;
  if (!(p.z() > 0)) return false;
  Eigen::Matrix2d lens;
  if (!view.image_pixel(view.camera.project(p), image, &lens)) return false;
  *jacobian = lens * view.camera.project_jacobian(p) * view.cam_from_world.rotation;
  return true;
}

// The point nearest to the rays of these pixels; NaN if they do not tell.
Vector3d meet(const std::vector<View>& views, const std::vector<const TagPatch*>& patches,
              int corner) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (const TagPatch* p : patches) {
    const View& view = views[p->view];
    Vector2d ideal;
    if (!view.ideal_pixel(p->tag.corners.col(corner), &ideal)) continue;
    const Vector3d ray =
        (view.cam_from_world.rotation.transpose() * view.camera.ray(ideal)).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    A += across;
    b += across * view.center_in_world();
  }
  return solve_symmetric(A, b);
}

double sighted_side_px(const TagPatch& patch) {
  const auto& c = patch.tag.corners;
  return std::sqrt(0.5 * std::abs((c(0, 2) - c(0, 0)) * (c(1, 3) - c(1, 1)) -
                                  (c(0, 3) - c(0, 1)) * (c(1, 2) - c(1, 0))));
}

// From four points in space.
TagSquare square_of(const std::array<Vector3d, 4>& p, int id) {
  TagSquare s;
  s.id = id;
  s.centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  const Vector3d x = 0.5 * (p[1] - p[0] + p[2] - p[3]), y = 0.5 * (p[3] - p[0] + p[2] - p[1]);
  s.side = std::sqrt(x.norm() * y.norm());
  Eigen::Matrix3d axes;
  axes << x.normalized(), y.normalized(), x.cross(y).normalized();
  s.axes = nearest_rotation(axes);
  return s;
}

// Largest miss of a corner, in sides of the tag as the view sees it.
double miss(const View& view, const TagPatch& patch, const TagSquare& square) {
  double most = 0;
  for (int k = 0; k < 4; ++k) {
    Vector2d q;
    Eigen::Matrix<double, 2, 3> ignored;
    if (!seen_at(view, square.at(kCorners[k].x(), kCorners[k].y()), &q, &ignored)) return INFINITY;
    most = std::max(most, (q - patch.tag.corners.col(k)).norm());
  }
  return most / sighted_side_px(patch);
}

// From the corners as they were found; leaves out the views that say something else.
std::optional<TagSquare> first_square(const std::vector<View>& views,
                                      std::vector<const TagPatch*>* patches) {
  while (int(patches->size()) >= kFewestViews) {
    std::array<Vector3d, 4> corners;
    for (int k = 0; k < 4; ++k) corners[k] = meet(views, *patches, k);
    const TagSquare square = square_of(corners, patches->front()->tag.id);
    std::vector<double> misses;
    for (const TagPatch* p : *patches) misses.push_back(miss(views[p->view], *p, square));
    const auto worst = std::max_element(misses.begin(), misses.end());
    if (*worst <= kStrayShare && square.side > 0) return square;
    patches->erase(patches->begin() + (worst - misses.begin()));
  }
  return std::nullopt;
}

// What a view says: after a change d of the square, its edges are off by offset - row . d - shift.
struct Measured {
  std::vector<Vector7d> row;   // by centre (3), turn (3), logarithm of the side
  std::vector<double> offset;  // [px] towards white
  double shift = 0;            // [px] that they have in common: black is so much broader

  // Sums over the edges with their weights.
  double weight = 0;
  Vector7d mean_row = Vector7d::Zero();
};

Measured measure(const View& view, const TagPatch& patch, const std::vector<TagEdge>& edges,
                 const TagSquare& square, double cell) {
  Measured out;
  for (const TagEdge& e : edges) {
    const Vector3d x = square.at(e.place.x(), e.place.y());
    Vector2d q;
    Eigen::Matrix<double, 2, 3> J;
    if (!seen_at(view, x, &q, &J)) continue;
    const auto image_way = [&](const Vector2d& way) {
      return Vector2d(square.side * J * (square.axes.leftCols<2>() * way));
    };
    const Vector2d along = image_way(e.along).normalized(), white = image_way(e.white);
    Vector2d normal(-along.y(), along.x());
    if (normal.dot(white) < 0) normal = -normal;
    const double cell_px = cell * normal.dot(white);
    double offset;
    if (cell_px < kSmallestCell ||
        !edge_offset(patch, q, normal, std::min(kWidestWindow, 0.5 * cell_px), kLeastRise, &offset))
      continue;
    const Eigen::RowVector3d by_point = normal.transpose() * J;
    const Vector3d arm = x - square.centre;
    Vector7d row;
    row << by_point.transpose() * square.side, arm.cross(by_point.transpose()), by_point.dot(arm);
    out.row.push_back(row);
    out.offset.push_back(offset);
  }
  out.shift = median(out.offset);
  return out;
}

double biweight(double x) {
  return std::abs(x) < kBiweight ? std::pow(1 - std::pow(x / kBiweight, 2), 2) : 0;
}

// The equations of all views, each view's shift eliminated.
struct Equations {
  Matrix7d A = Matrix7d::Zero();
  Vector7d b = Vector7d::Zero();
  Matrix7d between = Matrix7d::Zero();  // of the views' sums, which have zero mean
  double squares = 0, weight = 0;
};

double scatter(const std::vector<Measured>& all) {
  std::vector<double> size;
  for (const Measured& m : all)
    for (const double o : m.offset) size.push_back(std::abs(o - m.shift));
  return std::max(normal_sigma(size), 1e-3);
}

Equations equations(std::vector<Measured>* all, double sigma) {
  Equations e;
  for (Measured& m : *all) {
    Matrix7d rows = Matrix7d::Zero();
    Vector7d sum = Vector7d::Zero(), by_row = Vector7d::Zero();
    double weight = 0, offset = 0;
    std::vector<double> w;
    for (size_t i = 0; i < m.row.size(); ++i) {
      w.push_back(biweight((m.offset[i] - m.shift) / sigma));
      weight += w[i], offset += w[i] * m.offset[i];
      sum += w[i] * m.row[i], by_row += w[i] * m.offset[i] * m.row[i];
      rows += w[i] * m.row[i] * m.row[i].transpose();
    }
    const double held = weight + std::pow(sigma / kShiftPx, 2);
    m.shift = offset / held;
    e.A += rows - sum * sum.transpose() / held;
    const Vector7d b = by_row - sum * m.shift;
    e.b += b;
    e.between += b * b.transpose();
    e.weight += weight;
    for (size_t i = 0; i < m.row.size(); ++i)
      e.squares += w[i] * std::pow(m.offset[i] - m.shift, 2);
  }
  return e;
}

void move(const Vector7d& d, TagSquare* s) {
  s->centre += s->side * d.head<3>();
  s->axes = rotation_about(d.segment<3>(3)) * s->axes;
  s->side *= std::exp(d[6]);
}

// Views whose edges lie elsewhere, or that show too few: they look at something else.
void drop_strays(std::vector<const TagPatch*>* patches, std::vector<Measured>* all) {
  std::vector<double> rms;
  for (const Measured& m : *all) {
    std::vector<double> size;
    for (const double o : m.offset) size.push_back(std::abs(o - m.shift));
    rms.push_back(int(size.size()) < kFewestEdges ? INFINITY : median(size));
  }
  const double usual = median(rms);
  for (size_t i = rms.size(); i-- > 0;)
    if (!(rms[i] <= kStrayTimes * usual)) {
      patches->erase(patches->begin() + i);
      all->erase(all->begin() + i);
    }
}

// Standard deviation of the logarithm of the side at the solution.
double log_sigma(const Equations& e, const std::vector<const TagPatch*>& patches) {
  const Matrix7d inverse = solve_symmetric(e.A, Matrix7d::Identity());
  const double n = double(patches.size());
  // Views were fitted, by some three numbers more than the number of interest is worth.
  const double between = n / std::max(1.0, n - 3) * (inverse * e.between * inverse)(6, 6);
  // Few views do not tell how they scatter; places on one side of a cell err together.
  const double edges = n < kManyViews ? 3 * e.squares / e.weight * inverse(6, 6) : 0;
  std::vector<double> sides;
  for (const TagPatch* p : patches) sides.push_back(sighted_side_px(*p));
  return std::sqrt(std::max(edges, between) + std::pow(kPixelFloor / median(sides), 2));
}

std::vector<Measured> measure_all(const std::vector<View>& views,
                                  const std::vector<const TagPatch*>& patches,
                                  const std::vector<TagEdge>& edges, const TagSquare& square,
                                  double cell) {
  std::vector<Measured> all(patches.size());
  parallel_for(int(patches.size()), 1, [&](int i) {
    all[i] = measure(views[patches[i]->view], *patches[i], edges, square, cell);
  });
  return all;
}

}  // namespace

std::optional<TagSquare> fit_tag(const std::vector<View>& views,
                                 const std::vector<const TagPatch*>& given) {
  std::vector<const TagPatch*> patches = given;
  std::optional<TagSquare> square = first_square(views, &patches);
  if (!square) return std::nullopt;
  const std::vector<TagEdge> edges = tag_edges(square->id);
  const TagBitmap bitmap = tag36h11(square->id);
  const double cell = 1.0 / (bitmap.cells.width - 2 * bitmap.border);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Measured> all = measure_all(views, patches, edges, *square, cell);
    if (round > 1) drop_strays(&patches, &all);
    if (int(patches.size()) < kFewestViews) return std::nullopt;
    const Equations e = equations(&all, scatter(all));
    const Vector7d step = solve_symmetric(e.A, e.b);
    if (!(e.weight > kFewestEdges) || !step.allFinite()) return std::nullopt;
    square->views = int(patches.size());
    square->rms_px = std::sqrt(e.squares / e.weight);
    square->sigma = square->side * log_sigma(e, patches);
    if (round > 2 && step.cwiseAbs().maxCoeff() < 1e-7) break;
    move(step, &*square);
  }
  return square;
}

std::vector<TagSquare> fit_tags(const std::vector<View>& views,
                                const std::vector<TagPatch>& patches) {
  std::map<int, std::vector<const TagPatch*>> of;
  for (const TagPatch& p : patches) of[p.tag.id].push_back(&p);
  std::vector<TagSquare> out;
  for (const auto& [id, sightings] : of)
    if (const std::optional<TagSquare> square = fit_tag(views, sightings)) out.push_back(*square);
  return out;
}

TagSide common_side(const std::vector<TagSquare>& tags) {
  double weight = 0, sum = 0;
  for (const TagSquare& t : tags)
    weight += 1 / (t.sigma * t.sigma), sum += t.side / (t.sigma * t.sigma);
  TagSide out{sum / weight, 0};
  double squares = 0;
  for (const TagSquare& t : tags) squares += std::pow((t.side - out.side) / t.sigma, 2);
  const double excess = tags.size() > 1 ? squares / double(tags.size() - 1) : 1;
  out.sigma = std::sqrt(std::max(1.0, excess) / weight);
  return out;
}

EdgelMap without_tags(const EdgelMap& map, const View& view, const std::vector<TagSquare>& tags) {
  std::vector<char> keep(map.edgels.size(), 1);
  bool any = false;
  for (const TagSquare& tag : tags) {
    Eigen::Matrix<double, 2, 4> corner;
    bool in_front = true;
    for (int k = 0; k < 4; ++k) {
      double depth;
      const Vector2d place = (1 + 2 * kBorder) * kCorners[k];
      corner.col(k) = view.project(tag.at(place.x(), place.y()), &depth);
      in_front = in_front && depth > 0;
    }
    if (!in_front) continue;
    const Vector2d middle = corner.rowwise().mean();
    for (size_t i = 0; i < keep.size(); ++i) {
      const Vector2d p(map.edgels[i].x, map.edgels[i].y);
      bool inside = true;
      for (int k = 0; k < 4 && inside; ++k) {
        const Vector2d side = (corner.col((k + 1) % 4) - corner.col(k)).normalized();
        const Vector2d in(-side.y(), side.x());
        const double sign = in.dot(middle - corner.col(k)) > 0 ? 1 : -1;
        inside = sign * in.dot(p - corner.col(k)) > -kClearPx;
      }
      if (inside) keep[i] = 0, any = true;
    }
  }
  if (!any) return map;
  EdgelMap out = runs_of(map, keep, kShortestRun);
  out.mask = map.mask;
  return out;
}

}  // namespace sketchsplat

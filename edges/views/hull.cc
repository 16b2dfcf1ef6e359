// SPDX-License-Identifier: MIT
#include "edges/views/hull.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "datasets/types/parallel.h"
#include "edges/image/mats.h"
#include "edges/views/lift.h"

namespace sketchsplat {

namespace {

// A mask, so that it can be said at once how much of a box it holds.
class CountedMask {
 public:
  CountedMask() = default;
  explicit CountedMask(const Image<uint8_t>& mask)
      : width_(mask.width), height_(mask.height), box_(cv::boundingRect(mat_of(mask))) {
    if (!box_.empty()) cv::integral(mat_of(mask)(box_), sum_, CV_32S);
  }
  int width() const { return width_; }
  int height() const { return height_; }
  const cv::Rect& box() const { return box_; }
  /// Pixels of it in a part of the image.
  int held(const cv::Rect& part) const {
    const cv::Rect r = (part & box_) - box_.tl();
    if (r.empty()) return 0;
    const int *top = sum_[r.y], *bottom = sum_[r.y + r.height];
    return bottom[r.x + r.width] - top[r.x + r.width] - bottom[r.x] + top[r.x];
  }

 private:
  int width_ = 0, height_ = 0;
  cv::Rect box_;
  cv::Mat1i sum_;  // of what lies above and left of each pixel of the box
};

// How much of a box of half size r around (x, y) the mask holds. What leaves the image is not
// judged.
enum Share : uint8_t { kNone, kSome, kAll };
Share share(const CountedMask& mask, double x, double y, double r) {
  const int w = mask.width(), h = mask.height();
  if (!(x >= 0 && y >= 0 && x <= w - 1 && y <= h - 1)) return kSome;
  r = std::min(r, double(w + h));  // a box around the camera itself has no bounds
  const int x0 = std::max(0, int(x - r)), x1 = std::min(w, int(x + r) + 2);
  const int y0 = std::max(0, int(y - r)), y1 = std::min(h, int(y + r) + 2);
  const cv::Rect part(x0, y0, x1 - x0, y1 - y0);
  const int held = mask.held(part);
  return held == 0 ? kNone : held == part.area() ? kAll : kSome;
}

// The same around an ideal pixel; masks are in the pixels of the image.
Share share(const CountedMask& mask, const View& view, const Eigen::Vector2d& ideal, double r) {
  if (view.lens.is_identity()) return share(mask, ideal.x(), ideal.y(), r);
  Eigen::Vector2d image;
  Eigen::Matrix2d J;
  if (!view.image_pixel(ideal, &image, &J)) return kSome;
  // At least what a length can grow by, and hardly more: the spectral norm is no larger.
  const double growth =
      std::sqrt(J.cwiseAbs().rowwise().sum().maxCoeff() * J.cwiseAbs().colwise().sum().maxCoeff());
  return share(mask, image.x(), image.y(), r * growth);
}

constexpr double kSurroundings = 2.5;  // cells
constexpr int kMostDenials = 8;        // views, and of all of them at most a quarter
constexpr double kCovered = 0.99;      // of what masks hold, by a hull that agrees with them
constexpr int kRays = 16;              // of a view, across the picture and down, that ask for it
constexpr int kWithin = 2;             // [px] of the mask all around such a ray

struct Masked {
  const View* view;
  CountedMask mask;
  bool spanned;  // edges reach as far as the mask: the grid holds all that it shows
};

bool spans(const std::vector<Edgel>& edgels, const CountedMask& mask) {
  constexpr double kReach = 0.9;  // of the mask's width and height
  Eigen::AlignedBox2f box;
  for (const Edgel& e : edgels) box.extend(Eigen::Vector2f(e.x, e.y));
  return box.sizes().x() >= kReach * mask.box().width &&
         box.sizes().y() >= kReach * mask.box().height;
}

std::vector<Masked> masked_views(const EdgeWorld& world) {
  std::vector<const Image<uint8_t>*> masks;
  std::vector<const std::vector<Edgel>*> edgels;
  std::vector<Masked> out;
  for (size_t v = 0; v < world.maps.size(); ++v) {
    const Image<uint8_t>& own = world.maps[v].mask;
    const Image<uint8_t>& mask = own.empty() && world.silhouettes ? (*world.silhouettes)[v] : own;
    if (mask.empty() || world.maps[v].edgels.empty()) continue;
    masks.push_back(&mask);
    edgels.push_back(&world.maps[v].edgels);
    out.push_back({&world.views[v], {}, false});
  }
  parallel_for(int(out.size()), 1, [&](int m) {
    out[m].mask = CountedMask(*masks[m]);
    out[m].spanned = spans(*edgels[m], out[m].mask);
  });
  return out;
}

// What masks say of a part of space: how many of the views see none of it in theirs, counted up to
// one more than `most`, and whether all views see it in theirs as a whole. Views outside of `open`
// are known to; `cut` gets those that see its edge.
struct CellState {
  uint8_t denials = 0;
  bool whole = true;
};
CellState state_of(const std::vector<Masked>& masks, const Eigen::Vector3d& p, double radius,
                   const std::vector<int>& open, int most, std::vector<int>* cut) {
  CellState out;
  for (const int m : open) {
    const View& v = *masks[m].view;
    double z;
    const Eigen::Vector2d q = v.project(p, &z);
    if (!(z > 0)) continue;
    const Share here = share(masks[m].mask, v, q, radius * v.camera.fx / z);
    if (here == kNone && ++out.denials > most) return out;
    if (here == kAll) continue;
    out.whole = false;
    if (here == kSome && cut) cut->push_back(m);
  }
  return out;
}

// Which cells masks deny, by how many.
class Carver {
 public:
  Carver(const std::vector<Masked>& masks, const VoxelGrid& grid) : masks_(masks), grid_(grid) {}

  // Counts up to one more than `most` denials of a cell.
  void carve(int most);
  // How many denials, up to `most`, to put up with for the cells to show where the masks do; and
  // whether they do with that many.
  bool agree(int most, int* enough) const;
  // VisualHull::occupied_, with so many denials.
  std::vector<uint8_t> occupied(int denials) const;

 private:
  int least_denials(const Masked& mask, const Eigen::Vector2d& ideal, int most) const;

  const std::vector<Masked>& masks_;
  const VoxelGrid& grid_;
  std::vector<CellState> cells_;
};

void Carver::carve(int most) {
  cells_.assign(grid_.size(), {uint8_t(most + 1), false});
  std::vector<int> all(masks_.size());
  std::iota(all.begin(), all.end(), 0);
  // Blocks of cells first: most of space is empty, most of the rest deep inside.
  constexpr int kBlock = 4;
  const double half_diagonal = 0.87 * grid_.cell;  // half the square root of 3
  const Eigen::Vector3i blocks = (grid_.count.array() + kBlock - 1) / kBlock;
  parallel_for(blocks.prod(), 16, [&](int b) {
    const Eigen::Vector3i first =
        kBlock *
        Eigen::Vector3i(b % blocks.x(), b / blocks.x() % blocks.y(), b / (blocks.x() * blocks.y()));
    const auto center = [&](const Eigen::Vector3i& cell, double side) {
      return Eigen::Vector3d(grid_.low +
                             grid_.cell * (cell.cast<double>().array() + side / 2).matrix());
    };
    std::vector<int> cut;
    const CellState block =
        state_of(masks_, center(first, kBlock), kBlock * half_diagonal, all, most, &cut);
    if (block.denials > most) return;
    const Eigen::Vector3i end = (first.array() + kBlock).min(grid_.count.array());
    for (int k = first.z(); k < end.z(); ++k)
      for (int j = first.y(); j < end.y(); ++j)
        for (int i = first.x(); i < end.x(); ++i) {
          CellState v = block;
          if (!cut.empty())
            v = state_of(masks_, center({i, j, k}, 1), half_diagonal, cut, most - block.denials,
                         nullptr);
          v.denials += cut.empty() ? 0 : block.denials;
          cells_[(size_t(k) * grid_.count.y() + j) * grid_.count.x() + i] = v;
        }
  });
}

// The fewest of a cell that an ideal pixel shows.
int Carver::least_denials(const Masked& mask, const Eigen::Vector2d& ideal, int most) const {
  const View& view = *mask.view;
  const Eigen::Vector3d origin = view.center_in_world();
  const Eigen::Vector3d direction =
      (view.cam_from_world.rotation.transpose() * view.camera.ray(ideal)).normalized();
  const Eigen::Vector3d half = 0.5 * grid_.cell * grid_.count.cast<double>();
  const double middle = (grid_.low + half - origin).norm();
  int least = most + 1;
  for (double s = std::max(0.0, middle - half.norm()); s < middle + half.norm() && least > 0;
       s += 0.5 * grid_.cell)
    if (size_t at; grid_.find(origin + s * direction, &at))
      least = std::min<int>(least, cells_[at].denials);
  return least;
}

bool Carver::agree(int most, int* enough) const {
  std::vector<std::vector<int>> count(masks_.size(), std::vector<int>(most + 2));
  parallel_for(int(masks_.size()), 1, [&](int m) {
    const CountedMask& mask = masks_[m].mask;
    for (int k = 0; masks_[m].spanned && k < kRays * kRays; ++k) {
      const Eigen::Vector2d pixel((k % kRays + 0.5) * mask.width() / kRays,
                                  (k / kRays + 0.5) * mask.height() / kRays);
      Eigen::Vector2d ideal;
      if (share(mask, pixel.x(), pixel.y(), kWithin) == kAll &&
          masks_[m].view->ideal_pixel(pixel, &ideal))
        ++count[m][least_denials(masks_[m], ideal, most)];
    }
  });
  double rays = 0, held = 0;
  for (const std::vector<int>& c : count) rays = std::accumulate(c.begin(), c.end(), rays);
  for (*enough = 0;; ++*enough) {
    for (const std::vector<int>& c : count) held += c[*enough];
    if (held >= kCovered * rays || *enough == most) return held >= kCovered * rays;
  }
}

std::vector<uint8_t> Carver::occupied(int denials) const {
  std::vector<uint8_t> out(cells_.size());
  for (size_t i = 0; i < out.size(); ++i)
    out[i] = cells_[i].denials > denials ? kNone : cells_[i].whole ? kAll : kSome;
  return out;
}

}  // namespace

VisualHull::VisualHull(const EdgeWorld& world, int cells) {
  const std::vector<Masked> masks = masked_views(world);
  if (masks.size() < 3 || world.bounds.isEmpty()) return;
  grid_.low = world.bounds.min();
  grid_.cell = world.bounds.sizes().maxCoeff() / cells;
  grid_.count = (world.bounds.sizes() / grid_.cell).array().ceil().cast<int>().max(1);
  Carver carver(masks, grid_);
  int most = 0, enough = 0;
  carver.carve(most);
  if (!carver.agree(most, &enough)) {  // something stands before the object
    most = std::min(kMostDenials, int(masks.size()) / 4);
    carver.carve(most);
    carver.agree(most, &enough);
  }
  occupied_ = carver.occupied(enough);
}

bool VoxelGrid::find(const Eigen::Vector3d& p, size_t* index) const {
  const Eigen::Vector3d q = (p - low) / cell;
  if (!(q.minCoeff() >= 0) || q.x() >= count.x() || q.y() >= count.y() || q.z() >= count.z())
    return false;
  *index = (size_t(q.z()) * count.y() + size_t(q.y())) * count.x() + size_t(q.x());
  return true;
}

uint8_t VisualHull::at(const Eigen::Vector3d& p) const {
  size_t cell;
  return grid_.find(p, &cell) ? occupied_[cell] : uint8_t(kNone);
}

bool VisualHull::surely_visible(const Eigen::Vector3d& point, const Eigen::Vector3d& camera) const {
  if (empty()) return false;
  const Eigen::Vector3d way = camera - point;
  const double length = way.norm();
  // Where the line of sight leaves the grid.
  const Eigen::Array3d size = grid_.cell * grid_.count.cast<double>().array();
  const Eigen::Array3d far = (way.array() > 0).select(grid_.low.array() + size, grid_.low.array());
  double end = length;
  for (int k = 0; k < 3; ++k)
    if (way[k] != 0) end = std::min(end, std::max(0.0, (far[k] - point[k]) / way[k] * length));
  // Nearby cells may hold the point's own surface, but no more than its surface.
  for (double s = 0; s < std::min(kSurroundings * grid_.cell, end); s += 0.35 * grid_.cell)
    if (at(point + way * (s / length)) == kAll) return false;
  for (double s = kSurroundings * grid_.cell; s < end; s += 0.7 * grid_.cell)
    if (at(point + way * (s / length)) != kNone) return false;
  return true;
}

bool VisualHull::clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                      double around, double* s0, double* s1) const {
  if (empty()) return true;
  const double step = 0.5 * grid_.cell;
  double first = *s0, last = *s1;
  while (first <= last && at(origin + first * direction) == kNone) first += step;
  while (first <= last && at(origin + last * direction) == kNone) last -= step;
  if (first > last) return false;
  *s0 = std::max(*s0, first - around * grid_.cell), *s1 = std::min(*s1, last + around * grid_.cell);
  return true;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "datasets/neighbours/kd_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace sketchsplat {
namespace {

// What nanoflann asks of a set of points. Not its adaptor of Eigen's matrices: the names of that
// one's members change from release to release.
struct Points {
  Eigen::Matrix3Xd at;
  size_t kdtree_get_point_count() const { return size_t(at.cols()); }
  double kdtree_get_pt(int i, size_t row) const { return at(Eigen::Index(row), i); }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// Where nanoflann puts what it finds.
class Within {
 public:
  using DistanceType = double;
  explicit Within(double square) : square_(square) {}
  size_t size() const { return found.size(); }
  bool empty() const { return found.empty(); }
  bool full() const { return true; }
  double worstDist() const { return square_; }
  bool addPoint(double, int index) {
    found.push_back(index);
    return true;
  }
  void sort() { std::sort(found.begin(), found.end()); }

  std::vector<int> found;

 private:
  double square_;
};

}  // namespace

struct KdTree::Tree {
  explicit Tree(const Eigen::Matrix3Xd& all)
      : points{all}, index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}
  const Points points;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points, double, int>,
                                      Points, 3, int>
      index;
};

KdTree::KdTree(const Eigen::Matrix3Xd& points) : tree_(std::make_unique<Tree>(points)) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;

double KdTree::distance(const Eigen::Vector3d& place) const {
  int nearest = -1;
  double square = std::numeric_limits<double>::infinity();
  if (tree_->points.at.cols() > 0) tree_->index.knnSearch(place.data(), 1, &nearest, &square);
  return std::sqrt(square);
}

std::vector<int> KdTree::within(const Eigen::Vector3d& place, double radius) const {
  Within result(radius * radius);
  if (tree_->points.at.cols() > 0) tree_->index.findNeighbors(result, place.data(), {});
  result.sort();
  return std::move(result.found);
}

}  // namespace sketchsplat

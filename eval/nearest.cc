// SPDX-License-Identifier: MIT
#include "eval/nearest.h"

#include <CGAL/Kd_tree.h>
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <limits>
#include <vector>

namespace sketchsplat {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Traits = CGAL::Search_traits_3<CGAL::Simple_cartesian<double>>;
using Distance = CGAL::Euclidean_distance<Traits>;
using Splitter = CGAL::Sliding_midpoint<Traits>;
using KdTree = CGAL::Kd_tree<Traits, Splitter, CGAL::Tag_true, CGAL::Tag_true>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits, Distance, Splitter, KdTree>;

Point point_of(const Eigen::Matrix3Xd& points, Eigen::Index i) {
  return {points(0, i), points(1, i), points(2, i)};
}

std::vector<Point> all_points(const Eigen::Matrix3Xd& points) {
  std::vector<Point> all;
  all.reserve(size_t(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) all.push_back(point_of(points, i));
  return all;
}

}  // namespace

struct NearestPoints::Tree {
  explicit Tree(const std::vector<Point>& points) : kd(points.begin(), points.end()) {
    if (!points.empty()) kd.build();  // not by the first query: those run in parallel
  }
  KdTree kd;
};

NearestPoints::NearestPoints(const Eigen::Matrix3Xd& points)
    : tree_(std::make_unique<Tree>(all_points(points))) {}
NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;

Eigen::VectorXd NearestPoints::distances(const Eigen::Matrix3Xd& queries) const {
  Eigen::VectorXd out =
      Eigen::VectorXd::Constant(queries.cols(), std::numeric_limits<double>::infinity());
  if (tree_->kd.empty()) return out;
#pragma omp parallel for schedule(dynamic, 1024) if (queries.cols() > 8192)
  for (Eigen::Index i = 0; i < queries.cols(); ++i) {
    const Search search(tree_->kd, point_of(queries, i), 1);
    out[i] = std::sqrt(search.begin()->second);
  }
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/cameras/point_prior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/readers/smaller_pictures.h"
#include "datasets/types/dense.h"
#include "datasets/types/median.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kLeastSigma = 0.05;  // [px] of a sight
constexpr double kBiweight = 4.685;   // standard deviations: 95 % efficient
constexpr double kRank = 1e-9;        // of the largest eigenvalue: depth that no parallax tells
constexpr int kFewest = 2;            // sights of a point

struct SightTerm {
  int view;
  Vector2d residual;
  CameraUnknowns::Derivatives by;
};

std::vector<SightTerm> terms_of(const CameraUnknowns& cameras, const ScenePoint& point) {
  std::vector<SightTerm> terms;
  for (const PointSight& sight : point.sights) {
    SightTerm term;
    Vector2d pixel;
    if (!sight.pixel.allFinite() || !cameras.image(sight.view, point.position, &pixel, &term.by))
      continue;
    term.view = sight.view;
    term.residual = pixel - sight.pixel;
    terms.push_back(term);
  }
  return terms;
}

// Where the unknowns of a sight's camera stand among all: its pose, then what it shares.
std::vector<int> columns_of(const CameraUnknowns& cameras, const SightTerm& term) {
  std::vector<int> columns;
  for (int i = 0; i < CameraUnknowns::kPose; ++i)
    columns.push_back(cameras.pose_column(term.view) + i);
  const int camera = cameras.camera_of(term.view);
  for (int i = 0; i < cameras.num_shared(camera); ++i)
    columns.push_back(cameras.shared_column(camera) + i);
  return columns;
}

// Of a point: the sum of its sights, less what moving it explains. A sight knows one camera: blocks
// of few columns are added, and only what goes through the point couples all cameras that see it.
void add_point(const CameraUnknowns& cameras, const std::vector<SightTerm>& terms, double sigma,
               CameraQuadratic* sum) {
  std::vector<std::vector<int>> columns;
  std::vector<int> used;
  for (const SightTerm& term : terms) {
    columns.push_back(columns_of(cameras, term));
    used.insert(used.end(), columns.back().begin(), columns.back().end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const int n = int(used.size());
  Eigen::Matrix3Xd cross = Eigen::Matrix3Xd::Zero(3, n);
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (size_t k = 0; k < terms.size(); ++k) {
    const SightTerm& term = terms[k];
    const double r2 = term.residual.squaredNorm() / std::pow(kBiweight * sigma, 2);
    if (!(r2 < 1)) continue;
    const double weight = std::pow((1 - r2) / sigma, 2);
    const int c = int(columns[k].size());
    Eigen::Matrix2Xd J(2, c);
    J << term.by.pose, term.by.shared.leftCols(c - CameraUnknowns::kPose);
    const Eigen::Matrix3Xd through = weight * term.by.point.transpose() * J;
    for (int i = 0; i < c; ++i) {
      const auto at = std::lower_bound(used.begin(), used.end(), columns[k][i]) - used.begin();
      cross.col(at) += through.col(i);
      sum->gradient[columns[k][i]] += weight * J.col(i).dot(term.residual);
      for (int j = 0; j < c; ++j)
        sum->information(columns[k][i], columns[k][j]) += weight * J.col(i).dot(J.col(j));
    }
    A += weight * term.by.point.transpose() * term.by.point;
    b += weight * term.by.point.transpose() * term.residual;
  }
  const auto es = eigen_symmetric(A);
  Matrix3d inverse = Matrix3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (es.values[k] > kRank * es.values[2])
      inverse += es.vectors.col(k) * es.vectors.col(k).transpose() / es.values[k];
  for (int j = 0; j < n; ++j) {
    const Vector3d moved = inverse * cross.col(j);
    sum->gradient[used[j]] -= moved.dot(b);
    for (int i = 0; i < n; ++i) sum->information(used[i], used[j]) -= cross.col(i).dot(moved);
  }
}

}  // namespace

CameraQuadratic point_prior(const CameraUnknowns& cameras, const std::vector<ScenePoint>& points) {
  std::vector<std::vector<SightTerm>> of_point;
  for (const ScenePoint& point : points) {
    of_point.push_back(terms_of(cameras, point));
    if (int(of_point.back().size()) < kFewest) of_point.pop_back();
  }
  CameraQuadratic sum{MatrixXd::Zero(cameras.size(), cameras.size()),
                      VectorXd::Zero(cameras.size())};
  const double sigma = std::max(kLeastSigma, points_off_px(cameras.current(), points));
  for (const auto& terms : of_point) add_point(cameras, terms, sigma, &sum);
  return sum;
}

double points_off_px(const std::vector<View>& views, const std::vector<ScenePoint>& points) {
  std::vector<double> apart;
  for (const ScenePoint& point : points)
    for (const PointSight& sight : point.sights) {
      double depth;
      Vector2d pixel;
      const View& view = views[sight.view];
      if (!view.image_pixel(view.project(point.position, &depth), &pixel) || !(depth > 0)) continue;
      const Vector2d off = (pixel - sight.pixel).cwiseAbs();
      if (off.allFinite()) apart.insert(apart.end(), {off.x(), off.y()});
    }
  return apart.empty() ? 0 : normal_sigma(apart);
}

std::vector<ScenePoint> points_among(const std::vector<View>& views, const Scene& scene) {
  if (scene.points.empty()) return {};
  std::vector<int> index(scene.views.size(), -1);
  const std::vector<int> places = places_in(scene, views);
  for (size_t v = 0; v < places.size(); ++v) index[places[v]] = int(v);
  std::vector<ScenePoint> out;
  for (const ScenePoint& point : scene.points) {
    ScenePoint seen{point.position, {}};
    for (const PointSight& sight : point.sights)
      if (index[sight.view] >= 0 && sight.pixel.allFinite())
        seen.sights.push_back({index[sight.view], sight.pixel});
    if (int(seen.sights.size()) >= kFewest) out.push_back(std::move(seen));
  }
  return out;
}

std::vector<ScenePoint> shrunk(std::vector<ScenePoint> points, int factor) {
  for (ScenePoint& point : points)
    for (PointSight& sight : point.sights) sight.pixel = shrunk(sight.pixel, factor);
  return points;
}

}  // namespace sketchsplat

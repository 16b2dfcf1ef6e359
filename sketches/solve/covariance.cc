// SPDX-License-Identifier: MIT
#include "sketches/solve/covariance.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/types/dense.h"
#include "datasets/types/parallel.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Jet12 = ceres::Jet<double, 12>;
using Matrix3x12 = Eigen::Matrix<double, 3, 12>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;

// Below this share of the largest eigenvalue a direction is one in which the curve slides along
// itself: these are zero but for rounding.
constexpr double kRank = 1e-7;

// Move of a sample across its curve by the control points.
Matrix3x12 jacobian_across(StrokeKind kind, const ControlPoints& c, double t) {
  Vec3<Jet12> control[4], position, derivative;
  for (int i = 0; i < c.count; ++i)
    for (int k = 0; k < 3; ++k) control[i][k] = Jet12(c.p[i][k], 3 * i + k);
  evaluate_curve<Jet12>(kind, control, t, &position, &derivative);
  Matrix3x12 J = Matrix3x12::Zero();
  Eigen::Vector3d tangent;
  for (int k = 0; k < 3; ++k) {
    J.row(k) = position[k].v.transpose();
    tangent[k] = derivative[k].a;
  }
  const Eigen::Vector3d u = tangent.stableNormalized();
  J -= (u * (u.transpose() * J)).eval();
  return J;
}

// Of robust residuals: psi = r w(r), w = (1 - (r / c)^2)^2.
struct Scatter {
  double psi2 = 0, slope = 0;
  int count = 0;

  void add(double r, double reach) {
    const double u2 = std::min(1.0, r * r / (reach * reach)), w = (1 - u2) * (1 - u2);
    psi2 += r * r * w * w;
    slope += (1 - u2) * (1 - 5 * u2);
    ++count;
  }
  // Variance that least squares without weights would need to be as uncertain; 0 if nobody knows.
  double variance(double parameters) const {
    if (!(count > parameters) || !(slope > 0)) return 0;
    const double mean_slope = std::max(slope / count, 0.2);
    return psi2 / (count - parameters) / (mean_slope * mean_slope);
  }
};

struct ViewSum {
  Vector12 g = Vector12::Zero();
  double residual = 0;
  int count = 0;
  // Of the edgel that the last sightings share, and of all edgels the squared number of sightings.
  int edgel = -1, same = 0;
  Vector12 of_edgel = Vector12::Zero();
  double squares = 0;

  void close_edgel(Matrix12* middle) {
    middle->noalias() += of_edgel * of_edgel.transpose();
    squares += double(same) * same;
    of_edgel.setZero();
    same = 0;
  }
};

struct Normal {
  Matrix12 A = Matrix12::Zero();
  Matrix12 by_edgel = Matrix12::Zero();
  std::map<int, ViewSum> views;
  Scatter scatter;
  Matrix12 inverse = Matrix12::Zero();
  int rank = 0;
};

void invert(Normal* n) {
  const auto es = eigen_symmetric(n->A);
  const double least = kRank * es.values[11];
  for (int k = 0; k < 12; ++k) {
    const double value = es.values[k];
    if (!(value > least)) continue;
    n->inverse += es.vectors.col(k) * es.vectors.col(k).transpose() / value;
    ++n->rank;
  }
}

// Variance that a view's sightings of one stroke share: of the means by view, beyond what the
// scatter of single sightings explains. The fit takes up half a mean per parameter.
double common_variance(const std::vector<Normal>& normals, double scatter) {
  constexpr int kFewest = 3;
  double sum = 0, freedom = 0;
  for (const Normal& n : normals) {
    double squares = 0, expected = 0;
    int views = 0;
    for (const auto& [view, v] : n.views) {
      if (v.count < kFewest) continue;
      squares += std::pow(v.residual / v.count, 2);
      expected += scatter * v.squares / (double(v.count) * v.count);
      ++views;
    }
    const double left = views - 0.5 * n.rank;
    if (left < 1) continue;
    sum += squares - expected * left / views;
    freedom += left;
  }
  return freedom > 0 ? std::max(0.0, sum / freedom) : 0;
}

double largest_sigma(StrokeKind kind, const ControlPoints& c, const SampleLayout& layout,
                     int stroke, const Matrix12& covariance) {
  constexpr int kMost = 40;
  const int first = layout.first[stroke], n = layout.first[stroke + 1] - first;
  const int places = std::min(n, kMost);
  double largest = 0;
  for (int k = 0; k < places + 2; ++k) {  // both ends, too
    const double t = k == places ? 0 : k == places + 1 ? 1 : layout.t[first + k * n / places];
    const Matrix3x12 J = jacobian_across(kind, c, t);
    largest = std::max(largest, eigenvalues_symmetric(J * covariance * J.transpose())[2]);
  }
  return std::sqrt(largest);
}

}  // namespace

std::vector<StrokeCovariance> stroke_covariances(const Sketch& sketch, const SampleLayout& layout,
                                                 const std::vector<Sighting>& sightings,
                                                 const CovarianceOptions& options) {
  std::vector<Normal> normals(sketch.size());
  std::vector<size_t> begin(sketch.size() + 1, sightings.size());
  for (size_t m = sightings.size(); m-- > 0;) begin[layout.stroke[sightings[m].sample]] = m;
  for (int s = sketch.size(); s-- > 0;) begin[s] = std::min(begin[s], begin[s + 1]);
  parallel_for(sketch.size(), 1, [&](int s) {
    Normal& n = normals[s];
    const ControlPoints c = control_points(sketch, s);
    Matrix3x12 J = Matrix3x12::Zero();
    int sample = -1;
    for (size_t m = begin[s]; m < begin[s + 1]; ++m) {
      const Sighting& seen = sightings[m];
      if (seen.sample != sample)
        J = jacobian_across(sketch.strokes[s].kind, c, layout.t[sample = seen.sample]);
      const Vector12 j = J.transpose() * seen.direction;
      n.A.noalias() += j * j.transpose();
      ViewSum& v = n.views[seen.view];
      if (seen.edgel != v.edgel) v.close_edgel(&n.by_edgel);
      v.edgel = seen.edgel;
      v.of_edgel += j;
      ++v.same;
      v.g += j;
      v.residual += seen.distance_px;
      ++v.count;
      n.scatter.add(seen.distance_px, options.reach_px);
    }
    for (auto& [view, v] : n.views) v.close_edgel(&n.by_edgel);
    if (n.A.trace() > 0 && n.A.allFinite()) invert(&n);
  });
  Scatter all;
  double parameters = 0;
  for (const Normal& n : normals) {
    all.psi2 += n.scatter.psi2, all.slope += n.scatter.slope, all.count += n.scatter.count;
    parameters += n.rank;
  }
  const double pooled = all.variance(parameters), common = common_variance(normals, pooled);

  std::vector<StrokeCovariance> out(sketch.size());
  for (int s = 0; s < sketch.size(); ++s) {
    const Normal& n = normals[s];
    if (n.rank == 0) continue;
    const ControlPoints c = control_points(sketch, s);
    const double own = n.scatter.variance(n.rank), count = own > 0 ? n.scatter.count : 0;
    const double variance =
        (count * own + options.pooled * pooled) / std::max(count + options.pooled, 1e-300);
    Matrix12 middle = variance * n.by_edgel;
    for (const auto& [view, v] : n.views) middle += common * v.g * v.g.transpose();
    const Matrix12 covariance = n.inverse * middle * n.inverse;
    out[s].matrix = covariance.topLeftCorner(3 * c.count, 3 * c.count);
    out[s].determined = n.rank;
    out[s].sigma = largest_sigma(sketch.strokes[s].kind, c, layout, s, covariance);
  }
  return out;
}

std::vector<double> upper_triangle(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  for (int i = 0; i < matrix.rows(); ++i)
    for (int k = i; k < matrix.cols(); ++k) values.push_back(matrix(i, k));
  return values;
}

Eigen::MatrixXd from_upper_triangle(const std::vector<double>& values) {
  const int n = int((std::sqrt(8.0 * double(values.size()) + 1) - 1) / 2 + 0.5);
  Eigen::MatrixXd matrix(n, n);
  size_t next = 0;
  for (int i = 0; i < n; ++i)
    for (int k = i; k < n; ++k) matrix(i, k) = matrix(k, i) = values[next++];
  return matrix;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/adjust/relation_weigher.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kNews = 2;            // [sigma of the relation] less uncertain: known already
constexpr double kLeastSigma = 1e-4;   // [px] of a relation
constexpr double kMeaningless = 1e-6;  // share of its range in which a free coordinate is left

double largest_deviation(const MatrixXd& covariance) {
  return std::sqrt(std::max(0.0, eigenvalues_symmetric(covariance).maxCoeff()));
}

}  // namespace

RelationWeigher::RelationWeigher(const Sketch& sketch, const SketchQuadratic& quadratic,
                                 double footprint, const RegularizeOptions& options)
    : s_(sketch),
      gaussian_(quadratic.information),
      options_(options),
      unit_(footprint),
      points_(int(sketch.nodes.cols() + sketch.handles.cols())),
      extent_(largest_extent(sketch)) {
  relations_.origin =
      s_.nodes.cols() ? Vector3d(s_.nodes.rowwise().mean()) : Vector3d(s_.handles.col(0));
  if (gaussian_.ok()) apply(-gaussian_.solve(quadratic.slope));
}

void RelationWeigher::apply(const VectorXd& move) {
  const int nodes = int(s_.nodes.cols());
  for (int b = 0; b < int(move.size()) / 3; ++b) {
    const Vector3d d = move.segment<3>(3 * b);
    if (b < nodes)
      s_.nodes.col(b) += d;
    else if (b < points_)
      s_.handles.col(b - nodes) += d;
    else
      relations_.shared[b - points_].value += d;
  }
  for (SharedQuantity& q : relations_.shared)
    if (q.kind == SharedKind::kDirection) q.value.normalize();
}

int RelationWeigher::add_shared(const SharedQuantity& quantity, double range) {
  relations_.shared.push_back(quantity);
  used_.push_back(false);
  for (int k = 0; k < 3; ++k) gaussian_.add_variable(range * range);
  // The length of a direction, and where along an axis its point lies, mean nothing. Were they left
  // uncertain, a turn of the direction by a little would take that for uncertainty across it.
  const int index = int(relations_.shared.size()) - 1;
  const bool is_direction = quantity.kind == SharedKind::kDirection;
  if (is_direction || quantity.kind == SharedKind::kAxis) {
    const Vector3d along =
        is_direction ? quantity.value : relations_.shared[quantity.direction].value;
    Gaussian::Rows row(1, gaussian_.size());
    for (int k = 0; k < 3; ++k) row.coeffRef(0, 3 * (points_ + index) + k) = along[k];
    gaussian_.observe(row, VectorXd::Zero(1), kMeaningless * range);
  }
  return index;
}

// Rows over all variables; `own`: as if shared quantities were given.
Gaussian::Rows RelationWeigher::sparse(const RelationRows& rows, bool own) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t b = 0; b < rows.blocks.size(); ++b) {
    if (own && rows.blocks[b] >= points_) continue;
    for (int r = 0; r < rows.jacobian.rows(); ++r)
      for (int k = 0; k < 3; ++k)
        entries.emplace_back(r, 3 * rows.blocks[b] + k, rows.jacobian(r, 3 * b + k));
  }
  Gaussian::Rows out(rows.jacobian.rows(), gaussian_.size());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

RelationWeigher::Own RelationWeigher::own(const Relation& relation) const {
  const RelationRows rows = linearize(s_, relations_, relation);
  if (!rows.jacobian.allFinite()) return {rows.residual, HUGE_VAL};
  const bool alone = relation.kind != RelationKind::kPerpendicular;
  return {rows.residual, largest_deviation(gaussian_.covariance(sparse(rows, alone)))};
}

RelationWeigher::Own RelationWeigher::ask(Relation relation, const SharedQuantity& quantity) {
  if (exhausted()) return {VectorXd::Zero(3), HUGE_VAL};
  relations_.shared.push_back(quantity);
  relation.shared = num_shared() - 1;
  const Own answer = own(relation);
  const double k = double(answer.residual.size());
  work_ += k * (30 * gaussian_.size() + (1 + k) * gaussian_.taken());
  relations_.shared.pop_back();
  return answer;
}

RelationTrial RelationWeigher::weigh(std::vector<Relation>* relations, double range_px,
                                     double naming) {
  RelationTrial trial;
  if (exhausted()) return trial;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> residual;
  double sigma = 0;
  for (Relation& relation : *relations) {
    relation.sigma =
        std::clamp(options_.soft_share * own(relation).sigma, kLeastSigma, options_.soft_px);
    sigma = std::max(sigma, relation.sigma);
    const RelationRows rows = linearize(s_, relations_, relation);
    const Gaussian::Rows piece = sparse(rows, false);
    for (int r = 0; r < piece.rows(); ++r) {
      for (Gaussian::Rows::InnerIterator it(piece, r); it; ++it)
        entries.emplace_back(int(residual.size()), int(it.col()), it.value() / relation.sigma);
      residual.push_back(rows.residual[r] / relation.sigma);
    }
  }
  const int k = int(residual.size());
  work_ += double(k) * (30 * gaussian_.size() + (1 + k) * gaussian_.taken());
  trial.rows.resize(k, gaussian_.size());
  trial.rows.setFromTriplets(entries.begin(), entries.end());
  trial.residual = Eigen::Map<VectorXd>(residual.data(), k);
  MatrixXd s = gaussian_.covariance(trial.rows);
  const VectorXd values = eigenvalues_symmetric(s);
  for (int i = 0; i < k; ++i) {
    const double deviation = std::sqrt(std::max(0.0, values[i]));  // [sigma]
    if (!(deviation > kNews)) continue;
    trial.news = true;
    const double told = std::log(range_px / (deviation * sigma)) - naming / k;
    trial.gain += std::min(options_.price, told - options_.price);
  }
  s.diagonal().array() += 1;
  trial.nats = 0.5 * trial.residual.dot(solve_symmetric(s, trial.residual));
  if (!std::isfinite(trial.nats)) trial.news = false;
  return trial;
}

void RelationWeigher::take(const std::vector<Relation>& relations, const RelationTrial& trial,
                           bool pays) {
  if (exhausted()) return;
  work_ += double(trial.rows.rows()) * gaussian_.size() * (30 + gaussian_.taken());
  apply(gaussian_.observe(trial.rows, trial.residual, 1));
  for (const Relation& r : relations) {
    relations_.list.push_back(r);
    if (!pays) continue;
    if (r.shared >= 0) used_[r.shared] = true;
    if (r.other >= 0) used_[r.other] = true;
  }
  if (pays) gain_ += trial.gain;
}

}  // namespace sketchsplat

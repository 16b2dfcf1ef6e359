// SPDX-License-Identifier: MIT
#include "eval/inspect/sigma_model.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/types/median.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_jacobian.h"
#include "sketches/curve/sample.h"
#include "sketches/solve/covariance.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

// Symmetric square root's columns: a matrix L with L L^T = the covariance.
MatrixXd root_of(const MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> es(covariance);
  return es.eigenvectors() * es.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

double largest_deviation(const MatrixXd& modes) {
  double largest = 0;
  for (int j = 0; j + 1 < modes.rows(); j += 2) {
    const Matrix2d c = modes.middleRows<2>(j) * modes.middleRows<2>(j).transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix2d> es(c, Eigen::EigenvaluesOnly);
    largest = std::max(largest, es.eigenvalues()[1]);
  }
  return std::sqrt(std::max(0.0, largest));
}

// What a turn and a shift of the whole, of this covariance, do at a point: L with L L^T = it.
Eigen::Matrix<double, 3, 6> pose_modes(const Alignment& alignment, const Vector3d& point) {
  const Vector3d arm = point - alignment.centre;
  Eigen::Matrix<double, 3, 6> j;
  j << 0, arm.z(), -arm.y(), 1, 0, 0, -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), -arm.x(), 0, 0, 0, 1;
  return j * root_of(alignment.covariance);
}

constexpr double kImplied = 0.25;  // [px] by which strokes that no edgel saw are off

constexpr int kRigid = 3, kBend = 2, kScale = 1, kPose = 6;

}  // namespace

std::vector<std::pair<std::string, double*>> named_numbers(SigmaOptions* o) {
  return {{"straight_factor", &o->straight_factor},
          {"straight_power", &o->straight_power},
          {"straight_place", &o->straight_place},
          {"straight_views", &o->straight_views},
          {"curved_factor", &o->curved_factor},
          {"curved_power", &o->curved_power},
          {"curved_place", &o->curved_place},
          {"curved_views", &o->curved_views},
          {"place_px", &o->place_px},
          {"curvature_px2", &o->curvature_px2},
          {"curvature_sigma_px2", &o->curvature_sigma_px2},
          {"dark_side_px", &o->dark_side_px},
          {"tail_share", &o->tail_share},
          {"straight_tail", &o->straight_tail},
          {"curved_tail", &o->curved_tail}};
}

double SigmaModel::factor(const Stroke& stroke, const Evidence& e) const {
  constexpr double kLeastBias = 0.004;  // [px] no views agree better than that but by chance
  if (!(footprint > 0) || !(e.sigma > 0) || !(e.bias_px > 0)) return 1;
  const bool straight = stroke.kind == StrokeKind::kLine;
  const double ratio = std::max(kLeastBias, e.bias_px) * footprint / e.sigma;
  return straight ? options.straight_factor * std::pow(ratio, options.straight_power)
                  : options.curved_factor * std::pow(ratio, options.curved_power);
}

double SigmaModel::pull_px2() const {
  const double sigma = options.curvature_sigma_px2;
  return without_pull ? sigma : std::hypot(options.curvature_px2, sigma);
}

Eigen::Matrix<double, 3, 2> SigmaModel::radial_errors(const Sketch& measured, int stroke,
                                                      double t) const {
  const Vector3d bend = bend_at(measured, stroke, t, footprint);
  Eigen::Matrix<double, 3, 2> out;
  out << pull_px2() * bend, options.dark_side_px * footprint * bend.stableNormalized();
  return out;
}

double SigmaModel::wide(StrokeKind kind) const {
  return kind == StrokeKind::kLine ? options.straight_tail : options.curved_tail;
}

double SigmaModel::place(const Stroke& stroke, const Evidence& e) const {
  const bool straight = stroke.kind == StrokeKind::kLine;
  const double own = (straight ? options.straight_place : options.curved_place) * e.bias_px;
  const double all = (straight ? options.straight_views : options.curved_views) * bias_px;
  return footprint * std::sqrt(own * own + all * all + options.place_px * options.place_px);
}

double typical_bias_px(const Sketch& measured) {
  std::vector<double> bias;
  for (const Evidence& e : measured.evidence) bias.push_back(e.bias_px);
  return median(std::move(bias));
}

MatrixXd calibrated_covariance(const Sketch& measured, int stroke, const SigmaModel& sigma) {
  const Evidence& e = measured.evidence[stroke];
  const StrokeKind kind = measured.strokes[stroke].kind;
  const double factor = sigma.factor(measured.strokes[stroke], e);
  const int n = 3 * num_controls(kind);
  if (is_implied(measured, stroke, sigma))
    return std::pow(kImplied * sigma.footprint, 2) * MatrixXd::Identity(n, n);
  if (!e.covariance.empty()) return factor * factor * from_upper_triangle(e.covariance);
  return std::pow(factor * e.sigma, 2) * MatrixXd::Identity(n, n);
}

bool is_implied(const Sketch& measured, int stroke, const SigmaModel& sigma) {
  return sigma.footprint > 0 && sigma.bias_px > 0 && !(measured.evidence[stroke].sigma > 0);
}

bool is_open(const Sketch& measured, int stroke) {
  const Evidence& e = measured.evidence[stroke];
  if (e.covariance.empty()) return false;
  switch (measured.strokes[stroke].kind) {
    case StrokeKind::kLine:
      return e.determined < 4;
    case StrokeKind::kArc:
    case StrokeKind::kCircle:
      return e.determined < 6;
    case StrokeKind::kEllipse:
      return e.determined < 8;
    default:
      return false;  // what nearly straight ones leave open does not move them
  }
}

Eigen::Matrix<double, 2, 3> frame_across(const Vector3d& tangent) {
  Eigen::Matrix<double, 2, 3> f;
  const Vector3d u = tangent.unitOrthogonal();
  f.row(0) = u;
  f.row(1) = tangent.cross(u);
  return f;
}

Vector3d bend_at(const Sketch& measured, int stroke, double t, double footprint) {
  if (measured.strokes[stroke].kind == StrokeKind::kLine || !(footprint > 0))
    return Vector3d::Zero();
  const Vector3d curvature = curvature_at(measured, stroke, t);
  return footprint * footprint / std::max(1.0, footprint * curvature.norm()) * curvature;
}

PieceErrors piece_errors(const Sketch& measured, const std::vector<EdgePlace>& places, bool held,
                         const SigmaModel& sigma) {
  const int stroke = places[0].stroke, n = int(places.size());
  const MatrixXd root = root_of(calibrated_covariance(measured, stroke, sigma));
  const StrokeKind kind = measured.strokes[stroke].kind;
  const ControlPoints controls = control_points(measured, stroke);
  const double aside = sigma.place(measured.strokes[stroke], measured.evidence[stroke]);
  MatrixXd own(2 * n, root.cols());
  MatrixXd other = MatrixXd::Zero(2 * n, kRigid + kBend + kScale + (held ? 0 : kPose));
  PieceErrors out;
  out.model.mean.resize(2, n);
  for (int j = 0; j < n; ++j) {
    const EdgePlace& p = places[j];
    const Eigen::Matrix<double, 2, 3> across = frame_across(p.tangent);
    out.model.mean.col(j) = across * p.deviation;
    own.middleRows<2>(2 * j) =
        across * curve_jacobian(kind, controls, p.t).leftCols(root.rows()) * root;
    auto rows = other.middleRows<2>(2 * j);
    rows.leftCols<kRigid>() = aside * across;
    rows.middleCols<kBend>(kRigid) = across * sigma.radial_errors(measured, stroke, p.t);
    if (sigma.alignment)
      rows.col(kRigid + kBend) =
          sigma.options.scale_percent / 100 * (across * (p.measured - sigma.alignment->centre));
    if (!held && sigma.alignment)
      rows.rightCols<kPose>() = across * pose_modes(*sigma.alignment, p.measured);
  }
  out.wide = sigma.wide(kind);
  out.sigma = largest_deviation(own);
  out.systematic = largest_deviation(other);
  out.model.modes.resize(2 * n, own.cols() + other.cols());
  out.model.modes << own, other;
  return out;
}

}  // namespace sketchsplat

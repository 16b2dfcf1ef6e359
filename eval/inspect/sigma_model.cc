// SPDX-License-Identifier: MIT
#include "eval/inspect/sigma_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
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
  const auto es = eigen_symmetric(covariance);
  return es.vectors * es.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

double largest_deviation(const MatrixXd& modes) {
  double largest = 0;
  for (int j = 0; j + 1 < modes.rows(); j += 2) {
    const Matrix2d c = modes.middleRows<2>(j) * modes.middleRows<2>(j).transpose();
    largest = std::max(largest, eigenvalues_symmetric(c)[1]);
  }
  return std::sqrt(std::max(0.0, largest));
}

constexpr int kRigid = 3, kBend = 2, kScale = 1, kPose = 7;

// What a growth, a turn and a shift of the whole, as uncertain as they are, do at a point: L with L
// L^T = their covariance.
Eigen::Matrix<double, 3, kPose> pose_modes(const Alignment& alignment, bool held,
                                           const Vector3d& point) {
  const Vector3d arm = point - alignment.centre;
  Eigen::Matrix<double, 3, 6> j;
  j << 0, arm.z(), -arm.y(), 1, 0, 0, -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), -arm.x(), 0, 0, 0, 1;
  Eigen::Matrix<double, 3, kPose> out = Eigen::Matrix<double, 3, kPose>::Zero();
  out.col(0) = alignment.scale_sigma * arm;
  if (!held) out.rightCols<6>() = j * root_of(alignment.covariance);
  return out;
}

constexpr double kImplied = 0.25;  // [px] by which strokes that no edgel saw are off

constexpr int kWaves = 4;  // half waves, at most

// The richer, the more a curve of this kind can be.
int richness(StrokeKind kind) {
  switch (kind) {
    case StrokeKind::kLine:
      return 0;
    case StrokeKind::kArc:
    case StrokeKind::kCircle:
      return 1;
    case StrokeKind::kEllipticArc:
    case StrokeKind::kEllipse:
      return 2;
    case StrokeKind::kBezier:
      return 3;
  }
  return 3;
}

}  // namespace

double spread(const ErrorShares& shares) {
  double sum = 0;
  for (size_t k = 0; k < shares.size(); ++k) sum += shares[k] * kErrorSizes[k] * kErrorSizes[k];
  return std::sqrt(sum);
}

std::array<double, kErrorSizes.size()> sizes_of(const ErrorShares& shares) {
  std::array<double, kErrorSizes.size()> out = kErrorSizes;
  for (double& size : out) size /= spread(shares);
  return out;
}

ErrorShares worse_of(const ErrorShares& a, const ErrorShares& b) {
  return spread(a) < spread(b) ? b : a;
}

const SigmaOptions::OfKind& of_kind(const SigmaOptions& options, StrokeKind kind) {
  if (kind == StrokeKind::kLine) return options.straight;
  if (is_closed(kind)) return options.closed;
  return kind == StrokeKind::kArc ? options.arc : options.free;
}

void without_tails(SigmaOptions* o) {
  for (SigmaOptions::OfKind* kind : {&o->straight, &o->closed, &o->arc, &o->free}) {
    kind->shares = {};
    kind->shares[kErrorSizes.size() / 2] = 1;
  }
}

bool is_simpler(StrokeKind stroke, StrokeKind nominal) {
  return richness(stroke) < richness(nominal);
}

namespace {

// What the shape of a piece may be off, along each axis of the world: a shift, and cosines of one
// to four half waves, half a standard normal number each. 2 P x 15.
MatrixXd form_errors(const std::vector<EdgePlace>& places) {
  const int n = int(places.size());
  MatrixXd out(2 * n, 3 * (kWaves + 1));
  for (int j = 0; j < n; ++j)
    for (int k = 0; k <= kWaves; ++k)
      out.block<2, 3>(2 * j, 3 * k) =
          0.5 * std::cos(k * M_PI * j / std::max(1, n - 1)) * frame_across(places[j].tangent);
  return out;
}

}  // namespace

std::vector<std::pair<std::string, double*>> named_numbers(SigmaOptions* o) {
  std::vector<std::pair<std::string, double*>> out = {
      {"place_px", &o->place_px},
      {"curvature_px2", &o->curvature_px2},
      {"curvature_sigma_px2", &o->curvature_sigma_px2},
      {"dark_side_px", &o->dark_side_px},
      {"straight_form_px", &o->straight_form_px},
      {"form_px", &o->form_px}};
  const auto add = [&](const std::string& name, SigmaOptions::OfKind* kind) {
    out.push_back({name + "_factor", &kind->factor});
    out.push_back({name + "_power", &kind->power});
    out.push_back({name + "_place", &kind->place});
    out.push_back({name + "_views", &kind->views});
    for (size_t k = 0; k < kind->shares.size(); ++k)
      out.push_back({name + "_share_" + std::to_string(k), &kind->shares[k]});
  };
  add("straight", &o->straight);
  add("closed", &o->closed);
  add("arc", &o->arc);
  add("free", &o->free);
  return out;
}

double SigmaModel::factor(const Stroke& stroke, const Evidence& e) const {
  constexpr double kLeastBias = 0.004;  // [px] no views agree better than that but by chance
  if (!(footprint > 0) || !(e.sigma > 0) || !(e.bias_px > 0)) return 1;
  const SigmaOptions::OfKind& kind = of_kind(options, stroke.kind);
  return spread(kind.shares) * kind.factor *
         std::pow(std::max(kLeastBias, e.bias_px) * footprint / e.sigma, kind.power);
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
  return spread(of_kind(options, measured.strokes[stroke].kind).shares) * out;
}

double SigmaModel::place(const Stroke& stroke, const Evidence& e) const {
  const SigmaOptions::OfKind& kind = of_kind(options, stroke.kind);
  const double own = kind.place * e.bias_px, all = kind.views * bias_px;
  return spread(kind.shares) * footprint *
         std::sqrt(own * own + all * all + options.place_px * options.place_px);
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

PieceErrors piece_errors(const Sketch& measured, const std::vector<EdgePlace>& places,
                         StrokeKind nominal, bool held, const SigmaModel& sigma) {
  const int stroke = places[0].stroke, n = int(places.size());
  const MatrixXd root = root_of(calibrated_covariance(measured, stroke, sigma));
  const StrokeKind kind = measured.strokes[stroke].kind;
  const ControlPoints controls = control_points(measured, stroke);
  const double aside = sigma.place(measured.strokes[stroke], measured.evidence[stroke]);
  MatrixXd own(2 * n, root.cols());
  PieceErrors out;
  out.simpler = is_simpler(kind, nominal);
  const MatrixXd shapes = out.simpler ? form_errors(places) : MatrixXd(2 * n, 0);
  const int form = int(shapes.cols()), fitted = kRigid + kBend + kPose + form;
  out.shares = of_kind(sigma.options, kind).shares;
  out.stated = kScale;
  MatrixXd other = MatrixXd::Zero(2 * n, fitted + kScale);
  if (form > 0)
    other.middleCols(fitted - form, form) =
        spread(out.shares) * sigma.footprint *
        (kind == StrokeKind::kLine ? sigma.options.straight_form_px : sigma.options.form_px) *
        shapes;
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
      rows.rightCols<kScale>() =
          sigma.options.scale_percent / 100 * (across * (p.measured - sigma.alignment->centre));
    if (sigma.alignment)
      rows.middleCols<kPose>(kRigid + kBend) =
          spread(out.shares) * (across * pose_modes(*sigma.alignment, held, p.measured));
  }
  out.sigma = largest_deviation(own);
  out.systematic = largest_deviation(other);
  out.model.modes.resize(2 * n, own.cols() + other.cols());
  out.model.modes << own, other;
  return out;
}

}  // namespace sketchsplat

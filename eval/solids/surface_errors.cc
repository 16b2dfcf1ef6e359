// SPDX-License-Identifier: MIT
#include "eval/solids/surface_errors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "datasets/types/dense.h"
#include "eval/inspect/stroke_errors.h"
#include "sketches/curve/curve.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kPlaces = 9;      // of a stroke
constexpr double kStep = 1e-5;  // of derivatives; of the extent
constexpr double kHeld = 1e-4;  // [rad] axes that are parallel or square to this are so exactly
constexpr double kNone = 1e-8;  // of the largest eigenvalue: what is less is nothing
constexpr double kOpen = 1e-3;  // share of a gradient along open moves that is none

// Strokes that bound faces of a surface.
std::vector<std::set<int>> strokes_of(const Solid& solid) {
  std::vector<std::set<int>> out(solid.surfaces.size());
  for (const SolidFace& face : solid.faces)
    for (const Loop& loop : face.loops)
      for (const LoopStroke& s : loop) out[face.surface].insert(s.stroke);
  return out;
}

bool tells(const Solid& solid, int stroke) {
  const Evidence& e = solid.edges.evidence[stroke];
  return !solid.inferred[stroke] && (!e.covariance.empty() || e.sigma > 0) &&
         !is_open(solid.edges, stroke);
}

// Derivative of a surface's distance at a point by the surface's moves, and by the point.
VectorXd by_moves(const Surface& s, const Vector3d& p, double reach) {
  const int n = int(moves_of(s.kind).size());
  VectorXd out(n);
  for (int k = 0; k < n; ++k) {
    const VectorXd step = kStep * reach * VectorXd::Unit(n, k);
    out[k] =
        (surface_distance(moved(s, step, reach), p) - surface_distance(moved(s, -step, reach), p)) /
        (2 * kStep * reach);
  }
  return out;
}

Vector3d by_point(const Surface& s, const Vector3d& p, double reach) {
  Vector3d out;
  for (int k = 0; k < 3; ++k) {
    const Vector3d step = kStep * reach * Vector3d::Unit(k);
    out[k] = (surface_distance(s, p + step) - surface_distance(s, p - step)) / (2 * kStep * reach);
  }
  return out;
}

// Orthonormal columns that a symmetric matrix takes to nothing, and the others.
std::pair<MatrixXd, MatrixXd> split(const MatrixXd& matrix) {
  const auto es = eigen_symmetric(matrix);
  const double largest = matrix.rows() > 0 ? es.values.maxCoeff() : 0;
  int none = 0;
  while (none < matrix.rows() && !(es.values[none] > kNone * largest)) ++none;
  return {es.vectors.leftCols(none), es.vectors.rightCols(matrix.rows() - none)};
}

double largest_sigma(const MatrixXd& errors) {
  return std::sqrt(std::max(0.0, eigenvalues_symmetric(errors * errors.transpose()).maxCoeff()));
}

}  // namespace

const std::vector<SurfaceMove>& moves_of(SurfaceKind kind) {
  using M = SurfaceMove;
  static const std::vector<SurfaceMove> kMoves[kNumSurfaceKinds] = {
      {M::kAlong, M::kTiltX, M::kTiltY},
      {M::kAcrossX, M::kAcrossY, M::kTiltX, M::kTiltY, M::kRadius},
      {M::kAcrossX, M::kAcrossY, M::kTiltX, M::kTiltY, M::kRadius, M::kSlope},
      {M::kAcrossX, M::kAcrossY, M::kAlong, M::kRadius},
      {M::kAcrossX, M::kAcrossY, M::kAlong, M::kTiltX, M::kTiltY, M::kRadius, M::kMinorRadius},
      {}};  // an extrusion is as its profile was measured
  return kMoves[int(kind)];
}

Surface moved(const Surface& surface, const VectorXd& by, double reach) {
  Surface out = surface;
  const Vector3d x = surface.axis.unitOrthogonal(), y = surface.axis.cross(x);
  const std::vector<SurfaceMove>& moves = moves_of(surface.kind);
  for (size_t k = 0; k < moves.size(); ++k) {
    const double d = by[Eigen::Index(k)];
    switch (moves[k]) {
      case SurfaceMove::kAcrossX:
        out.origin += d * x;
        break;
      case SurfaceMove::kAcrossY:
        out.origin += d * y;
        break;
      case SurfaceMove::kAlong:
        out.origin += d * surface.axis;
        break;
      case SurfaceMove::kTiltX:
        out.axis += d / reach * x;
        break;
      case SurfaceMove::kTiltY:
        out.axis += d / reach * y;
        break;
      case SurfaceMove::kRadius:
        out.radius += d;
        break;
      case SurfaceMove::kSlope:
        out.slope += d / reach;
        break;
      case SurfaceMove::kMinorRadius:
        out.minor_radius += d;
        break;
    }
  }
  out.axis.normalize();
  return out;
}

SurfaceErrors::SurfaceErrors(const Solid& solid, const SigmaModel& sigma)
    : surfaces_(solid.surfaces), first_{0}, reach_(largest_extent(solid.edges)) {
  if (!(reach_ > 0)) reach_ = 1;
  centre(solid);
  for (const Surface& s : surfaces_) first_.push_back(first_.back() + int(moves_of(s.kind).size()));
  const int n = first_.back();
  MatrixXd normal = MatrixXd::Zero(n, n);
  const int common = kErrorsOfStroke * solid.edges.size();  // first error of a whole surface
  MatrixXd push = MatrixXd::Zero(n, common + int(surfaces_.size()));
  const std::vector<std::set<int>> strokes = strokes_of(solid);
  for (int s = 0; s < int(surfaces_.size()); ++s)
    for (const int stroke : strokes[s]) {
      if (!tells(solid, stroke)) continue;
      const StrokeErrors errors(solid.edges, sigma, stroke);
      const double weight = stroke_length(solid.edges, stroke) / kPlaces,
                   aside = sigma.place(solid.edges.strokes[stroke], solid.edges.evidence[stroke]);
      const int size = first_[s + 1] - first_[s];
      for (int i = 0; i < kPlaces; ++i) {
        const double t = (i + 0.5) / kPlaces;
        Vector3d p, d;
        evaluate_stroke(solid.edges, stroke, t, &p, &d);
        const VectorXd a = by_moves(surfaces_[s], p, reach_);
        const Vector3d g = by_point(surfaces_[s], p, reach_);
        normal.block(first_[s], first_[s], size, size) += weight * a * a.transpose();
        push.block(first_[s], kErrorsOfStroke * stroke, size, kErrorsOfStroke) -=
            weight * a * (g.transpose() * errors.at(t));
        push.block(first_[s], common + s, size, 1) -= weight * aside * a;
      }
    }
  solve(normal, push);
}

// Where the numbers of a surface depend on one another least.
void SurfaceErrors::centre(const Solid& solid) {
  const std::vector<std::set<int>> strokes = strokes_of(solid);
  for (size_t i = 0; i < surfaces_.size(); ++i) {
    Vector3d middle = Vector3d::Zero();
    double length = 0;
    for (const int s : strokes[i]) {
      const double own = stroke_length(solid.edges, s);
      for (int k = 0; k < kPlaces; ++k) {
        Vector3d p, d;
        evaluate_stroke(solid.edges, s, (k + 0.5) / kPlaces, &p, &d);
        middle += own / kPlaces * p;
      }
      length += own;
    }
    if (!(length > 0)) continue;
    Surface& s = surfaces_[i];
    const Vector3d from = middle / length - s.origin;
    const double along = from.dot(s.axis);
    if (s.kind == SurfaceKind::kPlane) s.origin += from - along * s.axis;
    if (s.kind == SurfaceKind::kCylinder || s.kind == SurfaceKind::kCone) {
      s.origin += along * s.axis;
      s.radius += along * s.slope;
    }
  }
}

MatrixXd SurfaceErrors::held() const {
  std::vector<VectorXd> rows;
  const auto tilts = [&](int s, const Vector3d& towards, VectorXd* row) {
    const std::vector<SurfaceMove>& moves = moves_of(surfaces_[s].kind);
    const Vector3d x = surfaces_[s].axis.unitOrthogonal(), y = surfaces_[s].axis.cross(x);
    for (size_t k = 0; k < moves.size(); ++k) {
      if (moves[k] == SurfaceMove::kTiltX) (*row)[first_[s] + int(k)] += towards.dot(x);
      if (moves[k] == SurfaceMove::kTiltY) (*row)[first_[s] + int(k)] += towards.dot(y);
    }
  };
  for (int i = 0; i < int(surfaces_.size()); ++i)
    for (int k = i + 1; k < int(surfaces_.size()); ++k) {
      if (surfaces_[i].kind == SurfaceKind::kSphere || surfaces_[k].kind == SurfaceKind::kSphere)
        continue;
      const Vector3d &a = surfaces_[i].axis, &b = surfaces_[k].axis;
      if (std::abs(a.dot(b)) < kHeld) {
        rows.push_back(VectorXd::Zero(first_.back()));
        tilts(i, b, &rows.back()), tilts(k, a, &rows.back());
      } else if (a.cross(b).norm() < kHeld) {
        const double sign = a.dot(b) < 0 ? -1 : 1;
        for (const Vector3d& u :
             {Vector3d(a.unitOrthogonal()), Vector3d(a.cross(a.unitOrthogonal()))}) {
          rows.push_back(VectorXd::Zero(first_.back()));
          tilts(i, u, &rows.back()), tilts(k, -sign * u, &rows.back());
        }
      }
    }
  MatrixXd out(Eigen::Index(rows.size()), first_.back());
  for (size_t r = 0; r < rows.size(); ++r) out.row(Eigen::Index(r)) = rows[r];
  return out;
}

void SurfaceErrors::solve(const MatrixXd& normal, const MatrixXd& push) {
  const MatrixXd rows = held();
  kept_ = split(rows.transpose() * rows).first;
  const MatrixXd inner = kept_.transpose() * normal * kept_;
  const auto [none, known] = split(inner);
  free_ = kept_ * none;
  const MatrixXd along = kept_ * known, own = along.transpose() * normal * along;
  errors_ = along * solve_symmetric(own, along.transpose() * push);
}

bool SurfaceErrors::open(const VectorXd& gradient) const {
  return (free_.transpose() * gradient).norm() > kOpen * (kept_.transpose() * gradient).norm();
}

double SurfaceErrors::sigma(const Value& value, const std::vector<int>& of) const {
  VectorXd gradient = VectorXd::Zero(first_.back());
  for (const int s : of) {
    const int n = first_[s + 1] - first_[s];
    for (int k = 0; k < n; ++k) {
      const VectorXd step = kStep * reach_ * VectorXd::Unit(n, k);
      double end[2];
      for (const int side : {0, 1}) {
        std::vector<Surface> all = surfaces_;
        all[s] = moved(all[s], side ? step : VectorXd(-step), reach_);
        end[side] = value(all);
      }
      gradient[first_[s] + k] = (end[1] - end[0]) / (2 * kStep * reach_);
    }
  }
  if (!gradient.allFinite() || open(gradient)) return std::numeric_limits<double>::quiet_NaN();
  return (gradient.transpose() * errors_).norm();
}

double SurfaceErrors::sigma(int surface, const std::vector<SurfaceMove>& moves) const {
  const std::vector<SurfaceMove>& all = moves_of(surfaces_[surface].kind);
  std::vector<int> rows;
  for (size_t k = 0; k < all.size(); ++k)
    if (std::count(moves.begin(), moves.end(), all[k])) rows.push_back(first_[surface] + int(k));
  MatrixXd out(Eigen::Index(rows.size()), errors_.cols());
  for (size_t r = 0; r < rows.size(); ++r) {
    if (open(VectorXd::Unit(first_.back(), rows[r])))
      return std::numeric_limits<double>::quiet_NaN();
    out.row(Eigen::Index(r)) = errors_.row(rows[r]);
  }
  return rows.empty() ? std::numeric_limits<double>::quiet_NaN() : largest_sigma(out);
}

}  // namespace sketchsplat

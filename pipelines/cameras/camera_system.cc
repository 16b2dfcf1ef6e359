// SPDX-License-Identifier: MIT
#include "pipelines/cameras/camera_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kPose = CameraUnknowns::kPose, kShared = CameraUnknowns::kMostShared;

constexpr double kLeastSigma = 0.05;  // [px] of an edgel, and of a stroke in a view
constexpr double kBiweight = 4.685;   // standard deviations: 95 % efficient
constexpr double kLikeOthers = 6;     // views of a stroke that tell as much of it as all strokes do

}  // namespace

CameraSystem::CameraSystem(const Sketch& sketch, const Observation& o, const EdgeWorld& world,
                           const StatedCameras& stated, const CameraPrior& prior,
                           const CameraFitOptions& options)
    : options_(options),
      layout_(o.layout),
      middle_(o.samples.position.rowwise().mean()),
      radius_(image_radii(o, world, middle_)),
      cameras_(stated.views, middle_, radius_, prior),
      prior_(point_prior(cameras_, stated.points)) {
  prior_.information += cameras_.information().asDiagonal();
  for (int s = 0; s < sketch.size(); ++s) {
    kinds_.push_back(sketch.strokes[s].kind);
    now_.strokes.push_back(control_points(sketch, s));
  }
  points_.resize(layout_.size()), tangents_.resize(layout_.size());
  now_.cameras = cameras_.values_of(world.views);
  place(now_);
  std::vector<int> ranks(cameras_.cameras());
  for (int v = 0; v < cameras_.views(); ++v) rank_.push_back(ranks[cameras_.camera_of(v)]++);
  list_rows(o, world);
  weigh();
  before_ = offset_px();
}

void CameraSystem::list_rows(const Observation& o, const EdgeWorld& world) {
  of_stroke_.assign(1, 0);
  of_view_.resize(world.views.size());
  std::vector<int> offset(world.views.size());
  for (int s = 0; s + 1 < int(layout_.first.size()); ++s) {
    std::fill(offset.begin(), offset.end(), -1);
    for (int m = o.matches.first[layout_.first[s]]; m < o.matches.first[layout_.first[s + 1]];
         ++m) {
      const SampleMatch& match = o.matches.matches[m];
      const View& view = world.views[match.view];
      const Edgel& e = world.maps[match.view].edgels[match.edgel];
      Row row{s, match.sample, match.view, {}, {e.nx, e.ny}, match.weight, match.weight, 0};
      if (!view.image_pixel({e.x, e.y}, &row.edgel)) continue;
      if (!std::isfinite(distance(row, nullptr))) continue;
      if (offset[match.view] < 0) offset[match.view] = offsets_++;
      row.offset = offset[match.view];
      of_view_[match.view].push_back(int(rows_.size()));
      rows_.push_back(row);
    }
    of_stroke_.push_back(int(rows_.size()));
  }
}

// Edgels of a stroke in a view err together, by what its view makes of it, and each by itself.
void CameraSystem::weigh() {
  const std::vector<double> d = distances();
  std::vector<double> sum(offsets_), weight(offsets_), count(offsets_);
  for (size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    sum[row.offset] += row.weight * d[i];
    weight[row.offset] += row.weight;
    ++count[row.offset];
  }
  std::vector<double> within, common;
  for (size_t i = 0; i < rows_.size(); ++i)
    within.push_back(std::abs(d[i] - sum[rows_[i].offset] / weight[rows_[i].offset]));
  scatter_ = std::max(kLeastSigma, normal_sigma(within));
  for (int k = 0; k < offsets_; ++k) common.push_back(std::abs(sum[k] / weight[k]));
  offset_sigma_ = std::max(kLeastSigma, normal_sigma(common));
  const std::vector<double> sigma = sigma_of_strokes(common);
  for (Row& row : rows_) {
    const double still = sigma[row.stroke];
    const double r = common[row.offset] / (kBiweight * still);
    row.weight *= r * r < 1 ? std::pow(1 - r * r, 2) : 0;
    row.weight /= scatter_ * scatter_ + count[row.offset] * still * still;
  }
}

// Standard deviation [px] of each stroke's offsets in views. What is round wanders from view to
// view where sharp edges, by the same cameras, lie still.
std::vector<double> CameraSystem::sigma_of_strokes(const std::vector<double>& offsets) const {
  std::vector<std::vector<double>> own(kinds_.size());
  std::vector<char> known(offsets.size());
  for (const Row& row : rows_)
    if (!std::exchange(known[row.offset], 1)) own[row.stroke].push_back(offsets[row.offset]);
  const double all = kLikeOthers * offset_sigma_ * offset_sigma_;
  std::vector<double> sigma;
  for (std::vector<double>& of_stroke : own) {
    const double n = double(of_stroke.size());
    const double square = n > 0 ? std::pow(normal_sigma(std::move(of_stroke)), 2) : 0;
    sigma.push_back(std::max(kLeastSigma, std::sqrt((all + n * square) / (kLikeOthers + n))));
  }
  return sigma;
}

void CameraSystem::place(const State& state) {
  now_ = state;
  cameras_.set(state.cameras);
  parallel_for(layout_.size(), [&](int i) {
    const int s = layout_.stroke[i];
    const ControlPoints& c = now_.strokes[s];
    evaluate_curve<double>(kinds_[s], c.p.data(), layout_.t[i], &points_[i], &tangents_[i]);
  });
}

// Signed, along the normal of the stroke's image; NaN where there is none.
double CameraSystem::distance(const Row& row, Linear* out, const PointJacobian* moves) const {
  Vector2d pixel;
  CameraUnknowns::Derivatives by;
  if (!cameras_.image(row.view, points_[row.sample], &pixel, &by)) return NAN;
  const Vector2d along = by.point * tangents_[row.sample];
  if (!(along.norm() > 0)) return NAN;
  Vector2d normal = Vector2d(-along.y(), along.x()).normalized();
  if (normal.dot(row.normal) < 0) normal = -normal;
  const double d = normal.dot(pixel - row.edgel);
  if (out) {
    out->distance = d;
    out->stroke = (normal.transpose() * by.point * *moves).transpose();
    out->pose = by.pose.transpose() * normal;
    out->shared = by.shared.transpose() * normal;
  }
  return d;
}

std::vector<double> CameraSystem::distances() const {
  std::vector<double> d(rows_.size());
  parallel_for(int(rows_.size()), [&](int i) { d[i] = distance(rows_[i], nullptr); });
  return d;
}

double CameraSystem::cost() const {
  const VectorXd& x = now_.cameras;
  double sum = x.dot(prior_.information * x) + 2 * prior_.gradient.dot(x);
  const std::vector<double> d = distances();
  for (size_t i = 0; i < rows_.size(); ++i) sum += rows_[i].weight * d[i] * d[i];
  return sum;
}

void CameraSystem::linearise(std::vector<Linear>* out) const {
  out->resize(rows_.size());
  parallel_for(int(kinds_.size()), 1, [&](int s) {
    PointJacobian moves;
    int sample = -1;
    for (int i = of_stroke_[s]; i < of_stroke_[s + 1]; ++i) {
      if (rows_[i].sample != sample)
        moves = point_jacobian(kinds_[s], now_.strokes[s], layout_.t[sample = rows_[i].sample]);
      distance(rows_[i], &(*out)[i], &moves);
    }
  });
}

bool CameraSystem::counts(const Row& row, const Part& part) const {
  return part.by == Part::kAll ||
         (part.by == Part::kStrokes ? row.stroke : rank_[row.view]) % 2 == part.half;
}

// Normal equations of the strokes, and what is left of those of the cameras without them.
void CameraSystem::assemble(const std::vector<Linear>& rows, double damping, const Part& part) {
  const int n = int(kinds_.size()), size = cameras_.size();
  normals_.resize(n);
  parallel_for(n, 1, [&](int s) {
    StrokeNormal& normal = normals_[s];
    StrokeMatrix A = StrokeMatrix::Zero();
    normal.gradient.setZero();
    normal.cross = MatrixXd::Zero(kStrokeUnknowns, size);
    normal.root.setZero();
    if (!options_.strokes_move) return;
    for (int i = of_stroke_[s]; i < of_stroke_[s + 1]; ++i) {
      if (!counts(rows_[i], part)) continue;
      const Linear& r = rows[i];
      const int camera = cameras_.camera_of(rows_[i].view), shared = cameras_.num_shared(camera);
      const StrokeVector j = rows_[i].weight * r.stroke;
      A.noalias() += j * r.stroke.transpose();
      normal.gradient += j * r.distance;
      normal.cross.middleCols<kPose>(cameras_.pose_column(rows_[i].view)).noalias() +=
          j * r.pose.transpose();
      normal.cross.middleCols(cameras_.shared_column(camera), shared).noalias() +=
          j * r.shared.head(shared).transpose();
    }
    normal.root = root_of_inverse(A, damping);
  });
  hessian_ = prior_.information;
  gradient_ = prior_.gradient + prior_.information * now_.cameras;
  for (int v = 0; v < int(of_view_.size()); ++v) {
    const int camera = cameras_.camera_of(v), shared = cameras_.num_shared(camera);
    const int p = cameras_.pose_column(v), c = cameras_.shared_column(camera);
    Matrix<double, kPose, kPose> poses = Matrix<double, kPose, kPose>::Zero();
    Matrix<double, kPose, kShared> mixed = Matrix<double, kPose, kShared>::Zero();
    Matrix<double, kShared, kShared> both = Matrix<double, kShared, kShared>::Zero();
    for (const int i : of_view_[v]) {
      if (!counts(rows_[i], part)) continue;
      const Linear& r = rows[i];
      const double w = rows_[i].weight;
      poses.noalias() += w * r.pose * r.pose.transpose();
      mixed.noalias() += w * r.pose * r.shared.transpose();
      both.noalias() += w * r.shared * r.shared.transpose();
      gradient_.segment<kPose>(p) += w * r.distance * r.pose;
      gradient_.segment(c, shared) += w * r.distance * r.shared.head(shared);
    }
    hessian_.block<kPose, kPose>(p, p) += poses;
    hessian_.block(p, c, kPose, shared) += mixed.leftCols(shared);
    hessian_.block(c, p, shared, kPose) += mixed.leftCols(shared).transpose();
    hessian_.block(c, c, shared, shared) += both.topLeftCorner(shared, shared);
  }
  hessian_.diagonal() *= 1 + damping;
  eliminate(normals_, &hessian_, &gradient_);
}

CameraSystem::State CameraSystem::step() const {
  State next = now_;
  const VectorXd move = -solve_symmetric(hessian_, gradient_);
  next.cameras += move;
  for (size_t s = 0; s < next.strokes.size(); ++s) {
    const StrokeVector by = normals_[s].step(move);
    ControlPoints& c = next.strokes[s];
    for (int k = 0; k < c.count; ++k) c.p[k] += by.segment<3>(3 * k);
  }
  return next;
}

// Robust standard deviation of the offsets of strokes in views.
double CameraSystem::offset_px() const {
  const std::vector<double> d = distances();
  std::vector<double> sum(offsets_), weight(offsets_), offset;
  for (size_t i = 0; i < rows_.size(); ++i) {
    sum[rows_[i].offset] += rows_[i].match * d[i];
    weight[rows_[i].offset] += rows_[i].match;
  }
  for (int k = 0; k < offsets_; ++k) offset.push_back(std::abs(sum[k] / weight[k]));
  return normal_sigma(offset);
}

void CameraSystem::solve() {
  constexpr double kEnough = 1e-6;  // of the cost
  constexpr int kTrials = 6;
  std::vector<Linear> rows;
  double damping = 1e-6, least = cost();
  for (int round = 0; round < options_.steps; ++round) {
    linearise(&rows);
    const State before = now_;
    const double last = least;
    for (int trial = 0; trial < kTrials; ++trial) {
      assemble(rows, damping);
      place(step());
      least = cost();
      if (least <= last) break;
      place(before);
      if (least - last < kEnough * last) trial = kTrials;  // round-off
      least = last, damping = 30 * damping;
    }
    damping = std::max(1e-6, damping / 30);
    if (!(last - least > kEnough * last)) break;
  }
}

}  // namespace sketchsplat

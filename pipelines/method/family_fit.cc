// SPDX-License-Identifier: MIT
#include "pipelines/method/family_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/views/unexplained.h"
#include "pipelines/survey/explained.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_jacobian.h"
#include "sketches/curve/sample.h"

namespace sketchsplat {
namespace {

constexpr int kDirections = 8;                       // of edgels, over 180 deg
constexpr double kWidest = 0.1;                      // [extents] reach of the first steps
constexpr double kNear = 4;                          // [px] the edgels' own look-up reaches as far
constexpr double kNearest = 1.5;                     // [px] reach of the last steps
constexpr int kFarSteps = 2, kSteps = 3;             // per reach
constexpr double kFarSpacing = 6, kNearSpacing = 2;  // [px] at least, of places on the strokes
constexpr double kCell = 4;       // [px] of the look-up, which is for reaches beyond kNear
constexpr double kFarPlaces = 3;  // on a stroke in a view whose errors are their own: model errors
constexpr double kNearPlaces = 12;  // the same at the end: the edgels' errors
constexpr double kNearSigma = 0.4;  // [px] of an edgel at the end
constexpr int kBlock = 8;           // edgels in a row that belong to one stroke
constexpr int kModes = 2;           // along which starts are tried
constexpr double kFar = 1.3;        // standard deviations that these are moved by
constexpr double kHopeless = 0.65;  // of the edgels within kNear, at least, after the first steps

int direction_of(double nx, double ny) {
  const double turn = std::atan2(ny, nx) / M_PI + 1;  // the sign of a normal means nothing
  return int(std::floor(turn * kDirections)) % kDirections;
}

// What a start at the middle of the bounds is moved by.
Similarity into_bounds(const Sketch& sketch, const EdgeWorld& world) {
  Eigen::AlignedBox3d box;
  for (int s = 0; s < sketch.size(); ++s) {
    const Eigen::Matrix3Xd points = sample_stroke(sketch, s, stroke_length(sketch, s) / 16);
    for (int k = 0; k < points.cols(); ++k) box.extend(Eigen::Vector3d(points.col(k)));
  }
  Similarity out;
  out.scale = world.bounds.sizes().maxCoeff() / std::max(1e-12, box.sizes().maxCoeff());
  out.translation = world.bounds.center() - out.scale * box.center();
  return out;
}

}  // namespace

// Nearest edgel of about a direction.
class FamilyFit::Lookup {
 public:
  Lookup(const EdgelMap& map, double reach_px) : map_(&map) {
    width_ = int(map.width / kCell) + 1, height_ = int(map.height / kCell) + 1;
    for (auto& cells : nearest_) cells.assign(size_t(width_) * height_, -1);
    reach2_ = (reach_px + kCell) * (reach_px + kCell);
    for (int e = 0; e < int(map.edgels.size()); ++e) {
      const Edgel& edgel = map.edgels[e];
      const int u = std::clamp(int(edgel.x / kCell), 0, width_ - 1);
      const int v = std::clamp(int(edgel.y / kCell), 0, height_ - 1);
      offer(&nearest_[direction_of(edgel.nx, edgel.ny)], u, v, e);
    }
    for (auto& cells : nearest_) spread(&cells);
  }

  // Of the direction's bin and the one beside it that is nearer. `normal`: of the projected curve.
  int nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& normal) const {
    const int u = int(std::floor(p.x() / kCell)), v = int(std::floor(p.y() / kCell));
    if (u < 0 || v < 0 || u >= width_ || v >= height_) return -1;
    const double turn = (std::atan2(normal.y(), normal.x()) / M_PI + 1) * kDirections;
    const int bin = int(std::floor(turn));
    const int beside = turn - bin > 0.5 ? bin + 1 : bin - 1;
    int best = -1;
    double least = 1e30;
    for (const int b : {bin, beside}) {
      const int e = nearest_[(b + kDirections) % kDirections][size_t(v) * width_ + u];
      if (e < 0) continue;
      const double d = std::hypot(map_->edgels[e].x - p.x(), map_->edgels[e].y - p.y());
      if (d < least) least = d, best = e;
    }
    return best;
  }

 private:
  void offer(std::vector<int>* cells, int u, int v, int edgel) const {
    int& best = (*cells)[size_t(v) * width_ + u];
    if (edgel < 0 || edgel == best) return;
    const auto distance2 = [&](int e) {
      const double x = map_->edgels[e].x - (u + 0.5) * kCell;
      const double y = map_->edgels[e].y - (v + 0.5) * kCell;
      return x * x + y * y;
    };
    const double d = distance2(edgel);
    if (d < reach2_ && (best < 0 || d < distance2(best))) best = edgel;
  }

  // Nearest edgels spread to the neighbours, down and up (Danielsson 1980, "Euclidean distance
  // mapping").
  void spread(std::vector<int>* cells) const {
    const auto from = [&](int u, int v, int du, int dv) {
      const int a = u + du, b = v + dv;
      if (a < 0 || b < 0 || a >= width_ || b >= height_) return;
      offer(cells, u, v, (*cells)[size_t(b) * width_ + a]);
    };
    for (int v = 0; v < height_; ++v) {
      for (int u = 0; u < width_; ++u)
        from(u, v, -1, 0), from(u, v, 0, -1), from(u, v, -1, -1), from(u, v, 1, -1);
      for (int u = width_ - 1; u >= 0; --u) from(u, v, 1, 0);
    }
    for (int v = height_ - 1; v >= 0; --v) {
      for (int u = width_ - 1; u >= 0; --u)
        from(u, v, 1, 0), from(u, v, 0, 1), from(u, v, 1, 1), from(u, v, -1, 1);
      for (int u = 0; u < width_; ++u) from(u, v, -1, 0);
    }
  }

  const EdgelMap* map_;
  int width_, height_;
  double reach2_ = 0;  // [px^2]
  std::array<std::vector<int>, kDirections> nearest_;
};

FamilyFit::FamilyFit(const Family& family, const EdgeWorld& world, int most_views)
    : family_(family), world_(world) {
  const int all = int(world.views.size()), count = std::min(all, most_views);
  for (int k = 0; k < count; ++k) views_.push_back(int((long(k) * all) / count));
  precision_ = solve_symmetric(
      family.covariance,
      Eigen::MatrixXd::Identity(family.covariance.rows(), family.covariance.cols()));
  widest_px_ = std::max(2 * kNear, kWidest * world.bounds.sizes().maxCoeff() / world.footprint);
  lookups_.resize(views_.size());
  parallel_for(int(views_.size()), 1, [&](int k) {
    lookups_[k] = std::make_unique<Lookup>(world.maps[views_[k]], widest_px_);
  });
}

FamilyFit::~FamilyFit() = default;

Sketch FamilyFit::sketch(const Sibling& sibling) const {
  return moved(family_.with(sibling.numbers), sibling.pose);
}

std::vector<SampleMatch> FamilyFit::far_matches(const CurvePoints& samples, double reach_px) const {
  std::vector<std::vector<SampleMatch>> by_view(views_.size());
  parallel_for(int(views_.size()), 1, [&](int k) {
    const View& view = world_.views[views_[k]];
    const std::vector<Edgel>& edgels = world_.maps[views_[k]].edgels;
    std::vector<std::pair<float, int>> owner(edgels.size() / kBlock + 1, {1e9f, -1});
    std::vector<int> curve_of;
    for (size_t c = 0; c + 1 < samples.first.size(); ++c)
      for (int i = samples.first[c]; i < samples.first[c + 1]; ++i) {
        double depth;
        const Eigen::Vector3d x = samples.position.col(i);
        const Eigen::Vector2d p = view.project(x, &depth);
        if (!(depth > 0) || !view.camera.contains(p)) continue;
        const Eigen::Vector3d q = view.cam_from_world * x;
        const Eigen::Vector2d along = view.camera.project_jacobian(q) *
                                      (view.cam_from_world.rotation * samples.tangent.col(i));
        if (!(along.squaredNorm() > 0)) continue;
        const int e = lookups_[k]->nearest(p, {-along.y(), along.x()});
        if (e < 0) continue;
        const double far = std::hypot(p.x() - edgels[e].x, p.y() - edgels[e].y) / reach_px;
        if (!(far < 1)) continue;
        const double d =
            (p.x() - edgels[e].x) * edgels[e].nx + (p.y() - edgels[e].y) * edgels[e].ny;
        by_view[k].push_back({i, views_[k], e, float(d), float((1 - far * far) * (1 - far * far))});
        curve_of.push_back(int(c));
        auto& own = owner[e / kBlock];
        own = std::min(own, {float(far), int(c)});
      }
    // Edgels belong to the stroke that lies nearest: hidden ones must not pull at them.
    std::vector<SampleMatch> kept;
    for (size_t m = 0; m < by_view[k].size(); ++m)
      if (owner[by_view[k][m].edgel / kBlock].second == curve_of[m]) kept.push_back(by_view[k][m]);
    by_view[k].swap(kept);
  });
  std::vector<SampleMatch> out;
  for (const auto& list : by_view) out.insert(out.end(), list.begin(), list.end());
  return out;
}

double FamilyFit::misfit(const Sibling& sibling) const {
  const CurvePoints points = points_on(sketch(sibling), 0.5 * widest_px_ * world_.footprint);
  double fit = 0;
  for (const SampleMatch& m : far_matches(points, widest_px_)) fit += m.weight;
  return 1 - fit / std::max(1.0, double(points.first.back()) * double(views_.size()));
}

std::vector<Sibling> FamilyFit::starts() const {
  std::vector<Eigen::VectorXd> members = {family_.mean};
  for (int k = 0; k < family_.siblings; ++k) members.push_back(family_.numbers.col(k));
  const auto es = eigen_symmetric(family_.covariance);
  for (int k = 0; k < std::min<int>(kModes, int(family_.modes.size())); ++k) {
    const Eigen::Index at = es.values.size() - 1 - k;
    const Eigen::VectorXd move =
        kFar * std::sqrt(std::max(0.0, es.values[at])) * es.vectors.col(at);
    members.push_back(family_.mean + move);
    members.push_back(family_.mean - move);
  }
  std::vector<std::pair<double, Sibling>> scored;
  for (const Eigen::VectorXd& numbers : members)
    for (const Similarity& pose : {Similarity{}, into_bounds(family_.with(numbers), world_)}) {
      const Sibling start{numbers, pose};
      scored.emplace_back(misfit(start), start);
    }
  std::stable_sort(scored.begin(), scored.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Sibling> out;
  for (auto& [unused, start] : scored) out.push_back(std::move(start));
  return out;
}

namespace {

// Derivative of a sample by the numbers that its stroke's control points have, and by a small
// shift, turn and growth of all about `centre`.
struct SampleJacobian {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 12> by_numbers;
  std::vector<int> numbers;
  Eigen::Matrix<double, 3, 7> by_pose;
};

SampleJacobian jacobian_of(const Family& family, const Sketch& placed, int stroke, double t,
                           const Eigen::Vector3d& position, const Similarity& pose,
                           const Eigen::Vector3d& centre) {
  SampleJacobian out;
  const Stroke& s = placed.strokes[stroke];
  const ControlPoints controls = control_points(placed, stroke);
  const Eigen::Matrix<double, 3, 12> by_controls = curve_jacobian(s.kind, controls, t);
  out.by_numbers.resize(3, 3 * controls.count);
  const bool closed = is_closed(s.kind);
  for (int c = 0; c < controls.count; ++c) {
    const bool is_begin = !closed && c == 0, is_end = !closed && c == controls.count - 1;
    for (int axis = 0; axis < 3; ++axis) {
      const int number = is_begin ? family.nodes[3 * s.begin + axis]
                         : is_end ? family.nodes[3 * s.end + axis]
                                  : family.handles[3 * (s.handle + c - !closed) + axis];
      out.numbers.push_back(number);
      out.by_numbers.col(3 * c + axis) =
          pose.scale * (by_controls.middleCols<3>(3 * c) * pose.rotation.col(axis));
    }
  }
  const Eigen::Vector3d arm = position - centre;
  out.by_pose.leftCols<3>().setIdentity();
  out.by_pose.middleCols<3>(3) << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  out.by_pose.col(6) = arm;
  return out;
}

}  // namespace

Sibling FamilyFit::step(const Sibling& now, double reach_px) const {
  const Sketch s = sketch(now);
  const bool far = reach_px > kNear;
  const SampleLayout layout = plan_samples(
      s, (far ? std::max(kFarSpacing, reach_px / 2) : kNearSpacing) * world_.footprint);
  const Samples samples = evaluate_samples(s, layout);
  const CurvePoints points{samples.position, samples.tangent, layout.first};
  MatchOptions match;
  match.reach_px = reach_px;
  match.exclusive_between = true;
  match.quadratics = false;
  const std::vector<SampleMatch> matches =
      far ? far_matches(points, reach_px) : match_samples(world_, points, match).matches;
  const int strokes = s.size(), g = int(now.numbers.size());
  std::vector<int> seen(size_t(strokes) * world_.views.size());
  for (const SampleMatch& m : matches) ++seen[m.view * strokes + layout.stroke[m.sample]];
  std::vector<Eigen::Matrix3d> information(layout.size(), Eigen::Matrix3d::Zero());
  Eigen::Matrix3Xd slope = Eigen::Matrix3Xd::Zero(3, layout.size());
  const double variance = std::pow(far ? reach_px / 4 : kNearSigma, 2);
  const double places = far ? kFarPlaces : kNearPlaces;
  for (const SampleMatch& m : matches) {
    const int n = seen[m.view * strokes + layout.stroke[m.sample]];
    const double w = m.weight / variance * std::min(1.0, places / n);
    const Eigen::Vector3d a = distance_gradient(world_, m, samples.position.col(m.sample));
    information[m.sample] += w * a * a.transpose();
    slope.col(m.sample) += w * a * double(m.distance_px);
  }
  const Eigen::Vector3d centre = samples.position.rowwise().mean();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(g + 7, g + 7);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(g + 7);
  a.topLeftCorner(g, g) = precision_;
  b.head(g) = precision_ * (family_.mean - now.numbers);
  for (int i = 0; i < layout.size(); ++i) {
    if (!(information[i].trace() > 0)) continue;
    const SampleJacobian j = jacobian_of(family_, s, layout.stroke[i], layout.t[i],
                                         samples.position.col(i), now.pose, centre);
    const int n = int(j.numbers.size());
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 19> all(3, n + 7);
    all << j.by_numbers, j.by_pose;
    std::vector<int> at = j.numbers;
    for (int k = 0; k < 7; ++k) at.push_back(g + k);
    const Eigen::MatrixXd h = all.transpose() * information[i] * all;
    const Eigen::VectorXd d = all.transpose() * slope.col(i);
    for (int r = 0; r < n + 7; ++r) {
      b[at[r]] -= d[r];
      for (int c = 0; c < n + 7; ++c) a(at[r], at[c]) += h(r, c);
    }
  }
  a.diagonal().tail(7).array() += 1e-9 * (1 + a.diagonal().tail(7).maxCoeff());
  const Eigen::VectorXd move = solve_symmetric(a, b);
  if (!move.allFinite()) return now;
  const Eigen::Matrix<double, 7, 1> p = move.tail(7);
  Similarity change;
  change.scale = std::exp(std::clamp(p[6], -0.3, 0.3));
  change.rotation = rotation_about(p.segment<3>(3));
  change.translation = centre + p.head(3) - change.scale * (change.rotation * centre);
  return {now.numbers + move.head(g), change * now.pose};
}

Sibling FamilyFit::fit(Sibling sibling) const {
  for (double reach = widest_px_; reach > kNear; reach /= 1.6)
    for (int k = 0; k < kFarSteps; ++k) sibling = step(sibling, reach);
  if (explained(sketch(sibling), kNear) < kHopeless) return sibling;
  for (const double reach : {kNear, 0.5 * (kNear + kNearest), kNearest, kNearest})
    for (int k = 0; k < kSteps; ++k) sibling = step(sibling, reach);
  return sibling;
}

namespace {

// Of one picture; above 0.
float median_strength(const std::vector<Edgel>& edgels) {
  std::vector<float> strengths;
  for (const Edgel& e : edgels) strengths.push_back(e.strength);
  return strengths.empty() ? 1.f : std::max(median(std::move(strengths)), 1e-6f);
}

}  // namespace

double FamilyFit::explained(const Sketch& sketch, double reach_px) const {
  const CurvePoints points = points_on(sketch, 2 * world_.footprint);
  const bool round = std::any_of(sketch.strokes.begin(), sketch.strokes.end(),
                                 [](const Stroke& s) { return s.kind != StrokeKind::kLine; });
  ExplainOptions explain;
  explain.reach_px = reach_px;
  std::vector<double> flagged(views_.size()), all(views_.size());
  parallel_for(int(views_.size()), 1, [&](int k) {
    const std::vector<Edgel>& edgels = world_.maps[views_[k]].edgels;
    std::vector<char> flags(edgels.size());
    explain_in_view(world_, views_[k], points, explain, &flags);
    const float usual = median_strength(edgels);
    for (size_t e = 0; e < edgels.size(); ++e) {
      const double weight = std::min(1.f, edgels[e].strength / usual);
      if (flags[e]) flagged[k] += weight;
      if (flags[e] || !(round && edgels[e].outline)) all[k] += weight;
    }
  });
  const double total = std::accumulate(all.begin(), all.end(), 0.0);
  return total > 0 ? std::accumulate(flagged.begin(), flagged.end(), 0.0) / total : 0;
}

}  // namespace sketchsplat

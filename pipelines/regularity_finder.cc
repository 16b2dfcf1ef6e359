// SPDX-License-Identifier: MIT
#include "pipelines/regularity_finder.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sketches/curve.h"

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Candidate = RegularityCandidate;
using Trial = RegularityTrial;

constexpr double kGate = 4;            // [sigma] beyond which nothing is tried
constexpr double kNews = 2;            // [sigma of the relation] less uncertain: known already
constexpr double kLeastSigma = 1e-4;   // [px] of a relation
constexpr double kMeaningless = 1e-6;  // share of its range in which a free coordinate is left

}  // namespace

RegularityFinder::RegularityFinder(const Sketch& sketch, const SketchQuadratic& quadratic,
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

bool RegularityFinder::is_conic(int i) const {
  const StrokeKind kind = s_.strokes[i].kind;
  return kind == StrokeKind::kArc || kind == StrokeKind::kCircle || kind == StrokeKind::kEllipse;
}

// The least squares skip a loop through one node.
bool RegularityFinder::is_usable(int i) const {
  const Stroke& stroke = s_.strokes[i];
  return is_closed(stroke.kind) || stroke.begin != stroke.end;
}

void RegularityFinder::apply(const VectorXd& move) {
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

int RegularityFinder::add_shared(const SharedQuantity& quantity, double range) {
  relations_.shared.push_back(quantity);
  used_.push_back(false);
  held_.emplace_back();
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
Gaussian::Rows RegularityFinder::sparse(const RelationRows& rows, bool own) const {
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

static double largest_deviation(const MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> es(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, es.eigenvalues().maxCoeff()));
}

// [px] of the residual, by the stroke or the point alone.
double RegularityFinder::own_sigma(const Relation& relation) {
  const RelationRows rows = linearize(s_, relations_, relation);
  if (!rows.jacobian.allFinite()) return HUGE_VAL;
  return largest_deviation(
      gaussian_.covariance(sparse(rows, relation.kind != RelationKind::kPerpendicular)));
}

// Sets the relations' sigmas, and asks what they cost and save. `naming`: log of the number of
// candidates among which they were found. What a relation tells, log(range / deviation), must
// exceed the price of a parameter, lest chance agreement pays.
Trial RegularityFinder::weigh(std::vector<Relation>* relations, double range_px, double naming) {
  Trial trial;
  if (exhausted()) return trial;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> residual;
  double sigma = 0;
  for (Relation& relation : *relations) {
    relation.sigma =
        std::clamp(options_.soft_share * own_sigma(relation), kLeastSigma, options_.soft_px);
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
  const Eigen::SelfAdjointEigenSolver<MatrixXd> es(s, Eigen::EigenvaluesOnly);
  for (int i = 0; i < k; ++i) {
    const double deviation = std::sqrt(std::max(0.0, es.eigenvalues()[i]));  // [sigma]
    if (!(deviation > kNews)) continue;
    trial.news = true;
    const double told = std::log(range_px / (deviation * sigma)) - naming / k;
    trial.gain += std::min(options_.price, told - options_.price);
  }
  s.diagonal().array() += 1;
  trial.nats = 0.5 * trial.residual.dot(s.ldlt().solve(trial.residual));
  if (!std::isfinite(trial.nats)) trial.news = false;
  return trial;
}

void RegularityFinder::take(const std::vector<Relation>& relations, const Trial& trial, bool pays) {
  if (exhausted()) return;
  work_ += double(trial.rows.rows()) * gaussian_.size() * (30 + gaussian_.taken());
  apply(gaussian_.observe(trial.rows, trial.residual, 1));
  for (const Relation& r : relations) {
    relations_.list.push_back(r);
    if (!pays) continue;
    used_[r.shared] = true;
    if (r.other >= 0) used_[r.other] = true;
  }
  if (pays) gain_ += trial.gain;
}

// A stroke and its own direction; sigma in rad.
Candidate RegularityFinder::along(int stroke) {
  Candidate c;
  c.value = stroke_direction(s_, stroke);
  const double length = stroke_length(s_, stroke);
  c.range = (is_conic(stroke) ? length / 2 : length) / unit_;
  c.relation.kind = RelationKind::kParallel;
  c.relation.stroke = stroke;
  c.relation.scale = c.range;
  Vector3d x, y;
  frame_of<double>(c.value, &x, &y);
  c.relation.across << x.transpose(), y.transpose();
  // Of the direction alone: the shared one is not asked.
  relations_.shared.push_back({SharedKind::kDirection, -1, c.value});
  c.relation.shared = int(relations_.shared.size()) - 1;
  c.sigma = own_sigma(c.relation) / c.range;
  relations_.shared.pop_back();
  return c;
}

static void sort_by_sigma(std::vector<Candidate>* c) {
  std::stable_sort(c->begin(), c->end(),
                   [](const Candidate& a, const Candidate& b) { return a.sigma < b.sigma; });
}

void RegularityFinder::find_directions() {
  std::vector<Candidate> candidates;
  for (int i = 0; i < s_.size(); ++i) {
    if (!is_usable(i) || stroke_direction(s_, i).isZero()) continue;
    const Candidate c = along(i);
    if (c.sigma < std::exp(-options_.price)) candidates.push_back(c);
  }
  sort_by_sigma(&candidates);
  for (Candidate& c : candidates) {
    Direction* nearest = nullptr;
    double cosine = 0;
    for (Direction& d : directions_) {
      const double here = std::abs(relations_.shared[d.shared].value.dot(c.value));
      if (here > cosine) cosine = here, nearest = &d;
    }
    std::vector<Relation> one = {c.relation};
    if (nearest && std::acos(std::min(1.0, cosine)) < kGate * (c.sigma + nearest->sigma)) {
      const Vector3d& along = relations_.shared[nearest->shared].value;
      one[0].shared = nearest->shared;
      one[0].sign = along.dot(c.value) < 0 ? -1 : 1;
      const Trial trial = weigh(&one, c.range, std::log(double(directions_.size())));
      if (trial.pays()) take(one, trial, true);
      if (trial.pays() || !trial.news) {
        nearest->strokes.push_back(c.relation.stroke);
        nearest->useful = true;
        continue;
      }
    }
    Direction d;
    d.shared = add_shared({SharedKind::kDirection, -1, c.value}, 1);
    d.sigma = c.sigma;
    d.strokes = {c.relation.stroke};
    one[0].shared = d.shared;
    one[0].sign = 1;
    take(one, weigh(&one, c.range, 0), false);
    directions_.push_back(d);
  }
}

void RegularityFinder::find_right_angles() {
  const auto right_angle = [&](const Direction& a, const Direction& b) {
    Relation r;
    r.kind = RelationKind::kPerpendicular;
    r.shared = a.shared, r.other = b.shared;
    r.scale = extent_ / unit_;
    return r;
  };
  const auto cosine = [&](const Direction& a, const Direction& b) {
    return std::abs(relations_.shared[a.shared].value.dot(relations_.shared[b.shared].value));
  };
  const int n = int(directions_.size());
  std::vector<std::pair<int, int>> pairs, right;
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b)
      if (directions_[a].useful && directions_[b].useful) pairs.emplace_back(a, b);
  for (const auto& [a, b] : pairs) {
    const Direction &u = directions_[a], &v = directions_[b];
    if (cosine(u, v) > kGate * (u.sigma + v.sigma)) continue;
    std::vector<Relation> one = {right_angle(u, v)};
    const Trial trial = weigh(&one, one[0].scale, std::log(double(pairs.size())));
    if (trial.pays()) take(one, trial, true);
    if (trial.pays() || !trial.news) right.emplace_back(a, b);
  }
  // The direction of one stroke alone may complete a frame.
  for (Direction& d : directions_) {
    if (d.useful) continue;
    for (const auto& [a, b] : right) {
      const Direction &u = directions_[a], &v = directions_[b];
      if (cosine(u, d) > kGate * (u.sigma + d.sigma)) continue;
      if (cosine(v, d) > kGate * (v.sigma + d.sigma)) continue;
      std::vector<Relation> two = {right_angle(u, d), right_angle(v, d)};
      const Trial trial = weigh(&two, two[0].scale, std::log(double(right.size())));
      if (!trial.pays()) continue;
      take(two, trial, true);
      d.useful = true;
      break;
    }
  }
}

// Candidates that lie together share a quantity: the surest one defines it, others join.
void RegularityFinder::group(std::vector<Candidate> candidates, const SharedQuantity& blank) {
  sort_by_sigma(&candidates);
  const double naming = std::log(std::max(1.0, double(candidates.size())));
  std::vector<bool> taken(candidates.size(), false);
  for (size_t a = 0; a < candidates.size(); ++a) {
    if (taken[a]) continue;
    std::vector<size_t> near;
    for (size_t b = a + 1; b < candidates.size(); ++b) {
      const double distance = (candidates[b].value - candidates[a].value).norm() / unit_;
      if (!taken[b] && distance < kGate * (candidates[a].sigma + candidates[b].sigma))
        near.push_back(b);
    }
    if (near.empty()) continue;
    SharedQuantity quantity = blank;
    quantity.value = candidates[a].value;
    const int shared = add_shared(quantity, extent_);
    std::vector<Relation> one = {candidates[a].relation};
    one[0].shared = shared;
    take(one, weigh(&one, candidates[a].range, 0), false);
    const auto hold = [&](const Relation& r) {
      held_[shared].insert(r.stroke >= 0 ? r.stroke : r.point);
    };
    hold(one[0]);
    for (size_t b : near) {
      one = {candidates[b].relation};
      one[0].shared = shared;
      const Trial trial = weigh(&one, candidates[b].range, naming);
      if (trial.pays()) take(one, trial, true);
      taken[b] = trial.pays() || !trial.news;
      if (taken[b]) hold(one[0]);
    }
  }
}

// Nodes, inner points of cubics and centres of conics about the direction; value: offset along it.
std::vector<Candidate> RegularityFinder::points_across(const Direction& direction) {
  const int nodes = int(s_.nodes.cols());
  std::set<int> points;
  for (int i = 0; i < s_.size(); ++i) {
    const Stroke& stroke = s_.strokes[i];
    if (!is_usable(i) || is_closed(stroke.kind)) continue;
    points.insert({stroke.begin, stroke.end});
    if (stroke.kind == StrokeKind::kBezier)
      points.insert({nodes + stroke.handle, nodes + stroke.handle + 1});
  }
  for (int i : direction.strokes)
    if (is_closed(s_.strokes[i].kind)) points.insert(nodes + s_.strokes[i].handle);
  std::vector<Candidate> out;
  const Vector3d normal = relations_.shared[direction.shared].value;
  relations_.shared.push_back({SharedKind::kPlane, direction.shared, Vector3d::Zero()});
  for (int p : points) {
    Candidate c;
    c.relation.kind = RelationKind::kCoplanar;
    c.relation.shared = int(relations_.shared.size()) - 1;
    c.relation.point = p;
    c.relation.scale = 1 / unit_;
    const Vector3d place = p < nodes ? s_.nodes.col(p) : s_.handles.col(p - nodes);
    c.value[0] = normal.dot(place - relations_.origin);
    c.sigma = own_sigma(c.relation);
    c.range = extent_ / unit_;
    if (c.sigma < c.range * std::exp(-options_.price)) out.push_back(c);
  }
  relations_.shared.pop_back();
  return out;
}

void RegularityFinder::find_planes() {
  for (const Direction& d : directions_)
    if (d.useful) group(points_across(d), {SharedKind::kPlane, d.shared, Vector3d::Zero()});
}

void RegularityFinder::find_axes() {
  for (const Direction& d : directions_) {
    std::vector<Candidate> candidates;
    const Vector3d along = relations_.shared[d.shared].value;
    Vector3d x, y;
    frame_of<double>(along, &x, &y);
    relations_.shared.push_back({SharedKind::kAxis, d.shared, Vector3d::Zero()});
    for (int i : d.strokes) {
      if (!is_conic(i)) continue;
      Candidate c;
      c.relation.kind = RelationKind::kCoaxial;
      c.relation.shared = int(relations_.shared.size()) - 1;
      c.relation.stroke = i;
      c.relation.across << x.transpose(), y.transpose();
      c.relation.scale = 1 / unit_;
      c.range = extent_ / unit_;
      c.sigma = own_sigma(c.relation);
      // The residual is the centre across the axis, which starts in the origin here.
      const VectorXd place = linearize(s_, relations_, c.relation).residual * unit_;
      c.value = place[0] * x + place[1] * y;
      if (c.sigma < c.range * std::exp(-options_.price)) candidates.push_back(c);
    }
    relations_.shared.pop_back();
    group(candidates, {SharedKind::kAxis, d.shared, Vector3d::Zero()});
  }
}

void RegularityFinder::find_radii() {
  std::vector<Candidate> candidates;
  relations_.shared.push_back({SharedKind::kRadius, -1, Vector3d::Zero()});
  for (int i = 0; i < s_.size(); ++i) {
    const StrokeKind kind = s_.strokes[i].kind;
    if (!is_usable(i) || (kind != StrokeKind::kArc && kind != StrokeKind::kCircle)) continue;
    Candidate c;
    c.relation.kind = RelationKind::kEqualRadius;
    c.relation.shared = int(relations_.shared.size()) - 1;
    c.relation.stroke = i;
    c.relation.scale = 1 / unit_;
    c.value[0] = linearize(s_, relations_, c.relation).residual[0] * unit_;
    c.range = c.value[0] / unit_;
    c.sigma = own_sigma(c.relation);
    if (c.sigma < c.range * std::exp(-options_.price)) candidates.push_back(c);
  }
  relations_.shared.pop_back();
  group(candidates, {SharedKind::kRadius, -1, Vector3d::Zero()});
}

void RegularityFinder::find(int stages) {
  if (stages > 0) find_directions();
  if (stages > 1) find_right_angles();
  if (stages > 2) find_planes();
  if (stages > 3) find_axes();
  if (stages > 4) find_radii();
}

Relations RegularityFinder::kept() const {
  Relations out = relations_;
  out.list.clear();
  for (const Relation& r : relations_.list)
    if (used_[r.shared]) out.list.push_back(r);
  return out;
}

// Does the stroke lie in the plane whose points are `held`?
bool RegularityFinder::lies_in(int stroke, const Direction& normal,
                               const std::set<int>& held) const {
  const Stroke& s = s_.strokes[stroke];
  const int handle = int(s_.nodes.cols()) + s.handle;
  if (is_conic(stroke) && std::count(normal.strokes.begin(), normal.strokes.end(), stroke) == 0)
    return false;
  if (is_closed(s.kind)) return held.count(handle) > 0;
  if (s.kind == StrokeKind::kBezier && !(held.count(handle) && held.count(handle + 1)))
    return false;
  return held.count(s.begin) && held.count(s.end);
}

std::vector<Regularity> RegularityFinder::regularities() const {
  std::vector<Regularity> out;
  const auto add = [&](RelationKind kind, std::set<int> strokes) {
    if (strokes.size() > 1) out.push_back({kind, {strokes.begin(), strokes.end()}});
  };
  const auto along = [&](int shared) -> const Direction& {
    return *std::find_if(directions_.begin(), directions_.end(),
                         [&](const Direction& d) { return d.shared == shared; });
  };
  for (int q = 0; q < int(relations_.shared.size()); ++q) {
    if (!used_[q]) continue;
    const SharedQuantity& shared = relations_.shared[q];
    if (shared.kind == SharedKind::kDirection) {
      const std::vector<int>& strokes = along(q).strokes;
      add(RelationKind::kParallel, {strokes.begin(), strokes.end()});
    } else if (shared.kind == SharedKind::kPlane) {
      std::set<int> strokes;
      for (int i = 0; i < s_.size(); ++i)
        if (lies_in(i, along(shared.direction), held_[q])) strokes.insert(i);
      add(RelationKind::kCoplanar, strokes);
    } else {
      add(shared.kind == SharedKind::kAxis ? RelationKind::kCoaxial : RelationKind::kEqualRadius,
          held_[q]);
    }
  }
  for (const Relation& r : relations_.list) {
    if (r.kind != RelationKind::kPerpendicular) continue;
    std::set<int> strokes;
    for (int q : {r.shared, r.other})
      strokes.insert(along(q).strokes.begin(), along(q).strokes.end());
    add(r.kind, strokes);
  }
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "edges/views/rim.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "datasets/types/dense.h"
#include "datasets/types/parallel.h"
#include "edges/views/normals_along.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kMostRounds = 12;
constexpr double kLeastSigmaPx = 0.1;  // of a view's median: what calibration leaves

// Unknowns: the axis relative to the curve in a frame that goes along with it, and the radius.
struct Model {
  Vector3d value = Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// At most so many samples of the curve, evenly, with a frame that turns no more than the curve
// does.
struct Frames {
  std::vector<Vector3d> point, tangent, e1, e2;
  Frames(const CurvePoints& curve, int most) {
    const int n = int(curve.position.cols()), count = std::min(n, most);
    const auto normals = normals_along(curve.tangent);
    for (int i = 0, k = 0; i < n && k < count; ++i) {
      if (i != int((k + 0.5) * n / count)) continue;
      point.push_back(curve.position.col(i)), tangent.push_back(curve.tangent.col(i));
      e1.push_back(normals[i].col(0)), e2.push_back(normals[i].col(1));
      ++k;
    }
  }
  int size() const { return int(point.size()); }
};

// The normal of the line of sight and the tangent, and what the unknowns do along it.
struct Normal {
  Vector3d direction, row;
};
Normal normal_of(const Frames& f, int sample, const Vector3d& camera, int side) {
  const Vector3d n = (f.point[sample] - camera).cross(f.tangent[sample]).normalized();
  return {n, {n.dot(f.e1[sample]), n.dot(f.e2[sample]), double(side)}};
}

// What one view says: the median place of the rim along its normal.
struct Sighting {
  Vector3d row = Vector3d::Zero();  // derivatives by the unknowns
  double place = 0;                 // world units
  double footprint = 0;
};
using Sightings = std::vector<std::optional<Sighting>>;  // per view

// A round surface has two rims, one on either side of its axis. Which one a view shows, the
// brighter side of the edge tells if what lies behind is alike everywhere; else any does.
enum class Sides { kByBrightness, kAny, kFirst };

// A sample of the curve in a view, taken for the rim on one side (1 or -1).
std::optional<Sighting> sight_sample(const EdgeWorld& world, int view, const Frames& f, int sample,
                                     const Model& model, int side, bool by_brightness,
                                     const RimOptions& options) {
  const View& v = world.views[view];
  const auto [n, row] = normal_of(f, sample, v.center_in_world(), side);
  const double foretold = row.dot(model.value);
  const Vector3d at = f.point[sample] + foretold * n;
  double depth;
  const Eigen::Vector2d p = v.project(at, &depth);
  if (!(depth > 0)) return std::nullopt;
  const int i = world.maps[view].nearest_at(p.x(), p.y());
  if (i < 0) return std::nullopt;
  const Edgel& e = world.maps[view].edgels[i];
  const double d = (e.x - p.x()) * e.nx + (e.y - p.y()) * e.ny;
  const Vector3d plane = world.plane_normal[view].col(i).cast<double>();
  if (std::abs(d) > options.reach_px ||
      std::abs(plane.dot(f.tangent[sample])) > std::sin(options.angle_deg * M_PI / 180))
    return std::nullopt;
  const Eigen::Vector2d in_image =
      v.camera.project_jacobian(v.cam_from_world * at) * (v.cam_from_world.rotation * n);
  const int brighter = in_image.x() * e.nx + in_image.y() * e.ny > 0 ? 1 : -1;
  if (by_brightness && brighter != side) return std::nullopt;
  const double footprint = depth / v.camera.fx;
  return Sighting{row, foretold + brighter * d * footprint, footprint};
}

std::optional<Sighting> sight(const EdgeWorld& world, int view, const Frames& f, const Model& model,
                              Sides sides, const RimOptions& options) {
  std::vector<Sighting> seen[2];  // by side
  for (int k = 0; k < f.size(); ++k)
    for (const int side : {1, -1}) {
      if (sides == Sides::kFirst && side < 0) continue;
      const auto s =
          sight_sample(world, view, f, k, model, side, sides == Sides::kByBrightness, options);
      if (s) seen[side > 0].push_back(*s);
    }
  std::vector<Sighting>& more = seen[seen[1].size() >= seen[0].size()];
  if (more.size() < std::max(2.0, options.share * f.size())) return std::nullopt;
  const auto middle = more.begin() + more.size() / 2;
  std::nth_element(more.begin(), middle, more.end(),
                   [](const Sighting& a, const Sighting& b) { return a.place < b.place; });
  return *middle;
}

constexpr double kWorstCondition = 1e9;

// Least squares; without a radius if `fixed`. False if the views do not tell.
bool solve(const Sightings& sightings, bool fixed, Model* model) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Vector3d g = Vector3d::Zero();
  for (const auto& s : sightings)
    if (s) {
      const double w = 1 / std::pow(kLeastSigmaPx * s->footprint, 2);
      H += w * s->row * s->row.transpose();
      g += w * s->row * s->place;
    }
  if (fixed)  // no pivot of another magnitude: units of length must not matter
    H.row(2).setZero(), H.col(2).setZero(), H(2, 2) = H.trace(), g(2) = 0;
  const Eigen::Matrix3d inverse = solve_symmetric(H, Eigen::Matrix3d::Identity());
  const auto norm = [](const Eigen::Matrix3d& m) {
    return m.cwiseAbs().colwise().sum().maxCoeff();
  };
  const double size = norm(H);
  if (!(size > 0) || !(size * norm(inverse) < kWorstCondition)) return false;
  model->value = solve_symmetric(H, g);
  model->covariance = inverse;
  // The scatter that is there, if it is larger.
  double squares = 0;
  int n = 0;
  for (const auto& s : sightings)
    if (s)
      squares +=
          std::pow((s->row.dot(model->value) - s->place) / (kLeastSigmaPx * s->footprint), 2),
          ++n;
  const int parameters = fixed ? 2 : 3;
  if (n > parameters) model->covariance *= std::max(1.0, squares / (n - parameters));
  return model->value.allFinite();
}

// Logarithm of how much likelier the sightings are by the model than by accident, anywhere in
// reach.
double nats_of(const Sightings& sightings, const Model& model, const RimOptions& options) {
  constexpr double kAccident = 0.5;  // of the views that show another edge
  const double peak = 2 * options.reach_px / (options.sigma_px * std::sqrt(2 * M_PI));
  double sum = 0;
  for (const auto& s : sightings)
    if (s) {
      const double r = (s->row.dot(model.value) - s->place) / (s->footprint * options.sigma_px);
      sum += std::log((1 - kAccident) * peak * std::exp(-0.5 * r * r) + kAccident);
    }
  return sum;
}

int count(const Sightings& sightings) {
  return int(std::count_if(sightings.begin(), sightings.end(), [](const auto& s) { return !!s; }));
}

// The views as seen from a curve.
class Directions {
 public:
  Directions(const EdgeWorld& world, const Vector3d& middle, double step_deg)
      : near_(std::cos(step_deg * M_PI / 180)) {
    for (const View& v : world.views) line_.push_back((middle - v.center_in_world()).normalized());
  }
  bool near(size_t u, size_t v) const { return line_[u].dot(line_[v]) > near_; }

 private:
  double near_;
  std::vector<Vector3d> line_;
};

// Follows the views from those of the start to their neighbours; those that agree at last, none if
// they do not tell.
Sightings follow(const EdgeWorld& world, const Frames& f, const Directions& directions,
                 const Sightings& start, Sides sides, bool fixed, const RimOptions& options,
                 Model* model) {
  const size_t n = world.views.size();
  Sightings now = start;
  int before = count(now);
  for (int round = 0; round < kMostRounds; ++round) {
    if (!solve(now, fixed, model)) return Sightings(n);
    Sightings next(n);
    for (size_t v = 0; v < n; ++v) {
      bool reached = false;
      for (size_t u = 0; u < n && !reached; ++u) reached = now[u] && directions.near(u, v);
      if (reached) next[v] = sight(world, int(v), f, *model, sides, options);
    }
    now = std::move(next);
    const int found = count(now);
    if (found <= before && round > 2) break;
    before = found;
  }
  return solve(now, fixed, model) ? now : Sightings(n);
}

// Of the sightings the largest group that lies within one step of one of them.
Sightings together(const Sightings& sightings, const Directions& directions) {
  Sightings best(sightings.size());
  for (size_t u = 0; u < sightings.size(); ++u) {
    if (!sightings[u]) continue;
    Sightings group(sightings.size());
    for (size_t v = 0; v < sightings.size(); ++v)
      if (directions.near(u, v)) group[v] = sightings[v];
    if (count(group) > count(best)) best = group;
  }
  return best;
}

}  // namespace

Rim fit_rim(const EdgeWorld& world, const CurvePoints& curve, const RimOptions& options) {
  Rim rim;
  rim.sigma = INFINITY;
  const Frames frames(curve, options.samples);
  const Directions directions(world, frames.point[frames.size() / 2], options.step_deg);
  const auto begin = [&](Sides sides) {
    Sightings start(world.views.size());
    for (size_t v = 0; v < start.size(); ++v)
      start[v] = sight(world, int(v), frames, {}, sides, options);
    return start;
  };
  Model fixed;
  const Sightings as_edge =
      follow(world, frames, directions, begin(Sides::kAny), Sides::kAny, true, options, &fixed);
  const double edge_nats = nats_of(as_edge, fixed, options);
  rim.fixed_views = count(as_edge);
  rim.nats = -INFINITY;
  const auto consider = [&](const Sightings& start, Sides sides) {
    Model round;
    const Sightings seen = follow(world, frames, directions, start, sides, false, options, &round);
    const double nats = nats_of(seen, round, options) - edge_nats;
    if (nats <= rim.nats) return;
    rim.nats = nats;
    rim.views = count(seen);
    rim.axis = round.value;
    rim.radius = round.value(2), rim.sigma = std::sqrt(round.covariance(2, 2));
    rim.side.assign(start.size(), 0);
    for (size_t v = 0; v < start.size(); ++v)
      if (seen[v]) rim.side[v] = seen[v]->row(2) > 0 ? 1 : -1;
  };
  consider(begin(Sides::kByBrightness), Sides::kByBrightness);
  consider(together(begin(Sides::kFirst), directions), Sides::kAny);
  return rim;
}

bool Rim::is_round(double footprint) const {
  constexpr double kPrice = 8;        // [nat] of the radius, and of saying so
  constexpr double kMore = 1.3;       // times the views that see an edge, and
  constexpr int kMoreViews = 3;       // so many
  constexpr double kSure = 6;         // standard deviations
  constexpr double kLeastRadius = 1;  // [px]
  return nats > kPrice && views >= kMore * fixed_views + kMoreViews &&
         std::abs(radius) > kSure * sigma && std::abs(radius) > kLeastRadius * footprint;
}

void explain_rim(const EdgeWorld& world, const CurvePoints& curve, const Rim& rim,
                 const ExplainOptions& options, EdgelFlags* explained) {
  const Frames frames(curve, int(curve.position.cols()));
  parallel_for(int(world.views.size()), 1, [&](int v) {
    if (rim.side[v] == 0) return;
    CurvePoints seen = curve;
    for (int k = 0; k < frames.size(); ++k) {
      const auto [n, row] = normal_of(frames, k, world.views[v].center_in_world(), rim.side[v]);
      seen.position.col(k) += n * row.dot(rim.axis);
    }
    explain_in_view(world, v, seen, options, &(*explained)[v]);
  });
}

}  // namespace sketchsplat

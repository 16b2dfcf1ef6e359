// SPDX-License-Identifier: MIT
// Outlines beside strokes: those of a round wander over it from view to view.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "edges/views/normals_along.h"
#include "pipelines/survey/round_judge.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Sightings = std::vector<RoundSighting>;

// Beside a stroke; no wider round is told. Those of a small round lie near, and further off there
// are more of other edges, which pass for a round in few views.
constexpr double kNearPx = 12, kFarPx = 18;
constexpr double kSigmaPx = 0.12;  // standard deviation of a piece's outline in a view
constexpr double kCoarsePx = 0.3;  // strokes that are off by more tell nothing
constexpr double kOffRoundPx = 1;  // standard deviation of a stroke from its round
constexpr size_t kFewestViews = 6, kFewestFarViews = 12;
constexpr double kRoot2Pi = 2.5066283;  // square root of 2 pi
constexpr double kWeak = 1e-3;          // information on places that no view tells
constexpr double kWidest = 100;         // chamfer, over the narrowest
constexpr double kOnItPx = 0.5;         // a stroke is the outline itself, in some
constexpr int kFewestOnIt = 2;
// Share of the views in which something else lies beside it: near a round hardly anything does,
// beside an edge, or beside edges among others, something may.
constexpr double kBesideRound = 0.1, kBesideEdge = 0.15, kBesideEdges = 0.5;

constexpr int kSamples = 8;          // of a piece
constexpr double kLeastShare = 0.6;  // of them that a view must show to tell
constexpr double kMostTurn = 0.6;    // [rad] of the tangent along a piece
constexpr double kStepPx = 3;        // of the search for outlines, no more than the look-up's reach
constexpr double kAlongPx = 2;       // how far along the curve an edgel may lie
constexpr double kMostSine = 0.26;   // of the angle between its plane and the tangent

// A sample with two normals of the curve, which turn no more than it does.
struct Sample {
  Vector3d at, tangent, first, second;
};

std::vector<std::vector<Sample>> pieces_of(const CurvePoints& curve) {
  const int n = int(curve.position.cols());
  const auto normals = normals_along(curve.tangent);
  std::vector<Sample> all;
  double turn = 0;
  for (int i = 0; i < n; ++i) {
    const Vector3d t = curve.tangent.col(i);
    if (i > 0) turn += std::acos(std::clamp(t.dot(curve.tangent.col(i - 1)), -1.0, 1.0));
    all.push_back({curve.position.col(i), t, normals[i].col(0), normals[i].col(1)});
  }
  const int pieces = 1 + int(turn / kMostTurn);
  std::vector<std::vector<Sample>> out(pieces);
  for (int p = 0; p < pieces; ++p) {
    const int first = p * n / pieces, count = (p + 1) * n / pieces - first;
    const int used = std::min(count, kSamples);
    for (int k = 0; k < used; ++k) out[p].push_back(all[first + (2 * k + 1) * count / (2 * used)]);
  }
  return out;
}

// The outline edgel of a view along a place's tangent, nearest to it across; -1 if there is none.
int outline_near(const EdgeWorld& world, int view, const Sample& s, const Vector2d& place,
                 const Vector2d& along, double reach_px) {
  const EdgelMap& map = world.maps[view];
  const Vector2d normal(-along.y(), along.x());
  int best = -1;
  double nearest = reach_px;
  for (int k = 0; k <= 2 * int(reach_px / kStepPx); ++k) {  // to both sides in turn
    const Vector2d at = place + normal * (kStepPx * ((k + 1) / 2) * (k % 2 ? 1 : -1));
    const int i = map.nearest_at(at.x(), at.y());
    if (i < 0 || !map.edgels[i].outline) continue;
    const Vector2d off = Vector2d(map.edgels[i].x, map.edgels[i].y) - place;
    if (std::abs(off.dot(along)) > kAlongPx || std::abs(off.dot(normal)) >= nearest) continue;
    if (std::abs(world.plane_normal[view].col(i).cast<double>().dot(s.tangent)) > kMostSine)
      continue;
    best = i;
    nearest = std::abs(off.dot(normal));
  }
  return best;
}

std::optional<RoundSighting> outline_beside(const EdgeWorld& world, int view, const Sample& s,
                                            double reach_px) {
  const View& v = world.views[view];
  const Vector3d q = v.cam_from_world * s.at;
  if (!(q.z() > 0)) return std::nullopt;
  const Vector2d place = v.camera.project(q);
  const Eigen::Matrix<double, 2, 3> J = v.camera.project_jacobian(q) * v.cam_from_world.rotation;
  const Vector2d along = (J * s.tangent).normalized();
  if (!along.allFinite() || !(place.cwiseAbs().maxCoeff() < 1e6)) return std::nullopt;
  const int i = outline_near(world, view, s, place, along, reach_px);
  if (i < 0) return std::nullopt;
  const Edgel& e = world.maps[view].edgels[i];
  const Vector2d n(e.nx, e.ny);
  const Vector3d across = (s.at - v.center_in_world()).cross(s.tangent).normalized();
  const double slope = n.dot(J * across), scale = std::abs(slope) * world.footprint;
  const int brighter = slope > 0 ? 1 : -1;
  RoundSighting out;
  out.place_px = brighter * n.dot(Vector2d(e.x, e.y) - place);
  out.row << scale * across.dot(s.first), scale * across.dot(s.second), -brighter * scale;
  return out;
}

// At most so many, evenly.
Sightings thinned(const Sightings& seen, size_t most) {
  Sightings out;
  const size_t used = std::min(most, seen.size());
  for (size_t k = 0; k < used; ++k) out.push_back(seen[(2 * k + 1) * seen.size() / (2 * used)]);
  return out;
}

// [nat] Places 0 and those of another edge, aside by `other` [px].
double nats_of_two(const Sightings& seen, const Vector2d& other, double sigma, double accident,
                   double peak) {
  double sum = 0;
  for (const RoundSighting& v : seen) {
    const double a = v.place_px / sigma, b = (v.place_px - v.row.head<2>().dot(other)) / sigma;
    sum += std::log(accident + (1 - accident) * peak * 0.5 *
                                   (std::exp(-0.5 * a * a) + std::exp(-0.5 * b * b)));
  }
  return sum;
}

// Two convex edges of one part, places [px] relative to the stroke: the outline is the outer one's.
struct TwoEdges {
  Vector2d first, second;
};

// 0 or 1: the outer edge as a view has it, with its place.
std::pair<int, double> outer_edge(const RoundSighting& v, const TwoEdges& edges) {
  const double a = v.row.head<2>().dot(edges.first), b = v.row.head<2>().dot(edges.second);
  return (v.row.z() > 0) == (b > a) ? std::pair(1, b) : std::pair(0, a);
}

// [nat]
double nats_of_outer(const Sightings& seen, const TwoEdges& edges, double sigma, double accident,
                     double peak) {
  double sum = 0;
  for (const RoundSighting& v : seen) {
    const double r = (v.place_px - outer_edge(v, edges).second) / sigma;
    sum += std::log(accident + (1 - accident) * peak * std::exp(-0.5 * r * r));
  }
  return sum;
}

// The other edge [px], relative to the first one, by pairs of places that are not the first one's.
std::optional<Vector2d> likeliest_other(const Sightings& seen, const Sightings& all_far,
                                        double sigma, double reach, double peak) {
  constexpr size_t kMostInPairs = 28;
  constexpr double kLeastDeterminant = 0.05, kAccident = 0.3, kFarthest = 3;
  const Sightings far = thinned(all_far, kMostInPairs);
  std::optional<Vector2d> best;
  double most = -INFINITY;
  for (size_t i = 0; i < far.size(); ++i)
    for (size_t j = i + 1; j < far.size(); ++j) {
      Matrix2d A;
      A << far[i].row.head<2>().transpose(), far[j].row.head<2>().transpose();
      if (std::abs(A.determinant()) < kLeastDeterminant) continue;
      const Vector2d other = A.inverse() * Vector2d(far[i].place_px, far[j].place_px);
      if (other.norm() > kFarthest * reach) continue;
      const double nats =
          std::max(nats_of_two(seen, other, sigma, kAccident, peak),
                   nats_of_outer(seen, {Vector2d::Zero(), other}, sigma, kAccident, peak));
      if (nats > most) most = nats, best = other;
    }
  return best;
}

// Two edges that are the outer one for views from one side each: `share` of them see the first.
TwoEdges split_edges(const Sightings& seen, double share) {
  Vector2d mean = Vector2d::Zero();
  for (const RoundSighting& v : seen) mean += std::copysign(1.0, v.row.z()) * v.row.head<2>();
  const auto turn = [&](const RoundSighting& v) {
    const Vector2d u = std::copysign(1.0, v.row.z()) * v.row.head<2>();
    return std::atan2(mean.x() * u.y() - mean.y() * u.x(), mean.dot(u));
  };
  Sightings sorted = seen;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const auto& a, const auto& b) { return turn(a) < turn(b); });
  const auto meet = [&](size_t begin, size_t end) -> Vector2d {
    Matrix2d H = kWeak * Matrix2d::Identity();
    Vector2d g = Vector2d::Zero();
    for (size_t i = begin; i < end; ++i) {
      const Vector2d row = sorted[i].row.head<2>();
      H += row * row.transpose(), g += row * sorted[i].place_px;
    }
    return solve_symmetric(H, g);
  };
  const size_t split = size_t(share * double(sorted.size()));
  return {meet(0, split), meet(split, sorted.size())};
}

// [nat] Two edges between which the stroke runs, or near: those of a chamfer. Over all their
// places; widths are as likely by their logarithm.
double places_of_chamfer(const Sightings& seen, TwoEdges edges, double sigma, double reach) {
  constexpr int kFits = 8;
  const double peak = 2 * reach / (sigma * kRoot2Pi);
  Eigen::Matrix4d H;  // times the variance
  for (int k = 0; k < kFits; ++k) {
    H = kWeak * Eigen::Matrix4d::Identity();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    const double s = k < kFits / 2 ? 3 * sigma : sigma;
    for (const RoundSighting& v : seen) {
      const auto [which, at] = outer_edge(v, edges);
      const double r = (v.place_px - at) / s, w = std::exp(-0.5 * r * r);
      const Vector2d row = v.row.head<2>();
      H.block<2, 2>(2 * which, 2 * which) += w * row * row.transpose();
      g.segment<2>(2 * which) += w * row * v.place_px;
    }
    const Eigen::Vector4d x = solve_symmetric(H, g);
    if (!x.allFinite()) return -INFINITY;
    edges = {x.head<2>(), x.tail<2>()};
  }
  const double width = std::max(sigma, (edges.second - edges.first).norm());
  const double off = 0.5 * (edges.first + edges.second).norm() / kOffRoundPx;
  const double prior = -0.5 * off * off - std::log(2 * M_PI * kOffRoundPx * kOffRoundPx) -
                       std::log(2 * M_PI * width * width * std::log(kWidest));
  return nats_of_outer(seen, edges, sigma, kBesideEdge, peak) + prior +
         4 * std::log(kRoot2Pi * sigma) - 0.5 * std::log(H.determinant());
}

// [nat] An edge with another one along it, at some place of its own: over places anywhere.
double places_of_two(const Sightings& seen, double sigma, double reach) {
  constexpr double kOff = 1.5;  // standard deviations: other edges may lie near
  constexpr int kFits = 3;
  const double peak = 2 * reach / (sigma * kRoot2Pi);
  Sightings far;
  for (const RoundSighting& v : seen)
    if (std::abs(v.place_px) > kOff * sigma) far.push_back(v);
  std::optional<Vector2d> other = likeliest_other(seen, far, sigma, reach, peak);
  if (!other) return -INFINITY;
  Matrix2d H;
  for (int k = 0; k < kFits; ++k) {
    H = kWeak * Matrix2d::Identity();
    Vector2d g = Vector2d::Zero();
    for (const RoundSighting& v : far) {
      const Vector2d row = v.row.head<2>();
      const double r = (v.place_px - row.dot(*other)) / sigma, w = std::exp(-0.5 * r * r);
      H += w * row * row.transpose(), g += w * row * v.place_px;
    }
    other = solve_symmetric(H, g);
  }
  // Of the places where it may be, those that agree with the views are a part (Laplace).
  const double occam = 2 * std::log(reach / sigma) + 0.5 * std::log(H.determinant());
  return std::max({nats_of_two(seen, *other, sigma, kBesideEdge, peak),
                   nats_of_two(seen, *other, sigma, kBesideEdges, peak),
                   nats_of_outer(seen, {Vector2d::Zero(), *other}, sigma, kBesideEdge, peak)}) -
         occam;
}

}  // namespace

Outlines outlines_beside(const EdgeWorld& world, const CurvePoints& curve, double reach_px) {
  Outlines out;
  const std::vector<std::vector<Sample>> pieces = pieces_of(curve);
  out.pieces = int(pieces.size());
  for (const std::vector<Sample>& piece : pieces)
    for (size_t v = 0; v < world.views.size(); ++v) {
      std::vector<float> places;
      RoundSighting sighting;
      for (const Sample& s : piece)
        if (const auto seen = outline_beside(world, int(v), s, reach_px)) {
          places.push_back(float(seen->place_px));
          sighting.row += seen->row;
        }
      if (places.size() < std::max<double>(2, kLeastShare * double(piece.size()))) continue;
      sighting.view = int(v);
      sighting.outline = true;
      sighting.row /= double(places.size());
      sighting.place_px = median(std::move(places));
      out.seen.push_back(sighting);
    }
  return out;
}

// Rounds that triples of outlines touch, those that the most others touch, too.
std::vector<RoundJudge::RimFit> RoundJudge::rims_through(const Sightings& seen,
                                                         double reach_px) const {
  constexpr size_t kMostInTriples = 14, kKept = 3;
  constexpr double kLeastDeterminant = 0.01;
  constexpr int kFits = 4;
  const Places wide{3 * kSigmaPx, reach_px, kBesideRound};
  std::vector<std::pair<double, Vector3d>> found;
  const auto fits = [&](const Vector3d& x) {
    return x.z() >= model_.least_radius_px && x.z() <= reach_px;
  };
  const Sightings some = thinned(seen, kMostInTriples);
  for (size_t i = 0; i < some.size(); ++i)
    for (size_t j = i + 1; j < some.size(); ++j)
      for (size_t k = j + 1; k < some.size(); ++k) {
        Matrix3d A;
        A << some[i].row.transpose(), some[j].row.transpose(), some[k].row.transpose();
        if (std::abs(A.determinant()) < kLeastDeterminant) continue;
        const Vector3d x =
            A.inverse() * Vector3d(some[i].place_px, some[j].place_px, some[k].place_px);
        if (!fits(x)) continue;
        double sum = 0;
        for (const RoundSighting& v : seen) sum += std::log(wide.near(v.place_px - v.row.dot(x)));
        found.emplace_back(-sum, x);
      }
  const size_t kept = std::min(kKept, found.size());
  std::partial_sort(found.begin(), found.begin() + long(kept), found.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<RimFit> out;
  for (size_t f = 0; f < kept; ++f) {
    RimFit fit{found[f].second, Matrix3d::Zero()};
    for (int round = 0; round < kFits; ++round) {
      const double sigma = round < kFits / 2 ? 3 * kSigmaPx : kSigmaPx;
      Matrix3d H = 1e-4 * Matrix3d::Identity();
      Vector3d g = Vector3d::Zero();
      for (const RoundSighting& v : seen) {
        const double r = (v.place_px - v.row.dot(fit.x)) / sigma, w = std::exp(-0.5 * r * r);
        H += w * v.row * v.row.transpose(), g += w * v.row * v.place_px;
      }
      fit = {solve_symmetric(H, g), H / (sigma * sigma)};
    }
    if (fit.x.allFinite() && fits(fit.x)) out.push_back(fit);
  }
  return out;
}

// Minus infinity if too few outlines tell.
double RoundJudge::nats_of_outlines(int stroke) const {
  if (sigma_ > kCoarsePx) return -INFINITY;
  const int first = wide_.layout.first[stroke], n = wide_.layout.first[stroke + 1] - first;
  const CurvePoints curve = {wide_.samples.position.middleCols(first, n),
                             wide_.samples.tangent.middleCols(first, n),
                             {0, n}};
  return std::max(nats_of_outlines(curve, kNearPx), nats_of_outlines(curve, kFarPx));
}

double RoundJudge::nats_of_outlines(const CurvePoints& curve, double reach_px) const {
  const Outlines outlines = outlines_beside(world_, curve, reach_px);
  const Sightings& seen = outlines.seen;
  std::set<int> views;
  for (const RoundSighting& v : seen) views.insert(v.view);
  const auto on_it = std::count_if(seen.begin(), seen.end(), [](const RoundSighting& v) {
    return std::abs(v.place_px) < kOnItPx;
  });
  const size_t fewest = reach_px > kNearPx ? kFewestFarViews : kFewestViews;
  if (views.size() < fewest || on_it < kFewestOnIt) return -INFINITY;
  double rim = -INFINITY;
  for (const RimFit& fit : rims_through(seen, reach_px)) {
    const double off = (fit.x.head<2>().norm() - fit.x.z()) / kOffRoundPx;
    rim =
        std::max(rim, nats_of_rim(seen, fit, {kSigmaPx, reach_px, kBesideRound}) - 0.5 * off * off);
  }
  const double edge = std::max(places_of_edge(seen, {kSigmaPx, reach_px, kBesideEdge}),
                               places_of_edge(seen, {kSigmaPx, reach_px, kBesideEdges}));
  double two = -INFINITY;
  if (rim > edge) {
    two = places_of_two(seen, kSigmaPx, reach_px);
    for (const double share : {0.3, 0.5, 0.7})
      two = std::max(two, places_of_chamfer(seen, split_edges(seen, share), kSigmaPx, reach_px));
  }
  return model_.witnesses * (rim - std::max(edge, two)) / outlines.pieces;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/survey/round_judge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/views/normals_along.h"
#include "pipelines/survey/prior_odds.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Sightings = std::vector<RoundSighting>;

constexpr double kLeastShare = 0.3;  // of a stroke's samples that a view must show to tell
constexpr double kReachPx = 1.5;     // how far beside a stroke a round may show
constexpr int kFewestSamples = 3;
constexpr int kManyViews = 6;                     // of the strokes that tell how edges show
constexpr int kFits = 8;                          // rounds of expectation and maximization
constexpr double kLow = 0.1, kLowNormal = 0.126;  // quantile of |x|, x normal
constexpr double kTight = 0.5;      // of the least radius of a round: rounds that are edges
constexpr double kScatter = 0.11;   // of places about the best edge, over a round's radius
constexpr double kSpread = 0.2;     // half of what a round moves by, over its radius
constexpr double kSharpest = 0.75;  // quantile of strokes by how often they show as wide as most
constexpr double kWidestRim = 100;  // over the least radius
constexpr double kSame = 2;         // standard deviations of what is as wide as most
constexpr double kWide = 4;         // the same of what is a little wider
constexpr double kRoot2Pi = 2.5066283;  // square root of 2 pi

// What the matches of a stroke in one view add up to.
struct Gathered {
  std::vector<float> place, log_width;
  Vector3d row = Vector3d::Zero();
  int outline = 0;
};

// Where values are densest: the middle of the shortest half, of that, and so on.
double half_sample_mode(std::vector<float> x) {
  std::sort(x.begin(), x.end());
  size_t first = 0, n = x.size();
  while (n > 3) {
    const size_t half = (n + 1) / 2;
    size_t best = first;
    for (size_t i = first; i + half <= first + n; ++i)
      if (x[i + half - 1] - x[i] < x[best + half - 1] - x[best]) best = i;
    first = best, n = half;
  }
  double sum = 0;
  for (size_t i = first; i < first + n; ++i) sum += x[i];
  return sum / n;
}

double log_mean_exp(const std::vector<double>& x) {
  const double most = *std::max_element(x.begin(), x.end());
  if (most == -INFINITY) return most;
  double mean = 0;
  for (const double v : x) mean += std::exp(v - most) / x.size();
  return most + std::log(mean);
}

constexpr int kSameClass = 1;
int width_class(double sigmas) {
  return sigmas < -kSame ? 0 : sigmas <= kSame ? kSameClass : sigmas <= kWide ? 2 : 3;
}

double total(const WidthRates& rates) { return std::accumulate(rates.begin(), rates.end(), 0.0); }

double share_of_same(const WidthRates& rates) { return rates[kSameClass] / total(rates); }

// The others keep their ratios, and all together their sum.
WidthRates with_share_of_same(WidthRates rates, double same) {
  const double sum = total(rates), others = (1 - same) / (1 - share_of_same(rates));
  for (double& rate : rates) rate *= others;
  rates[kSameClass] = same * sum;
  return rates;
}

// Is a stroke near outlines?
bool touches_outlines(const Sightings& seen) {
  return std::any_of(seen.begin(), seen.end(), [](const RoundSighting& v) { return v.outline; });
}

// [nat] Dirichlet-multinomial distribution, but for what depends on the views alone.
double log_likelihood(const WidthRates& rates, const std::array<int, 4>& views) {
  const auto rising = [](double a, double n) { return std::lgamma(a + n) - std::lgamma(a); };
  double sum = -rising(total(rates), std::accumulate(views.begin(), views.end(), 0));
  for (size_t k = 0; k < views.size(); ++k) sum += rising(rates[k], views[k]);
  return sum;
}

}  // namespace

Sightings round_sightings(const EdgeWorld& world, const Observation& o, int stroke,
                          const EdgelFlags* others) {
  const int first = o.layout.first[stroke], n = o.layout.first[stroke + 1] - first;
  const auto normals = normals_along(o.samples.tangent.middleCols(first, n));
  std::vector<Gathered> views(world.views.size());
  for (int i = first; i < first + n; ++i)
    for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m) {
      const SampleMatch& match = o.matches.matches[m];
      if (others && (*others)[match.view][match.edgel]) continue;
      const Edgel& e = world.maps[match.view].edgels[match.edgel];
      const Vector3d x = o.samples.position.col(i), t = o.samples.tangent.col(i);
      const Vector3d across = (x - world.views[match.view].center_in_world()).cross(t).normalized();
      const double slope = distance_gradient(world, match, x).dot(across);
      const int brighter = slope > 0 ? 1 : -1;
      const double scale = std::abs(slope) * world.footprint;
      Gathered& g = views[match.view];
      g.place.push_back(float(-brighter * match.distance_px));
      g.log_width.push_back(std::log(std::max(1e-3f, e.width)));
      g.row.head<2>() += scale * (normals[i - first].transpose() * across);
      g.row.z() -= brighter * scale;
      g.outline += e.outline;
    }
  Sightings out;
  for (size_t v = 0; v < views.size(); ++v) {
    Gathered& g = views[v];
    const int k = int(g.place.size());
    if (k < std::max<double>(kFewestSamples, kLeastShare * n)) continue;
    out.push_back({int(v), median(std::move(g.place)), median(std::move(g.log_width)),
                   2 * g.outline > k, g.row / k});
  }
  return out;
}

Observation observe_rounds(const Sketch& sketch, const EdgeWorld& world, double least_reach_px) {
  MatchOptions match;
  match.exclusive = match.quadratics = false;
  match.min_run = 0;
  match.reach_px = std::max(kReachPx, least_reach_px);
  return observe(sketch, world, match, 2.0);
}

RoundJudge::RoundJudge(const EdgeWorld& world, const Observation& wide, const RoundModel& model)
    : world_(world), wide_(wide), model_(model), reach_(wide.reach_px) {
  if (model.least_radius > 0) model_.least_radius_px = model.least_radius / world.footprint;
  sigma_ = model.least_sigma_px;
  std::vector<Sightings> strokes(wide.layout.first.size() - 1);
  parallel_for(int(strokes.size()), 1, [&](int s) {
    strokes[s] = round_sightings(world, wide, s, nullptr);
    if (int(strokes[s].size()) < kManyViews) strokes[s].clear();
  });
  std::vector<float> off;
  for (const Sightings& seen : strokes)
    for (const RoundSighting& v : seen) off.push_back(float(std::abs(v.place_px)));
  // Sharp edges lie still: a low quantile tells of them alone.
  if (!off.empty()) sigma_ = std::max<double>(sigma_, quantile(off, kLow) / kLowNormal);
  learn_widths(strokes);
  outlines_.assign(strokes.size(), -INFINITY);
  parallel_for(int(strokes.size()), 1, [&](int s) {
    if (touches_outlines(strokes[s])) outlines_[s] = nats_of_outlines(s);
  });
}

// Most of what a view shows is as wide as its blur makes it, outlines of rounds, too.
void RoundJudge::learn_widths(const std::vector<Sightings>& strokes) {
  std::vector<float> every;
  std::vector<std::vector<float>> by_view(world_.views.size());
  for (const Sightings& seen : strokes)
    for (const RoundSighting& v : seen) {
      every.push_back(float(v.log_width));
      by_view[v.view].push_back(float(v.log_width));
    }
  if (every.empty()) return;
  log_width_.assign(by_view.size(), half_sample_mode(every));
  for (size_t v = 0; v < by_view.size(); ++v)
    if (int(by_view[v].size()) >= kManyViews) log_width_[v] = half_sample_mode(by_view[v]);
  std::vector<float> off;
  for (const Sightings& seen : strokes)
    for (const RoundSighting& v : seen)
      off.push_back(float(std::abs(v.log_width - log_width_[v.view])));
  width_sigma_ =
      std::max<double>(model_.least_width_sigma, quantile(off, 2 * kLow) / (2 * kLowNormal));
  learn_rate(strokes);
}

// In photographs edges are less often as wide as most than in renders: the sharpest strokes tell,
// unless all of them may be rounds.
void RoundJudge::learn_rate(const std::vector<Sightings>& strokes) {
  std::vector<float> shares;
  for (const Sightings& seen : strokes) {
    int inner = 0, sharp = 0;
    for (const RoundSighting& v : seen) {
      inner += !v.outline;
      sharp += !v.outline && std::abs(v.log_width - log_width_[v.view]) < kSame * width_sigma_;
    }
    if (inner >= kManyViews) shares.push_back(float(sharp) / float(inner));
  }
  if (shares.empty()) return;
  const double stated = share_of_same(model_.edge_widths);
  const double rate =
      std::clamp<double>(quantile(shares, kSharpest), share_of_same(model_.round_widths), stated);
  for (WidthRates* widths : {&model_.edge_widths, &model_.round_widths})
    *widths = with_share_of_same(*widths, share_of_same(*widths) * rate / stated);
}

// Likelihood of a place that should be 0, over that of one anywhere in reach.
double RoundJudge::Places::near(double off_px) const {
  const double r = off_px / sigma_px, peak = 2 * reach_px / (sigma_px * kRoot2Pi);
  return accident + (1 - accident) * peak * std::exp(-0.5 * r * r);
}

// Where the stroke is, or a little beside it, as all views together have it; or where a round shows
// that is too small to be one.
double RoundJudge::places_of_edge(const Sightings& seen, const Places& places) const {
  const double slack = model_.slack_px, still = places.sigma_px;
  const auto nats_at = [&](const Vector2d& shift, double sigma) {
    const Places at{sigma, places.reach_px, places.accident};
    double sum = -0.5 * shift.squaredNorm() / (slack * slack);
    for (const RoundSighting& v : seen)
      sum += std::log(at.near(v.place_px - v.row.head<2>().dot(shift)));
    return sum;
  };
  Vector2d shift = Vector2d::Zero();
  Eigen::Matrix2d H;  // times the variance
  for (int k = 0; k < kFits; ++k) {
    // Wide at first: the stroke may lie beside all of them.
    const double sigma = k < kFits / 2 ? 3 * still : still;
    H = Eigen::Matrix2d::Identity() * std::pow(still / slack, 2);
    Vector2d g = Vector2d::Zero();
    for (const RoundSighting& v : seen) {
      const Vector2d row = v.row.head<2>();
      const double r = (v.place_px - row.dot(shift)) / sigma, w = std::exp(-0.5 * r * r);
      H += w * row * row.transpose(), g += w * row * v.place_px;
    }
    shift = solve_symmetric(H, g);
    if (!shift.allFinite()) return nats_at(Vector2d::Zero(), still);
  }
  // Of the places where it may be, those that agree with the views are a part (Laplace).
  const double occam = 2 * std::log(slack / still) + 0.5 * std::log(H.determinant());
  const double tight = std::hypot(still, kScatter * kTight * model_.least_radius_px);
  std::vector<double> sums;
  for (const double sigma : {still, tight})
    sums.push_back(std::max(nats_at(Vector2d::Zero(), sigma), nats_at(shift, sigma) - occam));
  return log_mean_exp(sums);
}

// Anywhere within a round, of unknown radius.
double RoundJudge::places_of_band(const Sightings& seen) const {
  std::vector<double> sums;
  for (double half = kSpread * model_.least_radius_px; sums.size() < 5 && half <= reach_;
       half *= 1.4) {
    double sum = 0;
    for (const RoundSighting& v : seen)
      sum += std::log(model_.accident +
                      (1 - model_.accident) * (std::abs(v.place_px) < half ? reach_ / half : 0));
    sums.push_back(sum);
  }
  return sums.empty() ? -INFINITY : log_mean_exp(sums);
}

double RoundJudge::places_of_rim(const Sightings& seen) const {
  double best = -INFINITY;
  for (const double times : {1.0, 3.0, 9.0, -1.0, -3.0, -9.0}) {
    if (world_.has_masks() && times < 0) break;  // the object is the brighter side of its outline
    const RimFit rim = fit_rim(seen, times * model_.least_radius_px);
    if ((times > 0 ? 1 : -1) * rim.x.z() >= model_.least_radius_px)
      best = std::max(best, nats_of_rim(seen, rim, places()));
  }
  return best;
}

// Radii are as likely by their logarithm; the stroke is on the round, all around alike. Of all
// that, what agrees with the views is a part (Laplace), which is no larger than the round.
double RoundJudge::nats_of_rim(const Sightings& seen, const RimFit& rim,
                               const Places& places) const {
  const double widest = std::log(kWidestRim), slack = kRoot2Pi * model_.slack_px;
  const double radius = std::abs(rim.x.z());
  const Matrix3d precision = rim.precision + Matrix3d::Identity() / (radius * radius);
  double sum = -std::log(widest * radius) - std::log(2 * M_PI * radius * slack) +
               3 * std::log(kRoot2Pi) - 0.5 * std::log(precision.determinant());
  const bool outlines = !world_.hull.empty();
  for (const RoundSighting& v : seen)
    if (!outlines || v.outline) sum += std::log(places.near(v.place_px - v.row.dot(rim.x)));
  return sum;
}

std::array<int, 4> RoundJudge::by_width(const Sightings& seen) const {
  std::array<int, 4> counts = {};
  if (!(width_sigma_ > 0)) return counts;
  for (const RoundSighting& v : seen)
    if (!v.outline) ++counts[width_class((v.log_width - log_width_[v.view]) / width_sigma_)];
  return counts;
}

std::array<int, 4> RoundJudge::views_by_width(int stroke, const EdgelFlags* others) const {
  return by_width(round_sightings(world_, wide_, stroke, others));
}

double RoundJudge::widths_of_round(const Sightings& seen) const {
  // Outlines are sharp whatever they are of, and without masks nobody knows them.
  constexpr double kOutlines = 0.5;
  WidthRates round = model_.round_widths;
  if (world_.hull.empty())
    round = with_share_of_same(round, kOutlines + (1 - kOutlines) * share_of_same(round));
  const std::array<int, 4> views = by_width(seen);
  return log_likelihood(round, views) - log_likelihood(model_.edge_widths, views);
}

double RoundJudge::nats(int stroke, const EdgelFlags* others) const {
  const Sightings seen = round_sightings(world_, wide_, stroke, others);
  if (seen.empty()) return 0;
  const double rounds = log_mean_exp({places_of_band(seen), places_of_rim(seen)});
  if (rounds == -INFINITY) return rounds;  // no round shows so near
  const double near = model_.witnesses * (rounds - places_of_edge(seen, places()));
  return std::max(near, outlines_[stroke]) + widths_of_round(seen);
}

std::vector<double> round_nats(const Sketch& sketch, const EdgeWorld& world,
                               const RoundModel& model) {
  const Observation wide = observe_rounds(sketch, world, 0);
  const RoundJudge judge(world, wide, model);
  std::vector<double> nats;
  for (int s = 0; s < sketch.size(); ++s) nats.push_back(judge.nats(s, nullptr));
  return nats;
}

double odds_of_round(const std::vector<double>& nats) {
  constexpr double kRounds = 0.5, kEdges = 1;  // known beforehand
  // Edges that err look like rounds, all of them at once: they do not make one another rounds.
  return std::min(most_probable_odds(nats, kRounds, kEdges), kRounds / kEdges);
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "eval/inspect/inspection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

constexpr double kReachTolerances = 3;  // what is farther than so many tolerances may be elsewhere
constexpr double kFewNear = 0.5;  // share of the measured length below which the fit is doubtful
constexpr double kClose = 1.5;    // cost of another pose over that of the best: nearly as good
constexpr double kDegree = M_PI / 180;

std::string per_cent(double share) { return std::to_string(int(std::lround(100 * share))) + " %"; }

std::string ratio_text(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", ratio);
  return text;
}

void warn_of_pose(const Nominal& nominal, const Sketch& measured, const InspectOptions& options,
                  Inspection* out) {
  const Alignment& a = out->alignment;
  std::vector<std::string>& w = out->warnings;
  if (options.align.fit_scale)
    w.push_back("the result has no scale: it was fitted, so shapes are judged and sizes are not");
  if (a.share < kFewNear) {
    const double ratio = largest_extent(measured) / nominal.extent;
    w.push_back("only " + per_cent(a.share) + " of the measured length lies near nominal edges" +
                (ratio < 0.5 || ratio > 2 ? "; the result is " + ratio_text(ratio) +
                                                " times as large as the nominal part: scale, unit?"
                                          : ""));
  }
  if (options.align.scale_sigma > 0)
    w.push_back("the cameras leave the scale open by " +
                ratio_text(100 * options.align.scale_sigma) +
                " %: a part that is larger or smaller as a whole looks the same");
  if (options.align.to == AlignTo::kAsGiven) return;
  if (a.free_directions > 0)
    w.push_back("the edges leave " + std::to_string(a.free_directions) +
                " direction(s) of the pose free (a turned part may spin): left as the files stand");
  else if (a.equal_poses > 1)
    w.push_back("the nominal part is symmetric: " + std::to_string(a.equal_poses) +
                " poses fit equally, the one with the least turn was taken");
  if (a.runner_up < kClose)
    w.push_back("another pose fits nearly as well (" + ratio_text(a.runner_up) +
                " times the cost): the part is nearly symmetric");
}

void warn_of_sigma(const Sketch& measured, double footprint, std::vector<std::string>* warnings) {
  const auto unknown = std::count_if(measured.evidence.begin(), measured.evidence.end(),
                                     [](const Evidence& e) { return !(e.sigma > 0); });
  if (unknown > 0)
    warnings->push_back(std::to_string(unknown) + " of " + std::to_string(measured.size()) +
                        " measured curves have no sigma: taken as exact");
  if (!(footprint > 0) && unknown < measured.size())
    warnings->push_back("nobody knows how long a pixel is at the part: sigmas are of edgels alone");
}

double edge_tolerance(const Nominal& nominal, const InspectOptions& o) {
  if (o.tolerance > 0) return o.tolerance;
  return iso2768_linear(o.iso, nominal.extent * o.unit_mm) / o.unit_mm;
}

double dimension_tolerance(const Dimension& d, double edges, const InspectOptions& o) {
  const bool angle = is_angle(d.kind);
  if (o.iso == Iso2768::kNone) return angle ? std::atan2(edges, d.leg) / kDegree : edges;
  return angle ? iso2768_angle(o.iso, d.leg * o.unit_mm)
               : iso2768_linear(o.iso, d.nominal * o.unit_mm) / o.unit_mm;
}

// In tolerances.
NumberError error_of(const DimensionCheck& c, double tolerance) {
  const double fitted = std::sqrt(std::max(0.0, c.systematic * c.systematic - c.stated * c.stated));
  return {std::hypot(c.sigma, fitted) / tolerance, c.shares, c.stated / tolerance};
}

// With the prior that all dimensions of the part say together, in units of their tolerances.
std::vector<DimensionResult> judge(const std::vector<DimensionCheck>& checks, double tolerance,
                                   const InspectOptions& o, DeviationPrior* prior) {
  std::vector<DimensionResult> out;
  std::vector<std::vector<double>> evidence;
  const DeviationPrior vague = vague_prior(1);
  for (const DimensionCheck& c : checks) {
    DimensionResult d;
    d.check = c;
    d.tolerance = dimension_tolerance(c.dimension, tolerance, o);
    out.push_back(d);
    if (!c.measured) continue;
    std::vector<double> logs;
    for (const double scale : vague.scales)
      logs.push_back(number_log_evidence((c.value - c.dimension.nominal) / d.tolerance,
                                         error_of(c, d.tolerance), scale));
    evidence.push_back(logs);
  }
  *prior = o.learn_prior ? learn_prior(vague, evidence) : vague;
  for (DimensionResult& d : out) {
    const DimensionCheck& c = d.check;
    if (!c.measured) continue;
    d.probability = number_probability((c.value - c.dimension.nominal) / d.tolerance,
                                       error_of(c, d.tolerance), 1, *prior);
    if (is_angle(c.dimension.kind) || !o.align.fit_scale) d.verdict = verdict_of(d.probability);
  }
  return out;
}

Judgement worst(Judgement a, Judgement b) {
  const auto rank = [](Judgement v) {
    return v == Judgement::kOut ? 2 : v == Judgement::kUndecided ? 1 : 0;
  };
  return rank(b) > rank(a) ? b : a;
}

// Blurred edges lie nearer to their centres of curvature: by how much, as a rule, is known.
void take_off_pull(const SigmaModel& sigma, Inspection* out) {
  out->pull_px2 = sigma.options.curvature_px2;
  for (EdgeMatch& edge : out->association.edges)
    for (EdgePlace& p : edge.places) {
      if (p.stroke < 0) continue;
      const Eigen::Vector3d pull =
          sigma.options.curvature_px2 * bend_at(out->measured, p.stroke, p.t, sigma.footprint);
      p.measured -= pull;
      p.deviation -= pull - p.tangent * p.tangent.dot(pull);
    }
}

void check_edges(const Nominal& nominal, double tolerance, bool learn, const SigmaModel& sigma,
                 Inspection* out) {
  const int n = int(nominal.edges.size());
  std::vector<MeasuredEdge> measured(n);
  parallel_for(n, 1, [&](int e) {
    measured[e] = measure_edge(out->association.edges[e], nominal.edges[e], out->measured,
                               out->alignment.holds[e], tolerance, sigma);
  });
  out->prior = prior_of(measured, tolerance, learn);
  out->edges.resize(n);
  parallel_for(n, 1, [&](int e) { out->edges[e] = judge_edge(measured[e], out->prior); });
}

}  // namespace

Inspection inspect(const Nominal& nominal, const Sketch& measured, double footprint,
                   const InspectOptions& given, const Visibility& visibility) {
  InspectOptions options = given;
  const double tolerance = edge_tolerance(nominal, options);
  options.associate.reach =
      std::max(options.associate.reach, kReachTolerances * tolerance / nominal.extent);
  options.align.reach = options.associate.reach;
  Inspection out;
  out.alignment = align(measured, nominal, options.align);
  out.measured = moved(measured, out.alignment.pose);
  std::vector<std::vector<int>> seen_by;
  if (visibility)
    seen_by = visibility(out.alignment.pose, nominal_places(nominal, options.associate.spacing));
  out.association = associate(out.measured, nominal, options.associate, seen_by);
  const bool moves = options.align.to == AlignTo::kBestFit;
  if (!moves) out.alignment.holds.assign(nominal.edges.size(), true);
  const SigmaModel sigma{options.sigma, footprint * out.alignment.pose.scale,
                         typical_bias_px(measured), &out.alignment, true};
  take_off_pull(sigma, &out);
  check_edges(nominal, tolerance, options.learn_prior, sigma, &out);
  out.dimensions = judge(measure_dimensions(find_dimensions(nominal, out.association), nominal,
                                            out.association, out.measured, sigma),
                         tolerance, options, &out.dimension_prior);
  warn_of_pose(nominal, measured, options, &out);
  warn_of_sigma(measured, footprint, &out.warnings);
  for (const EdgeCheck& e : out.edges) out.verdict = worst(out.verdict, e.verdict);
  for (const DimensionResult& d : out.dimensions) out.verdict = worst(out.verdict, d.verdict);
  return out;
}

JudgementCounts count_verdicts(const Inspection& inspection, Judgement verdict) {
  JudgementCounts n;
  for (const EdgeCheck& e : inspection.edges) n.edges += e.verdict == verdict;
  for (const DimensionResult& d : inspection.dimensions) n.dimensions += d.verdict == verdict;
  return n;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "eval/inspect/inspection_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "eval/inspect/csv_row.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/curve/curve_jacobian.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

Json number(double x) { return std::isfinite(x) ? Json(nine_digits(x)) : Json(); }

Json vector_json(const Eigen::Vector3d& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

Json alignment_json(const Alignment& a, const InspectOptions& o) {
  Json rotation = Json::array();
  for (int k = 0; k < 3; ++k) rotation.push_back(vector_json(a.pose.rotation.row(k)));
  Eigen::Matrix<double, 6, 1> sigma = a.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  Json out;
  out["to"] = o.align.to == AlignTo::kAsGiven ? "as given"
              : o.align.datums.empty()        ? "best fit"
                                              : "datums";
  out["datums"] = o.align.datums;
  out["scale"] = number(a.pose.scale);
  out["scale_fitted"] = o.align.fit_scale;
  out["rotation"] = rotation;
  out["translation"] = vector_json(a.pose.translation);
  out["sigma_turn_deg"] = vector_json(sigma.head<3>() * 180 / M_PI);
  out["sigma_shift"] = vector_json(sigma.tail<3>());
  out["rms"] = number(a.rms);
  out["share_near"] = number(a.share);
  out["equal_poses"] = a.equal_poses;
  out["free_directions"] = a.free_directions;
  out["runner_up"] = number(a.runner_up);
  return out;
}

Json sigma_json(SigmaOptions options) {
  Json out;
  for (const auto& [name, value] : named_numbers(&options)) out[name] = *value;
  out["scale_percent"] = options.scale_percent;
  return out;
}

Json quantiles_of(const std::vector<double>& ascending) {
  Json out = Json::array();
  if (ascending.empty()) return out;
  for (const double share : quantile_shares())
    out.push_back(number(ascending[size_t(std::lround(share * double(ascending.size() - 1)))]));
  return out;
}

// Of every stroke, the number of its curve in sketch.json: smooth chains of cubics are one there.
std::vector<int> curve_numbers(const Inspection& inspection) {
  return chain_of_strokes(curve_chains(inspection.measured), inspection.measured.size());
}

Json edge_json(const Inspection& inspection, const Nominal& nominal, size_t i,
               const std::vector<int>& curve) {
  const EdgeCheck& e = inspection.edges[i];
  const NominalEdge& edge = nominal.edges[i];
  Json out;
  out["name"] = edge.name;
  out["kind"] = kind_name(edge.kind);
  out["length"] = number(edge.length);
  out["presence"] = presence_name(e.presence);
  out["found"] = number(e.found);
  out["visible"] = number(e.visible);
  std::set<int> curves;
  for (const int s : inspection.association.edges[i].strokes) curves.insert(curve[s]);
  out["curves"] = curves;
  out["holds_pose"] = bool(inspection.alignment.holds[i]);
  const bool any = !e.largest_drawn.empty();
  for (const auto& [key, value] :
       {std::pair("mean", e.mean), std::pair("p95", e.p95), std::pair("largest", e.largest),
        std::pair("sigma", e.sigma), std::pair("systematic", e.systematic)})
    out[key] = any ? number(value) : Json();
  out["open"] = e.open;
  out["tolerance"] = number(e.tolerance);
  out["probability"] = any ? number(e.within.likely) : Json();
  out["low"] = any ? number(e.within.low) : Json();
  out["high"] = any ? number(e.within.high) : Json();
  out["known"] = any ? number(e.known) : Json();
  out["largest_quantiles"] = quantiles_of(e.largest_drawn);
  out["verdict"] = verdict_name(e.verdict);
  return out;
}

Json dimension_json(const DimensionResult& d, const Nominal& nominal) {
  const DimensionCheck& c = d.check;
  Json of = Json::array();
  for (const FeatureRef& f : c.dimension.features)
    of.push_back(f.kind == FeatureKind::kPlane ? nominal.planes[f.index].name
                                               : nominal.edges[f.index].name);
  Json out;
  out["name"] = c.dimension.name;
  out["kind"] = dimension_name(c.dimension.kind);
  out["of"] = of;
  out["unit"] = is_angle(c.dimension.kind) ? "deg" : "";
  out["nominal"] = number(c.dimension.nominal);
  out["measured"] = c.measured ? number(c.value) : Json();
  out["deviation"] = c.measured ? number(c.value - c.dimension.nominal) : Json();
  out["sigma"] = c.measured ? number(c.sigma) : Json();
  out["systematic"] = c.measured ? number(c.systematic) : Json();
  out["stated"] = c.measured ? number(c.stated) : Json();
  out["error_sizes"] = c.measured ? Json(sizes_of(c.shares)) : Json();
  out["error_shares"] = c.measured ? Json(c.shares) : Json();
  out["tolerance"] = number(d.tolerance);
  out["probability"] = c.measured ? number(d.probability) : Json();
  out["verdict"] = verdict_name(d.verdict);
  return out;
}

Json summary_json(const Inspection& inspection) {
  Json out;
  out["verdict"] = verdict_name(inspection.verdict);
  for (const Judgement v :
       {Judgement::kIn, Judgement::kOut, Judgement::kUndecided, Judgement::kNotJudged}) {
    const JudgementCounts n = count_verdicts(inspection, v);
    out["edges"][verdict_name(v)] = n.edges;
    out["dimensions"][verdict_name(v)] = n.dimensions;
  }
  out["extras"] = inspection.association.extras.size();
  return out;
}

std::string padded(std::string text, size_t width) {
  text.resize(std::max(width, text.size() + 1), ' ');
  return text;
}

std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

struct Line {
  double probability;
  std::string text;
};

void add_line(const std::string& name, double off, double sigma, double tolerance,
              double probability, Judgement verdict, std::vector<Line>* lines) {
  char share[16];
  std::snprintf(share, sizeof share, "%.3f", probability);
  lines->push_back({probability, padded(name, 30) + padded(short_number(off), 12) +
                                     padded(short_number(sigma), 11) +
                                     padded(short_number(tolerance), 11) + padded(share, 8) +
                                     verdict_name(verdict) + "\n"});
}

}  // namespace

const std::vector<double>& quantile_shares() {
  static const std::vector<double> shares = {0,    0.005, 0.01, 0.02,  0.05, 0.1, 0.2,
                                             0.3,  0.4,   0.5,  0.6,   0.7,  0.8, 0.9,
                                             0.95, 0.98,  0.99, 0.995, 1};
  return shares;
}

std::string inspection_json(const Inspection& inspection, const Nominal& nominal,
                            const InspectOptions& options, const InspectionTitle& title) {
  Json out;
  out["format_version"] = 1;
  out["program"] = "sketchsplat";
  out["version"] = title.version;
  out["result"] = title.result;
  out["nominal"] = title.nominal;
  out["unit"] = title.unit;
  out["scale"] = title.scale > 0 ? number(title.scale) : Json();
  out["extent"] = number(nominal.extent);
  out["tolerance"] = options.tolerance > 0 ? number(options.tolerance) : Json();
  const char* const kGrades[] = {"none", "f", "m", "c", "v"};
  out["iso2768"] = kGrades[int(options.iso)];
  out["sigma_model"] = sigma_json(options.sigma);
  out["alignment"] = alignment_json(inspection.alignment, options);
  out["prior"] = {{"learned", options.learn_prior},
                  {"scales", inspection.prior.scales},
                  {"weights", inspection.prior.weights},
                  {"dimension_scales", inspection.dimension_prior.scales},
                  {"dimension_weights", inspection.dimension_prior.weights}};
  out["summary"] = summary_json(inspection);
  out["warnings"] = inspection.warnings;
  out["quantile_shares"] = quantile_shares();
  const std::vector<int> curve = curve_numbers(inspection);
  out["edges"] = Json::array();
  for (size_t i = 0; i < inspection.edges.size(); ++i)
    out["edges"].push_back(edge_json(inspection, nominal, i, curve));
  out["dimensions"] = Json::array();
  for (const DimensionResult& d : inspection.dimensions)
    out["dimensions"].push_back(dimension_json(d, nominal));
  out["extras"] = Json::array();
  for (const ExtraStroke& x : inspection.association.extras)
    out["extras"].push_back({{"curve", curve[x.stroke]},
                             {"kind", kind_name(inspection.measured.strokes[x.stroke].kind)},
                             {"length", number(x.length)},
                             {"beside", number(x.beside)}});
  return json_text(out, 1) + "\n";
}

std::string inspection_csv(const Inspection& inspection, const Nominal& nominal) {
  std::string out =
      "item,name,kind,presence,found,nominal,measured,mean,p95,largest,sigma,systematic,tolerance,"
      "probability,low,high,verdict\n";
  for (size_t i = 0; i < inspection.edges.size(); ++i) {
    const EdgeCheck& e = inspection.edges[i];
    CsvRow row;
    row.add("edge").add(nominal.edges[i].name).add(kind_name(nominal.edges[i].kind));
    row.add(presence_name(e.presence)).add(e.found).skip(2);
    if (e.largest_drawn.empty())
      row.skip(5).add(e.tolerance).skip(3);
    else
      row.add(e.mean)
          .add(e.p95)
          .add(e.largest)
          .add(e.sigma)
          .add(e.systematic)
          .add(e.tolerance)
          .add(e.within.likely)
          .add(e.within.low)
          .add(e.within.high);
    out += row.add(verdict_name(e.verdict)).text();
  }
  for (const DimensionResult& d : inspection.dimensions) {
    const DimensionCheck& c = d.check;
    CsvRow row;
    row.add("dimension").add(c.dimension.name).add(dimension_name(c.dimension.kind)).skip(2);
    row.add(c.dimension.nominal);
    if (c.measured)
      row.add(c.value).skip(3).add(c.sigma).add(c.systematic).add(d.tolerance).add(d.probability);
    else
      row.skip(6).add(d.tolerance).skip(1);
    out += row.skip(2).add(verdict_name(d.verdict)).text();
  }
  const std::vector<int> curve = curve_numbers(inspection);
  for (const ExtraStroke& x : inspection.association.extras) {
    CsvRow row;
    row.add("extra").add("C" + std::to_string(curve[x.stroke]));
    row.add(kind_name(inspection.measured.strokes[x.stroke].kind)).skip(1).add(x.beside).skip(12);
    out += row.text();
  }
  return out;
}

std::string pieces_json(const Inspection& inspection, const Nominal& nominal, double footprint) {
  const SigmaModel raw;  // without a footprint: the covariances as they are
  const Sketch& measured = inspection.measured;
  const auto row_major = [](const Eigen::MatrixXd& m) {
    Json out = Json::array();
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index k = 0; k < m.cols(); ++k) out.push_back(number(m(i, k)));
    return out;
  };
  Json pieces = Json::array();
  for (size_t e = 0; e < nominal.edges.size(); ++e)
    for (const int s : inspection.association.edges[e].strokes) {
      const std::vector<EdgePlace> places = places_beside(inspection.association.edges[e], s, 5);
      const int n = 2 * int(places.size());
      const Eigen::MatrixXd modes =
          piece_errors(measured, places, nominal.edges[e].kind, true, raw).model.modes;
      Eigen::MatrixXd shift(n, 3), bend(n, 1), off(n, 1);
      for (int j = 0; j < n / 2; ++j) {
        const Eigen::Matrix<double, 2, 3> across = frame_across(places[j].tangent);
        shift.middleRows<2>(2 * j) = across;
        bend.middleRows<2>(2 * j) = across * bend_at(measured, s, places[j].t, footprint);
        off.middleRows<2>(2 * j) =
            across * places[j].deviation + inspection.pull_px2 * bend.middleRows<2>(2 * j);
      }
      const Evidence& evidence = measured.evidence[s];
      pieces.push_back({{"edge", nominal.edges[e].name},
                        {"presence", presence_name(inspection.edges[e].presence)},
                        {"kind", kind_name(measured.strokes[s].kind)},
                        {"simpler", is_simpler(measured.strokes[s].kind, nominal.edges[e].kind)},
                        {"footprint", number(footprint)},
                        {"sigma", number(evidence.sigma)},
                        {"bias_px", number(evidence.bias_px)},
                        {"view_bias_px", number(typical_bias_px(measured))},
                        {"deviation", row_major(off)},
                        {"covariance", row_major(modes * modes.transpose())},
                        {"shift", row_major(shift)},
                        {"bend", row_major(bend)}});
    }
  return json_text(Json{{"pieces", pieces}}) + "\n";
}

std::string inspection_table(const Inspection& inspection, const Nominal& nominal,
                             const InspectionTitle& title) {
  constexpr size_t kMost = 12;
  std::vector<Line> lines;
  for (size_t i = 0; i < inspection.edges.size(); ++i) {
    const EdgeCheck& e = inspection.edges[i];
    const std::string name = nominal.edges[i].name + " " + kind_name(nominal.edges[i].kind);
    if (!e.largest_drawn.empty())
      add_line(name, e.largest, std::hypot(e.sigma, e.systematic), e.tolerance, e.within.likely,
               e.verdict, &lines);
    else if (e.verdict != Judgement::kNotJudged)
      lines.push_back({0, padded(name, 30) + presence_name(e.presence) + "\n"});
  }
  for (const DimensionResult& d : inspection.dimensions)
    if (d.check.measured && d.verdict != Judgement::kNotJudged)
      add_line(d.check.dimension.name, d.check.value - d.check.dimension.nominal,
               std::hypot(d.check.sigma, d.check.systematic), d.tolerance, d.probability, d.verdict,
               &lines);
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.probability < b.probability; });
  std::string out = padded("lengths in " + title.unit, 30) + padded("deviation", 12) +
                    padded("sigma", 11) + padded("tolerance", 11) + padded("P(in)", 8) +
                    "verdict\n";
  for (size_t i = 0; i < lines.size() && i < kMost; ++i) out += lines[i].text;
  if (lines.size() > kMost)
    out += "... and " + std::to_string(lines.size() - kMost) + " more that are surer\n";
  for (const Judgement v :
       {Judgement::kIn, Judgement::kOut, Judgement::kUndecided, Judgement::kNotJudged}) {
    const JudgementCounts n = count_verdicts(inspection, v);
    out += padded(verdict_name(v), 12) + std::to_string(n.edges) + " edges, " +
           std::to_string(n.dimensions) + " dimensions\n";
  }
  return out;
}

}  // namespace sketchsplat

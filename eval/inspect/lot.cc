// SPDX-License-Identifier: MIT
#include "eval/inspect/lot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "eval/inspect/csv_row.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Values {
  std::vector<double> x, y;  // number of the part, value
  double squares = 0;        // of sigmas
};

void set_moments(const Values& v, LotRow* row) {
  const size_t n = v.y.size();
  row->parts = int(n);
  row->mean = row->deviation = row->low = row->high = row->sigma = kNaN;
  row->cp = row->cpk = row->trend = row->trend_t = kNaN;
  if (n == 0) return;
  row->low = *std::min_element(v.y.begin(), v.y.end());
  row->high = *std::max_element(v.y.begin(), v.y.end());
  double sum = 0, squares = 0;
  for (const double y : v.y) sum += y;
  row->mean = sum / double(n);
  for (const double y : v.y) squares += (y - row->mean) * (y - row->mean);
  row->sigma = std::sqrt(v.squares / double(n));
  if (n < 2) return;
  row->deviation = std::sqrt(squares / double(n - 1));
  const double above = row->nominal + row->tolerance - row->mean;
  const double below = row->is_edge ? above : row->mean - row->nominal + row->tolerance;
  if (!row->is_edge) row->cp = row->tolerance / (3 * row->deviation);
  row->cpk = std::min(above, below) / (3 * row->deviation);
}

// Least squares of the value by the number of the part.
void set_trend(const Values& v, LotRow* row) {
  const double n = double(v.y.size());
  if (n < 3) return;
  double mx = 0, my = 0, sxx = 0, sxy = 0, rest = 0;
  for (size_t i = 0; i < v.y.size(); ++i) mx += v.x[i] / n, my += v.y[i] / n;
  for (size_t i = 0; i < v.y.size(); ++i) {
    sxx += (v.x[i] - mx) * (v.x[i] - mx);
    sxy += (v.x[i] - mx) * (v.y[i] - my);
  }
  row->trend = sxy / sxx;
  for (size_t i = 0; i < v.y.size(); ++i)
    rest += std::pow(v.y[i] - my - row->trend * (v.x[i] - mx), 2);
  row->trend_t = row->trend / std::sqrt(rest / (n - 2) / sxx);
}

// From limit to limit and what lies beyond.
void set_histogram(const Values& v, LotRow* row) {
  if (v.y.empty()) return;
  row->histogram_low = std::min(row->low, row->is_edge ? 0 : row->nominal - row->tolerance);
  row->histogram_high = std::max(row->high, row->nominal + row->tolerance);
  row->histogram.assign(kHistogramBins, 0);
  const double width = row->histogram_high - row->histogram_low;
  for (const double y : v.y) {
    const int bin = width > 0 ? int((y - row->histogram_low) / width * kHistogramBins) : 0;
    ++row->histogram[std::clamp(bin, 0, kHistogramBins - 1)];
  }
}

template <typename Value, typename Sigma>
Values values_of(const std::vector<LotPart>& parts, const Value& value, const Sigma& sigma) {
  Values out;
  for (size_t i = 0; i < parts.size(); ++i) {
    const double y = value(parts[i]);
    if (!std::isfinite(y)) continue;
    out.x.push_back(double(i));
    out.y.push_back(y);
    out.squares += std::pow(sigma(parts[i]), 2);
  }
  return out;
}

void fill(const Values& v, LotRow* row) {
  set_moments(v, row);
  set_trend(v, row);
  set_histogram(v, row);
}

Json number(double x) { return std::isfinite(x) ? Json(nine_digits(x)) : Json(); }

Json json_of(const LotRow& r) {
  Json out;
  out["name"] = r.name;
  out["kind"] = r.kind;
  out["unit"] = r.unit;
  out["edge"] = r.is_edge;
  for (const auto& [key, value] :
       {std::pair("nominal", r.nominal), std::pair("tolerance", r.tolerance),
        std::pair("mean", r.mean), std::pair("deviation", r.deviation), std::pair("low", r.low),
        std::pair("high", r.high), std::pair("sigma", r.sigma), std::pair("cp", r.cp),
        std::pair("cpk", r.cpk), std::pair("trend", r.trend), std::pair("trend_t", r.trend_t),
        std::pair("histogram_low", r.histogram_low), std::pair("histogram_high", r.histogram_high)})
    out[key] = number(value);
  out["parts"] = r.parts;
  out["histogram"] = r.histogram;
  return out;
}

}  // namespace

LotPart lot_part(const std::string& name, const Inspection& inspection) {
  LotPart out;
  out.name = name;
  out.verdict = inspection.verdict;
  const auto count = [&](Judgement v) {
    const JudgementCounts n = count_verdicts(inspection, v);
    return n.edges + n.dimensions;
  };
  out.out = count(Judgement::kOut);
  out.undecided = count(Judgement::kUndecided);
  for (const EdgeCheck& e : inspection.edges) {
    out.edges.push_back(e.largest_drawn.empty() ? kNaN : e.largest);
    out.edge_sigma.push_back(std::hypot(e.sigma, e.systematic));
  }
  for (const DimensionResult& d : inspection.dimensions) {
    out.dimensions.push_back(d.check.measured ? d.check.value : kNaN);
    out.dimension_sigma.push_back(std::hypot(d.check.sigma, d.check.systematic));
  }
  return out;
}

std::vector<LotRow> lot_rows(const std::vector<LotPart>& parts, const Inspection& first,
                             const Nominal& nominal) {
  std::vector<LotRow> out;
  for (size_t i = 0; i < first.dimensions.size(); ++i) {
    const DimensionResult& d = first.dimensions[i];
    LotRow row;
    row.name = d.check.dimension.name;
    row.kind = dimension_name(d.check.dimension.kind);
    row.unit = is_angle(d.check.dimension.kind) ? "deg" : "";
    row.nominal = d.check.dimension.nominal;
    row.tolerance = d.tolerance;
    fill(values_of(
             parts, [&](const LotPart& p) { return p.dimensions[i]; },
             [&](const LotPart& p) { return p.dimension_sigma[i]; }),
         &row);
    out.push_back(row);
  }
  for (size_t i = 0; i < first.edges.size(); ++i) {
    LotRow row;
    row.is_edge = true;
    row.name = nominal.edges[i].name;
    row.kind = kind_name(nominal.edges[i].kind);
    row.tolerance = first.edges[i].tolerance;
    fill(values_of(
             parts, [&](const LotPart& p) { return p.edges[i]; },
             [&](const LotPart& p) { return p.edge_sigma[i]; }),
         &row);
    out.push_back(row);
  }
  return out;
}

std::string lot_csv(const std::vector<LotRow>& rows) {
  std::string out =
      "item,name,kind,unit,nominal,tolerance,parts,mean,deviation,low,high,sigma,cp,cpk,trend,"
      "trend_t\n";
  for (const LotRow& r : rows) {
    CsvRow row;
    row.add(r.is_edge ? "edge" : "dimension").add(r.name).add(r.kind).add(r.unit);
    row.add(r.nominal).add(r.tolerance).add(double(r.parts)).add(r.mean).add(r.deviation);
    row.add(r.low).add(r.high).add(r.sigma).add(r.cp).add(r.cpk).add(r.trend).add(r.trend_t);
    out += row.text();
  }
  return out;
}

std::string lot_json(const std::vector<LotPart>& parts, const std::vector<LotRow>& rows,
                     const std::string& nominal, const std::string& unit) {
  Json out;
  out["format_version"] = 1;
  out["nominal"] = nominal;
  out["unit"] = unit;
  out["parts"] = Json::array();
  for (const LotPart& p : parts)
    out["parts"].push_back({{"name", p.name},
                            {"verdict", verdict_name(p.verdict)},
                            {"out", p.out},
                            {"undecided", p.undecided}});
  out["rows"] = Json::array();
  for (const LotRow& r : rows) out["rows"].push_back(json_of(r));
  return json_text(out, 1) + "\n";
}

}  // namespace sketchsplat

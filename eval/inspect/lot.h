// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/inspect/inspection.h"

namespace sketchsplat {

/// One inspected part of a lot.
struct LotPart {
  std::string name;
  Judgement verdict = Judgement::kIn;
  int out = 0, undecided = 0;      ///< edges and dimensions
  std::vector<double> edges;       ///< largest deviations, NaN where nothing was measured
  std::vector<double> dimensions;  ///< measured values, NaN likewise
  std::vector<double> edge_sigma, dimension_sigma;  ///< of these, systematic errors included
};
LotPart lot_part(const std::string& name, const Inspection& inspection);

/// How a dimension, or the largest deviation of an edge, varies over a lot. NaN: too few parts.
struct LotRow {
  std::string name, kind, unit;  ///< unit: "deg" for angles, else empty
  bool is_edge = false;
  double nominal = 0, tolerance = 0;  ///< +-; of an edge 0 and the radius, which is only above
  int parts = 0;                      ///< in which it was measured
  double mean = 0, deviation = 0;     ///< deviation: standard, n - 1
  double low = 0, high = 0;
  double sigma = 0;  ///< of measuring it: root mean square
  /// Process capability: tolerance over 3 standard deviations, and the nearer limit's distance from
  /// the mean over them (ISO 22514-2, short term by the plain standard deviation; the scatter of
  /// measuring is part of it). Cp of an edge has no meaning.
  double cp = 0, cpk = 0;
  double trend = 0, trend_t = 0;  ///< slope per part, in the order given; over its standard error
  std::vector<int> histogram;     ///< of kHistogramBins equal bins from histogram_low to _high
  double histogram_low = 0, histogram_high = 0;
};
constexpr int kHistogramBins = 15;

/// A row per dimension and per edge. `first`: the inspection of any of the parts.
std::vector<LotRow> lot_rows(const std::vector<LotPart>& parts, const Inspection& first,
                             const Nominal& nominal);

std::string lot_csv(const std::vector<LotRow>& rows);
/// {"parts": [...], "rows": [...]}.
std::string lot_json(const std::vector<LotPart>& parts, const std::vector<LotRow>& rows,
                     const std::string& nominal, const std::string& unit);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipelines/bench/chart.h"
#include "pipelines/bench/row.h"
#include "pipelines/bench/stats.h"
#include "pipelines/bench/suite.h"

namespace sketchsplat {

/// What the rows of an axis say of one variant, level by level.
struct AxisResult {
  const BenchAxis* axis = nullptr;
  std::string variant;
  std::vector<double> levels;  ///< as they were run; those after a collapse are missing
  std::vector<Summary> f5, visible, seconds;    ///< over the parts
  std::optional<double> f5_drop, visible_drop;  ///< where they are 5 lower than at the first level
  double f5_difference = 0;  ///< of any part: largest less smallest F5 over the levels
  bool same_results = true;  ///< every part's curves are the same bytes at all levels
};

/// Results of all axes that report where accuracy drops or that it does not, in the order of the
/// suite. An axis without rows is left out.
std::vector<AxisResult> axis_results(const Suite& suite, const std::vector<BenchRow>& rows);

/// How one quantity grows along an axis of exponents, over all its rows.
struct GrowthResult {
  const BenchAxis* axis = nullptr;
  std::string variant, quantity;  ///< "total", "cpu_seconds" or "peak_mb"
  std::vector<double> x, y;
  PowerLaw law;
};
std::vector<GrowthResult> growth_results(const Suite& suite, const std::vector<BenchRow>& rows);

/// The table of the points at which the method fails: Markdown, and the same as CSV.
std::string limits_markdown(const std::vector<AxisResult>& results);
std::string limits_csv(const std::vector<AxisResult>& results);
std::string growth_markdown(const std::vector<GrowthResult>& results);
std::string growth_csv(const std::vector<GrowthResult>& results);

/// F5 along an axis with the spread over the parts and the point of its drop; below, the seconds.
/// `results`: of one axis, a variant each.
Chart axis_chart(const std::vector<AxisResult>& results);

/// Time and memory along an axis, both logarithmic, with the fitted laws. `results`: of one axis.
Chart growth_chart(const std::vector<GrowthResult>& results);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

namespace sketchsplat {

/// Where a quantity first falls by `drop` from its value at the first level, levels being ordered
/// from harmless to hopeless: interpolated between the two levels around it, linearly in the level,
/// or in its logarithm if `log` and both are positive. Nothing if it never does. Values that are
/// not finite are passed over; if the first is not, the first that is takes its place.
std::optional<double> drop_point(const std::vector<double>& levels,
                                 const std::vector<double>& values, double drop, bool log);

/// y = factor * x^exponent.
struct PowerLaw {
  double factor = 0, exponent = 0;
  double error = 0;  ///< standard error of the exponent; NaN for less than three points
  int points = 0;
};

/// Least squares of log y on log x. Points that are not positive are left out; NaNs if less than
/// two different x remain.
PowerLaw fit_power_law(const std::vector<double>& x, const std::vector<double>& y);

/// Mean, extremes and number of the finite values; NaN if there are none.
struct Summary {
  double mean, low, high;
  int count;
};
Summary summary_of(const std::vector<double>& values);

}  // namespace sketchsplat

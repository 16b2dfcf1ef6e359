// SPDX-License-Identifier: MIT
#include "pipelines/bench/stats.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sketchsplat {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
}

std::optional<double> drop_point(const std::vector<double>& levels,
                                 const std::vector<double>& values, double drop, bool log) {
  int first = -1, last = -1;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    if (first < 0) first = int(i);
    const double limit = values[first] - drop;
    if (values[i] <= limit) {
      const double a = levels[last], b = levels[i];
      const double t = (values[last] - limit) / (values[last] - values[i]);
      if (log && a > 0 && b > 0) return a * std::pow(b / a, t);
      return a + t * (b - a);
    }
    last = int(i);
  }
  return std::nullopt;
}

PowerLaw fit_power_law(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> u, v;
  for (size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0 && y[i] > 0 && std::isfinite(x[i]) && std::isfinite(y[i]))) continue;
    u.push_back(std::log(x[i]));
    v.push_back(std::log(y[i]));
  }
  const double n = double(u.size());
  double mean_u = 0, mean_v = 0, uu = 0, uv = 0, rest = 0;
  for (size_t i = 0; i < u.size(); ++i) mean_u += u[i] / n, mean_v += v[i] / n;
  for (size_t i = 0; i < u.size(); ++i) {
    uu += (u[i] - mean_u) * (u[i] - mean_u);
    uv += (u[i] - mean_u) * (v[i] - mean_v);
  }
  if (!(uu > 1e-12)) return {kNone, kNone, kNone, int(n)};
  const double b = uv / uu, a = mean_v - b * mean_u;
  for (size_t i = 0; i < u.size(); ++i) rest += std::pow(v[i] - a - b * u[i], 2);
  return {std::exp(a), b, n > 2 ? std::sqrt(rest / (n - 2) / uu) : kNone, int(n)};
}

Summary summary_of(const std::vector<double>& values) {
  Summary s = {0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               0};
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    s.mean += v;
    s.low = std::min(s.low, v);
    s.high = std::max(s.high, v);
    ++s.count;
  }
  if (s.count == 0) return {kNone, kNone, kNone, 0};
  s.mean /= s.count;
  return s;
}

}  // namespace sketchsplat

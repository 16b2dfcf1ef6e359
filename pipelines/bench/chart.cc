// SPDX-License-Identifier: MIT
#include "pipelines/bench/chart.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sketchsplat {
namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double v, bool log) {
    if (!std::isfinite(v) || (log && v <= 0)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

// A little room around the points; something to draw even if there is no point, or only one.
Range padded(Range r, bool log) {
  if (r.low > r.high) return log ? Range{0.1, 10} : Range{0, 1};
  if (log) {
    const double room = std::max(0.06 * std::log10(r.high / r.low), 0.08);
    return {r.low * std::pow(10, -room), r.high * std::pow(10, room)};
  }
  const double room = r.high > r.low ? 0.05 * (r.high - r.low) : std::max(1.0, std::abs(r.low)) / 2;
  return {r.low - room, r.high + room};
}

bool drawable(const Panel& p, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!p.log_x || x > 0) && (!p.log_y || y > 0);
}

double share(double v, double low, double high, bool log) {
  if (log) return std::log(v / low) / std::log(high / low);
  return (v - low) / (high - low);
}

}  // namespace

Panel fitted(Panel p) {
  Range x, y;
  for (const Series& s : p.series) {
    for (size_t i = 0; i < s.x.size(); ++i) {
      if (!drawable(p, s.x[i], s.y[i])) continue;
      x.add(s.x[i], p.log_x);
      y.add(s.y[i], p.log_y);
      if (!s.low.empty()) y.add(s.low[i], p.log_y), y.add(s.high[i], p.log_y);
    }
  }
  const Range px = padded(x, p.log_x), py = padded(y, p.log_y);
  if (std::isnan(p.x_low)) p.x_low = px.low;
  if (std::isnan(p.x_high)) p.x_high = px.high;
  if (std::isnan(p.y_low)) p.y_low = py.low;
  if (std::isnan(p.y_high)) p.y_high = std::max(py.high, p.y_low + 1e-9);
  return p;
}

double chart_x(const Panel& p, double x) {
  const double t = share(x, p.x_low, p.x_high, p.log_x);
  return p.left + p.width * (p.reversed_x ? 1 - t : t);
}

double chart_y(const Panel& p, double y) {
  return p.top + p.height * (1 - share(y, p.y_low, p.y_high, p.log_y));
}

std::vector<double> round_ticks(double low, double high, int count, bool log) {
  std::vector<double> ticks;
  if (!(low < high) || count < 1) return ticks;
  if (log) {
    const std::vector<std::vector<int>> choices = {
        {1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 5}, {1, 3}, {1}};
    for (const auto& digits : choices) {
      ticks.clear();
      for (int d = int(std::floor(std::log10(low))); d <= int(std::ceil(std::log10(high))); ++d)
        for (const int digit : digits) {
          const double v = digit * std::pow(10.0, d);
          if (v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9)) ticks.push_back(v);
        }
      if (int(ticks.size()) <= count) break;
    }
    if (ticks.size() >= 3 || high > 10 * low) return ticks;
    ticks.clear();  // a small part of a decade is as good as linear
  }
  const double raw = (high - low) / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = power * (raw > 5 * power ? 10 : raw > 2 * power ? 5 : raw > power ? 2 : 1);
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k == 0 ? 0 : k * step);
  return ticks;
}

std::vector<int> pareto_front(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<int> order;
  for (size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) order.push_back(int(i));
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return x[a] != x[b] ? x[a] < x[b] : y[a] > y[b]; });
  std::vector<int> front;
  for (const int i : order)
    if (front.empty() || y[i] > y[front.back()]) front.push_back(i);
  return front;
}

}  // namespace sketchsplat

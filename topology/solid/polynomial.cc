// SPDX-License-Identifier: MIT
#include "topology/solid/polynomial.h"

#include <cmath>
#include <cstddef>

namespace sketchsplat {
namespace {

double value(const std::vector<double>& c, double x) {
  double sum = 0;
  for (size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}

// Between two places of which one lies below and one above zero: Newton's steps, halved where they
// lead out.
double root_between(const std::vector<double>& c, const std::vector<double>& derivative, double low,
                    double high) {
  const bool rises = value(c, low) < 0;
  const double enough = 1e-13 * (high - low);
  double x = (low + high) / 2;
  for (int i = 0; i < 60 && high - low > enough; ++i) {
    const double y = value(c, x);
    ((y < 0) == rises ? low : high) = x;
    const double next = x - y / value(derivative, x);
    const double last = x;
    x = next > low && next < high ? next : (low + high) / 2;
    if (std::abs(x - last) <= enough) break;
  }
  return x;
}

}  // namespace

std::vector<double> roots_between(const std::vector<double>& c, double low, double high) {
  if (c.size() < 2) return {};
  std::vector<double> derivative;
  for (size_t i = 1; i < c.size(); ++i) derivative.push_back(double(i) * c[i]);
  std::vector<double> bounds = roots_between(derivative, low, high);
  bounds.insert(bounds.begin(), low);
  bounds.push_back(high);
  std::vector<double> out;
  for (size_t i = 0; i + 1 < bounds.size(); ++i)
    if ((value(c, bounds[i]) < 0) != (value(c, bounds[i + 1]) < 0))
      out.push_back(root_between(c, derivative, bounds[i], bounds[i + 1]));
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/adjust/standard_series.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sketchsplat {
namespace {

constexpr double kSame = 1e-9;  // relative difference of equal lengths

// A series and how to list it around a value.
struct Series {
  std::string name;
  bool diameters;              // alone
  double step;                 // multiples of it; 0: a list
  std::vector<double> values;  // ascending; of one decade if `decades`
  bool decades;
};

const std::vector<double> kR40 = {1.00, 1.06, 1.12, 1.18, 1.25, 1.32, 1.40, 1.50, 1.60, 1.70,
                                  1.80, 1.90, 2.00, 2.12, 2.24, 2.36, 2.50, 2.65, 2.80, 3.00,
                                  3.15, 3.35, 3.55, 3.75, 4.00, 4.25, 4.50, 4.75, 5.00, 5.30,
                                  5.60, 6.00, 6.30, 6.70, 7.10, 7.50, 8.00, 8.50, 9.00, 9.50};

// For M1.6 to M64, coarse.
const std::vector<double> kMetricTapDrills = {
    1.25, 1.6,  2.05, 2.5,  2.9,  3.3,  4.2,  5.0,  6.8,  8.5,  10.2, 12.0, 14.0, 15.5, 17.5,
    19.5, 21.0, 24.0, 26.5, 29.5, 32.0, 35.0, 37.5, 40.5, 43.0, 47.0, 50.5, 54.5, 58.0};

// From number 80 to number 1, then A to Z.
const std::vector<double> kNumberDrills = {
    .0135, .0145, .0160, .0180, .0200, .0210, .0225, .0240, .0250, .0260, .0280, .0292,
    .0310, .0320, .0330, .0350, .0360, .0370, .0380, .0390, .0400, .0410, .0420, .0430,
    .0465, .0520, .0550, .0595, .0635, .0670, .0700, .0730, .0760, .0785, .0810, .0820,
    .0860, .0890, .0935, .0960, .0980, .0995, .1015, .1040, .1065, .1100, .1110, .1130,
    .1160, .1200, .1285, .1360, .1405, .1440, .1470, .1495, .1520, .1540, .1570, .1590,
    .1610, .1660, .1695, .1730, .1770, .1800, .1820, .1850, .1890, .1910, .1935, .1960,
    .1990, .2010, .2040, .2055, .2090, .2130, .2210, .2280, .2340, .2380, .2420, .2460,
    .2500, .2570, .2610, .2660, .2720, .2770, .2810, .2900, .2950, .3020, .3160, .3230,
    .3320, .3390, .3480, .3580, .3680, .3770, .3860, .3970, .4040, .4130};

// For UNC and UNF from number 4 to 1 in.
const std::vector<double> kInchTapDrills = {
    .0890,    .0935,    .1040,    .1065,    .1130,    .1360,    .1495,
    .1590,    .2010,    .2130,    .2570,    .2720,    5 / 16.,  .3320,
    .3680,    25 / 64., 27 / 64., 29 / 64., 31 / 64., 33 / 64., 17 / 32.,
    37 / 64., 21 / 32., 11 / 16., 49 / 64., 13 / 16., 7 / 8.,   59 / 64.};

// ISO 235: steps that grow with the diameter.
std::vector<double> twist_drills() {
  std::vector<double> out;
  const double steps[][3] = {{0.2, 3, 0.05}, {3, 14, 0.1}, {14, 32, 0.25}, {32, 50.5, 0.5}};
  for (const auto& [from, to, step] : steps)
    for (int k = 0; from + k * step < to - step / 2; ++k) out.push_back(from + k * step);
  for (double d = 51; d <= 100; ++d) out.push_back(d);
  return out;
}

std::vector<double> every(int stride) {
  std::vector<double> out;
  for (size_t i = 0; i < kR40.size(); i += stride) out.push_back(kR40[i]);
  return out;
}

const std::vector<Series>& series_of(StandardSystem system) {
  static const std::vector<Series> iso = {{"whole 10 mm", false, 10, {}, false},
                                          {"R5", false, 0, every(8), true},
                                          {"whole 5 mm", false, 5, {}, false},
                                          {"R10", false, 0, every(4), true},
                                          {"whole mm", false, 1, {}, false},
                                          {"tap drill ISO 2306", true, 0, kMetricTapDrills, false},
                                          {"R20", false, 0, every(2), true},
                                          {"0.5 mm", false, 0.5, {}, false},
                                          {"R40", false, 0, kR40, true},
                                          {"drill ISO 235", true, 0, twist_drills(), false},
                                          {"0.1 mm", false, 0.1, {}, false}};
  static const std::vector<Series> inch = {{"whole inch", false, 1, {}, false},
                                           {"1/2 in", false, 1 / 2., {}, false},
                                           {"1/4 in", false, 1 / 4., {}, false},
                                           {"1/8 in", false, 1 / 8., {}, false},
                                           {"0.1 in", false, 0.1, {}, false},
                                           {"1/16 in", false, 1 / 16., {}, false},
                                           {"1/32 in", false, 1 / 32., {}, false},
                                           {"tap drill", true, 0, kInchTapDrills, false},
                                           {"1/64 in", false, 1 / 64., {}, false},
                                           {"0.01 in", false, 0.01, {}, false},
                                           {"drill B94.11M", true, 0, kNumberDrills, false}};
  return system == StandardSystem::kInch ? inch : iso;
}

struct Entry {
  double value, spacing;
};

// A list is known up to its ends; what is beside the last entry has the step before it.
void list_between(const std::vector<double>& v, double unit, double low, double high,
                  std::vector<Entry>* out) {
  for (size_t i = 0; i < v.size(); ++i) {
    const double x = unit * v[i];
    if (x < low || x > high) continue;
    const double below = i > 0 ? v[i] - v[i - 1] : v[1] - v[0],
                 above = i + 1 < v.size() ? v[i + 1] - v[i] : v[i] - v[i - 1];
    out->push_back({x, unit * (below + above) / 2});
  }
}

std::vector<Entry> entries_between(const Series& s, double low, double high) {
  std::vector<Entry> out;
  if (s.step > 0) {
    for (double k = std::max(1.0, std::ceil(low / s.step)); k * s.step <= high; ++k)
      out.push_back({k * s.step, s.step});
  } else if (s.decades) {
    // With a neighbour of each end, so that spacings are right.
    std::vector<double> decade = {s.values.back() / 10};
    decade.insert(decade.end(), s.values.begin(), s.values.end());
    decade.push_back(10);
    for (int e = int(std::floor(std::log10(low))); e <= int(std::floor(std::log10(high))); ++e) {
      const double unit = std::pow(10.0, e);
      list_between(decade, unit, std::max(low, unit * (1 - kSame)),
                   std::min(high, unit * (s.values.back() + kSame)), &out);
    }
  } else {
    list_between(s.values, 1, low, high, &out);
  }
  return out;
}

}  // namespace

std::vector<std::string> standard_system_names() { return {"none", "iso", "inch"}; }

StandardSystem standard_system(const std::string& name) {
  const std::vector<std::string> names = standard_system_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) throw std::invalid_argument("no series of standard lengths: " + name);
  return StandardSystem(at - names.begin());
}

std::vector<StandardLength> standards_near(StandardSystem system, bool diameter, double value,
                                           double reach) {
  std::vector<StandardLength> out;
  if (system == StandardSystem::kNone || !(value > 0)) return out;
  const double low = std::max(value - reach, 1e-6 * value), high = value + reach;
  int used = 0;
  for (const Series& s : series_of(system)) {
    if (s.diameters && !diameter) continue;
    ++used;
    for (const Entry& e : entries_between(s, low, high)) {
      const auto same = std::find_if(out.begin(), out.end(), [&](const StandardLength& l) {
        return std::abs(l.value - e.value) < kSame * e.value;
      });
      if (same != out.end())
        same->spacing += e.spacing;
      else
        out.push_back({e.value, s.name, e.spacing});
    }
  }
  for (StandardLength& l : out) l.spacing /= used;
  std::sort(out.begin(), out.end(),
            [](const StandardLength& a, const StandardLength& b) { return a.value < b.value; });
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
// ISO 2768-1:1989, General tolerances, part 1: linear and angular dimensions without individual
// tolerance indications. DIN ISO 2768-1 and JIS B 0405 have the same numbers.
#include "eval/inspect/iso2768.h"

#include <cmath>

namespace sketchsplat {
namespace {

// Upper ends of the ranges of size [mm] (the first begins at 0.5), and +- [mm] by class f, m, c, v;
// negative: the table has none.
struct Linear {
  double up_to;
  double deviation[4];
};
constexpr Linear kLinear[] = {
    {3, {0.05, 0.1, 0.2, -1}},    {6, {0.05, 0.1, 0.3, 0.5}},  {30, {0.1, 0.2, 0.5, 1}},
    {120, {0.15, 0.3, 0.8, 1.5}}, {400, {0.2, 0.5, 1.2, 2.5}}, {1000, {0.3, 0.8, 2, 4}},
    {2000, {0.5, 1.2, 3, 6}},     {4000, {-1, 2, 4, 8}},
};
constexpr int kRows = int(sizeof(kLinear) / sizeof(kLinear[0]));

// Upper ends of the lengths of the shorter side [mm], and +- [minutes of arc] by class.
struct Angular {
  double up_to;
  double minutes[4];
};
constexpr Angular kAngular[] = {
    {10, {60, 60, 90, 180}}, {50, {30, 30, 60, 120}},    {120, {20, 20, 30, 60}},
    {400, {10, 10, 15, 30}}, {HUGE_VAL, {5, 5, 10, 20}},
};

constexpr double kAlmost = 1 + 1e-9;  // sizes from files are rounded

}  // namespace

double iso2768_linear(Iso2768 grade, double size_mm) {
  if (grade == Iso2768::kNone) return 0;
  const int column = int(grade) - 1;
  int row = 0;
  while (row + 1 < kRows && size_mm > kLinear[row].up_to * kAlmost) ++row;
  while (kLinear[row].deviation[column] < 0) row += row == 0 ? 1 : -1;
  return kLinear[row].deviation[column];
}

double iso2768_angle(Iso2768 grade, double leg_mm) {
  if (grade == Iso2768::kNone) return 0;
  int row = 0;
  while (leg_mm > kAngular[row].up_to * kAlmost) ++row;
  return kAngular[row].minutes[int(grade) - 1] / 60;
}

}  // namespace sketchsplat

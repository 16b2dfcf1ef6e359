// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sketchsplat {

/// Which series of standard lengths a part may keep to.
enum class StandardSystem { kNone, kIso, kInch };
/// "none", "iso", "inch"; in the order of the enum.
std::vector<std::string> standard_system_names();
StandardSystem standard_system(const std::string& name);

/// A length that a designer would choose.
struct StandardLength {
  double value = 0;    ///< mm; of kInch: inch
  std::string series;  ///< the coarsest one that has it: "R10", "tap drill ISO 2306"
  /// Half the distance of its neighbours in a series, 0 in one that does not have it; mean over all
  /// series. That is what naming it costs, in nats: a free number x with a standard deviation s is
  /// told with log(1 / (p(x) s sqrt(2 pi))), an entry of a series, if entries are as dense as p
  /// says, with log(1 / (p(x) spacing)).
  double spacing = 0;
};

/// Standard lengths within `reach` of a value, ascending. Metric: preferred numbers R5 to R40 (ISO
/// 3), multiples of 10, 5, 1, 0.5 and 0.1 mm; of diameters also twist drills (ISO 235) and drills
/// for metric coarse threads (ISO 2306). Inch: multiples of 1 to 1/64 in and of 0.1 and 0.01 in; of
/// diameters also number and letter drills (ASME B94.11M) and drills for unified threads.
std::vector<StandardLength> standards_near(StandardSystem system, bool diameter, double value,
                                           double reach);

}  // namespace sketchsplat

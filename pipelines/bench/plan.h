// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/bench/suite.h"

namespace sketchsplat {

/// One row to be: a scene, a way of running the method, and the level of an axis they are at.
struct BenchJob {
  std::string scene, variant;  ///< names
  std::string folder;          ///< of a scene that exists; empty: synthesized
  OptionTexts synthesize;      ///< of the verb, "part" and "seed" among them; each name once
  OptionTexts reconstruct;     ///< of the verb; each name once
  const BenchAxis* axis = nullptr;
  std::string level;  ///< of the axis, as the suite states it
};

/// Jobs that belong together: a level of an axis, or the whole suite if it has no axes.
using BenchLevel = std::vector<BenchJob>;

/// All jobs of an axis (null: a suite without axes), level after level. `with` comes on top of all
/// options of reconstruct. The jobs point to the axis.
std::vector<BenchLevel> plan_jobs(const Suite& suite, const BenchAxis* axis,
                                  const OptionTexts& with);

/// What options look like on a command line of that verb: flags and their values, "param.gap" as
/// --param gap=VALUE.
std::vector<std::string> flags_of(const OptionTexts& options, const std::vector<Field>& fields);

/// Pixels between the ends of the object's longest side, side on, as these options of synthesize
/// show it from its mean distance.
double object_pixels(const OptionTexts& synthesize);

}  // namespace sketchsplat

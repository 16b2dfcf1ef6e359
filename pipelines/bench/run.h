// SPDX-License-Identifier: MIT
// In: a suite of scenes, variants and axes. Out: a row of numbers for each run, tables and charts.
// This folder may not include batch or program.
#pragma once

#include <string>
#include <vector>

#include "pipelines/base/progress.h"
#include "pipelines/bench/row.h"
#include "pipelines/bench/suite.h"

namespace sketchsplat {

struct BenchRun {
  Suite suite;
  OptionTexts with;    ///< options of reconstruct for all runs, on top of all others
  std::string out;     ///< the folder to write into
  std::string scenes;  ///< the folder of synthesized scenes; empty: out/scenes
  int threads = 0;     ///< of each run; 0: one per core
};

/// Measures every scene of the suite with every variant, at every level of its axes. Each run is a
/// process of its own, so that a crash costs one row and memory is that run's alone.
///
/// Rows are written to out/rows.json and out/rows.csv after each run. Rows that are there already
/// are not run again if the program, the machine, the scene and all options are the same.
///
/// A run that fails is a row with F = 0 and the label "reason"; one whose scene cannot be made has
/// no numbers. An axis that reports where accuracy drops ends at the level where no row has an F5
/// above 20. Folders without ground truth are left out with a warning.
///
/// Throws InputError (no scene has a truth; out/rows.json is something else), OutputError,
/// UsageError (the program refuses an option that the suite names).
std::vector<BenchRow> run_suite(const BenchRun& run, Progress* progress);

}  // namespace sketchsplat

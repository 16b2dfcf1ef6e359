// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/options.h"
#include "pipelines/progress.h"
#include "pipelines/run_report.h"

namespace sketchsplat {

/// A way of running the method: what differs from the defaults.
struct BenchVariant {
  std::string name;
  OptionTexts options;
};

/// One variant per preset.
std::vector<BenchVariant> preset_variants(const std::vector<std::string>& presets);

/// What each part of the method is worth. First parts are added one by one, from strokes that no
/// least squares has touched up to the whole method; then one part at a time is left out of it.
std::vector<BenchVariant> ablation_variants();

/// What a variant made of a scene. Numbers, in this order: F5 F2 F1 (published protocol, per cent),
/// Acc Comp (thousandths of the object's longest side), fine_F5 fine_F2 fine_F1, strokes,
/// strokes_per_edge, structure_F, seconds per stage, total (everything that a user waits for), cpu
/// (of all threads), decode (the scene's images by one thread), total_per_decode, peak_mb. NaN
/// where there is none.
struct BenchRow {
  std::string scene, variant;
  Numbers numbers;
};

struct BenchOptions {
  std::vector<std::string> scenes;  ///< folders
  std::vector<BenchVariant> variants;
  OptionTexts options;  ///< for all variants, on top of theirs
  std::string out;      ///< results are written to out/<scene>/<variant>/
  int repeats = 1;      ///< of each run; the fastest counts
  int seed = 0;
};

/// Reconstructs every scene with every variant and compares with its ground truth. Scenes without
/// truth are left out with a warning; a scene with too little to reconstruct scores nothing.
/// Throws InputError (a scene cannot be read; none has a truth), OutputError, UsageError.
std::vector<BenchRow> run_bench(const BenchOptions& options, Progress* progress);

/// Means over the scenes, one row per variant, the scene called "mean". NaNs do not take part.
std::vector<BenchRow> mean_rows(const std::vector<BenchRow>& rows);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipelines/options/common_options.h"

namespace sketchsplat {

/// A scene to measure on: a folder, or a part to synthesize.
struct BenchScene {
  std::string name;
  std::string folder;      ///< empty: synthesized
  std::string part;        ///< as `synthesize` takes it
  OptionTexts synthesize;  ///< its options, on top of the suite's
};

/// A way of running the method: what differs from the defaults.
struct BenchVariant {
  std::string name;
  OptionTexts options;  ///< of reconstruct
};

/// One variant per preset and detector; the detector is in the name if there are several.
std::vector<BenchVariant> preset_variants(const std::vector<std::string>& presets,
                                          const std::vector<std::string>& detectors = {"image"});

/// What each part of the method is worth. First parts are added one by one, from strokes that no
/// least squares has touched up to the whole method; then one part at a time is left out of it.
std::vector<BenchVariant> ablation_variants();

/// The same of `detectors`: for "2dgs-sn" alone what each part of fitting surfels is worth, one
/// left out or exchanged at a time, beside the detector "image"; else ablation_variants().
std::vector<BenchVariant> ablation_variants_of(const std::vector<std::string>& detectors);

/// One option that is varied while all others stay.
struct BenchAxis {
  std::string name, title;
  bool of_reconstruct = false;      ///< the option is one of reconstruct, else of synthesize
  std::string option;               ///< "noise", or "param.gap": --param gap=LEVEL
  std::vector<std::string> levels;  ///< from harmless to hopeless, as options' values
  bool in_pixels = false;  ///< levels are pixels of the image; the option is a share of the object
  bool log = false;        ///< levels are compared by their ratio
  /// What eval/charts.py reports: "drop" (where accuracy falls; levels are numbers, or true and
  /// false), "constant" (whether results differ) or "exponent" (how time and memory grow).
  std::string report = "drop";
  std::string against;  ///< number of a row that stands for the level in a report of exponents
  std::vector<BenchScene> scenes;       ///< instead of the suite's; empty: the same
  std::vector<std::string> part_seeds;  ///< seeds of the synthesized parts; empty: the suite's
  OptionTexts synthesize, reconstruct;  ///< on top of the suite's
};

struct Suite {
  std::string name = "bench";
  std::vector<BenchScene> scenes;
  std::vector<BenchVariant> variants = preset_variants(preset_names());
  std::vector<std::string> part_seeds = {"1"};  ///< of the synthesized parts
  OptionTexts synthesize, reconstruct;          ///< of all scenes; of all runs
  std::vector<BenchAxis> axes;                  ///< none: each scene as it is
  int repeats = 1;                              ///< of each run; the fastest counts
  double timeout_seconds = 3600;                ///< of a run
  bool keep = false;  ///< the results of the runs, too, not their numbers alone
};

/// What stands for a level in tables and charts: its number, 1 for "true", 0 for "false"; nothing
/// for any other text.
std::optional<double> level_number(const std::string& level);

/// All presets on these scenes; results are kept.
Suite suite_of_folders(const std::vector<std::string>& folders);

/// Reads a suite file (YAML or JSON; eval/suites/stability.yml describes the format). Paths in it
/// are relative to it. Throws InputError (the file, the line, what was expected, what was found).
Suite read_suite(const std::string& path);

/// Sets options as a command line of that verb with these would, to check names and ranges.
/// Throws UsageError.
void check_suite_options(const Suite& suite);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pipelines/base/run_report.h"
#include "pipelines/options/common_options.h"

namespace sketchsplat {

/// What one way of running the method made of one scene.
struct BenchRow {
  std::string scene, variant;
  /// Named texts: "key" (what decides the row; equal keys need not be run twice), "status" (of the
  /// run; see README), "reason", "part", "axis", "program", "cpu" ... Whatever a runner knows.
  OptionTexts labels;
  /// Named numbers; NaN where there is none. Of every row that was run: what `evaluate --json`
  /// tells (nested names joined by '_': "fine_F5"), seconds per stage of the run, "total" (seconds
  /// that a user waits), "cpu_seconds" (of all threads), "decode" (seconds that one thread takes to
  /// decode the scene's images), "total_per_decode", "peak_mb"; of parts that
  /// are known "solid_right", "solid_wrong", "solid_refused", one of which is 1; of a level of an
  /// axis: "level".
  Numbers numbers;

  std::string label(const std::string& name) const;  ///< empty if there is none
  double number(const std::string& name) const;      ///< NaN if there is none
  void set(const std::string& name, const std::string& text);
  void set(const std::string& name, double value);
};

/// Means over the scenes, one row per variant, the scene called "mean". NaNs do not take part.
std::vector<BenchRow> mean_rows(const std::vector<BenchRow>& rows);

/// A line per variant: how many solids are right, wrong and refused; empty if no part is known.
std::string solid_counts(const std::vector<BenchRow>& rows);

/// The rows under their headings, aligned, a blank line between scenes. "-" where there is no
/// number. `columns` are names of numbers, empty: all.
std::string bench_table(const std::vector<BenchRow>& rows,
                        const std::vector<std::string>& columns = {});

/// Comma-separated, all digits; empty where there is no number. Columns are all labels and numbers
/// of all rows, in the order in which they are met.
std::string bench_csv(const std::vector<BenchRow>& rows);

/// {"program", "version", "suite", "rows": [{"scene", "variant", label: text, number: value,
/// ...}]}; null where there is no number.
std::string bench_json(const std::vector<BenchRow>& rows, const std::string& suite);

/// Reads what bench_json wrote; no rows if there is no such file. Throws InputError.
std::vector<BenchRow> read_bench_json(const std::string& path);

}  // namespace sketchsplat

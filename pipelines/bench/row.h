// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/base/run_report.h"
#include "pipelines/bench/suite.h"

namespace sketchsplat {

/// Named texts and numbers of one run of the method on one scene, in the order of their columns.
struct BenchRow {
  std::string scene, variant;
  /// "key" (what decides the row; equal keys need not be run twice), "status" (exit status of the
  /// run, or "no scene"), "reason", "axis", "at", "program", "cpu" ...
  OptionTexts labels;
  /// NaN where there is none. Of every row that was run: numbers of `evaluate --json` (nested names
  /// joined by '_': "fine_F5"), seconds per stage of the run, "total" (wall clock), "cpu_seconds"
  /// (of all threads), "decode" (seconds of one thread for decoding the scene's images),
  /// "total_per_decode", "peak_mb"; of parts that are known "solid_right", "solid_wrong",
  /// "solid_refused", one of which is 1; of a level of an axis: "level".
  Numbers numbers;

  std::string label(const std::string& name) const;  ///< empty if there is none
  double number(const std::string& name) const;      ///< NaN if there is none
  void set(const std::string& name, const std::string& text);
  void set(const std::string& name, double value);
};

/// Means over the scenes, one row per level of an axis and variant, the scene called "mean" or
/// "AXIS LEVEL". NaNs do not take part.
std::vector<BenchRow> mean_rows(const std::vector<BenchRow>& rows);

/// The rows under their headings, aligned, a blank line between scenes. "-" where there is no
/// number. `columns` are names of numbers.
std::string bench_table(const std::vector<BenchRow>& rows, const std::vector<std::string>& columns);

/// Comma-separated, all digits; empty where there is no number. Columns are all labels and numbers
/// of all rows, in the order in which they are met.
std::string bench_csv(const std::vector<BenchRow>& rows);

/// {"program", "version", "suite", "axes": [{"name", "title", "log", "report", "against"}], "rows":
/// [{"scene", "variant", label: text, number: value, ...}]}; null where there is no number.
std::string bench_json(const std::vector<BenchRow>& rows, const Suite& suite);

/// Reads the rows that bench_json wrote; none if there is no such file. Throws InputError.
std::vector<BenchRow> read_bench_json(const std::string& path);

}  // namespace sketchsplat

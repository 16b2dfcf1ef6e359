// SPDX-License-Identifier: MIT
// In: what a run does, as it does it. Out: its report, its progress, files, children, the machine.
// This folder may not include anything else of pipelines.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/base/progress.h"
#include "sketches/solve/relations.h"

namespace sketchsplat {

/// Named numbers in the order in which they were found; written to reports as they are.
using Numbers = std::vector<std::pair<std::string, double>>;

struct StageReport {
  std::string name;
  double seconds = 0;  ///< wall clock
  double peak_mb = 0;  ///< peak resident memory of the process up to the end of the stage [MB]
  std::string result;  ///< in a few words
};

/// What happened during a run: everything in report.json that is not an option.
struct RunReport {
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  std::vector<StageReport> stages;
  Numbers counts;                        ///< of the scene and the method: "views", "edgels"
  std::vector<Numbers> rounds;           ///< one row per round
  std::vector<Regularity> regularities;  ///< that the sketch keeps to
  std::vector<Numbers>
      strokes;  ///< what the confidence of each stroke was made of, see confidence.h
  std::vector<std::string> warnings;
};

/// Peak resident memory of this process so far [MB = 1e6 bytes].
double peak_memory_mb();

/// Where a run is written down, and who watches it; both may be null.
struct RunLog {
  RunReport* report = nullptr;
  Progress* progress = nullptr;

  void count(const std::string& name, double value) const;  ///< one of the report's counts
  void warn(const std::string& text) const;                 ///< to both
  void note(const std::string& text) const;                 ///< to those who watch closely
};

/// A stage from construction to destruction, timed into the report.
class Stage {
 public:
  /// `total` is the number of step()s that will come; 0 if unknown.
  Stage(const std::string& name, const RunLog& log, int total = 0);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void step();  ///< from any thread
  void result(const std::string& text) { result_ = text; }

 private:
  std::string name_, result_;
  RunLog log_;
  std::chrono::steady_clock::time_point began_;
};

}  // namespace sketchsplat

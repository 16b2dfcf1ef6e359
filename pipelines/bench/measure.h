// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "pipelines/base/progress.h"
#include "pipelines/bench/plan.h"
#include "pipelines/bench/row.h"
#include "pipelines/command/cli.h"

namespace sketchsplat {

/// Labels of everything that was measured here: "version", "program" (hash of the executable),
/// "cpu" (model), "cores", "memory" ("25 GB").
OptionTexts machine_labels();

/// Runs jobs in child processes and reads what they wrote.
class Measurer {
 public:
  struct Settings {
    std::string scenes;  ///< folder of synthesized scenes, reused if they are whole
    std::string log;     ///< file for what a child says on stderr
    int threads = 0;     ///< 0: one per core
    int repeats = 1;
    double timeout_seconds = 3600;
  };
  explicit Measurer(const Settings& settings);

  /// Everything that decides a job's row as one text: program, machine, scene, options, threads.
  std::string key(const BenchJob& job) const;

  /// Runs a job; `result` is the folder that the reconstruction is written to. Throws OutputError
  /// if it could not be written, UsageError if the program refused an option.
  BenchRow measure(const BenchJob& job, const std::string& result);

 private:
  struct SceneFacts {
    double decode = 0, views = 0, pixels = 0;
  };
  std::string scene_folder(const BenchJob& job) const;
  bool make_scene(const BenchJob& job, BenchRow* row);
  bool reconstruct(const BenchJob& job, const std::string& result, BenchRow* row);
  void add_accuracy(const std::string& prediction, const std::string& truth, BenchRow* row);
  void judge_solid(const std::string& truth, bool written, BenchRow* row) const;
  const SceneFacts& facts_of(const std::string& folder);

  Settings settings_;
  OptionTexts machine_;
  Verb synthesize_, reconstruct_;
  std::string renderer_;  ///< hash of the plug-in that makes scenes
  std::map<std::string, SceneFacts> facts_;
};

}  // namespace sketchsplat

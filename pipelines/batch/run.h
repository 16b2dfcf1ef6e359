// SPDX-License-Identifier: MIT
// In: a list of scenes. Out: a result folder for each, and what has become of all of them.
// This folder may not include program.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/readers/open_options.h"
#include "pipelines/base/progress.h"
#include "pipelines/base/schedule.h"
#include "pipelines/batch/store.h"
#include "pipelines/batch/summary.h"
#include "pipelines/options/options.h"
#include "pipelines/options/output_options.h"

namespace sketchsplat {

/// What a batch does, and with what.
struct BatchRun {
  std::string out;
  Shard shard;
  OpenOptions open;  ///< of the scenes
  ReconstructOptions method;
  OutputOptions output;
  int jobs = 0;                   ///< workers at a time; 0: as many as cores and memory allow
  int threads = 1;                ///< of each worker
  int retries = 1;                ///< of scenes that a signal from elsewhere ended
  double memory_mb = 0;           ///< of a worker, 0: no limit
  double timeout_seconds = 3600;  ///< of a scene, 0: none
  bool force = false;             ///< do again what is done
  int family = 0;                 ///< scenes that are siblings of all after them; 0: none
};

/// A scene with what decides whether it is done.
struct PlannedScene {
  BatchScene scene;
  SceneKey key;
};

/// All options of reconstruct as JSON, as reports state them.
std::string batch_options_json(const BatchRun& run);

/// Looks at what the scenes hold.
std::vector<PlannedScene> plan_scenes(const std::vector<BatchScene>& scenes, const BatchRun& run);

/// Scenes that are done alike, before those of the next group.
struct BatchGroup {
  std::vector<PlannedScene> scenes;
  BatchRun run;
};

/// Without a family one group. With run.family two: the first scenes, cold, and all others, like
/// those of the first that are done by now. So which siblings a scene has depends neither on who is
/// ready first nor on what was done before.
std::vector<BatchGroup> batch_groups(const std::vector<PlannedScene>& scenes, const BatchRun& run);

/// What is left to do, how long it will take and how much memory, roughly.
struct BatchPlan {
  std::vector<int> open;    ///< indices of the scenes that are not done
  std::vector<Load> loads;  ///< of these
  int jobs = 1;             ///< workers at a time
  double memory_mb = 0;     ///< of all of them together, at the most
};
BatchPlan plan_batch(const BatchGroup& group, Progress* progress);

/// Somebody wants the program to end: nothing is half done, and it can go on later.
struct Interrupted : std::runtime_error {
  Interrupted(int signal, const std::string& text) : std::runtime_error(text), number(signal) {}
  int number;  ///< of the signal
};

/// Reconstructs what is open, each scene in processes of its own, and records how each ended.
/// Throws OutputError (the folder cannot be written, for any scene), Interrupted (SIGINT, SIGTERM
/// or SIGHUP came).
void run_batch(const BatchGroup& group, const BatchStore& store, Progress* progress);

}  // namespace sketchsplat

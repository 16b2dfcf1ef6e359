// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipelines/base/child.h"
#include "pipelines/batch/record.h"
#include "pipelines/batch/scene_list.h"
#include "pipelines/batch/store.h"

namespace sketchsplat {

struct WorkerSettings {
  std::vector<std::string> flags;  ///< of `reconstruct`: everything but scene and output
  double memory_mb = 0;            ///< of a process, 0: no limit
  double timeout_seconds = 0;      ///< of a scene, 0: none
};

/// A scene on its way: a process that reconstructs it, one that compares it with the truth if
/// there is one, and its result taken over. The processes die with this object.
class SceneWorker {
 public:
  /// Starts the first process. Throws OutputError; std::runtime_error if none can be made.
  SceneWorker(const BatchScene& scene, const SceneKey& key, const WorkerSettings& settings,
              const BatchStore& store);

  /// Goes on if a process has ended, ends it if it takes too long. Returns whether all is over;
  /// then the result is in its place, or run() says why there is none. Throws OutputError: not
  /// this scene, but all would fail so.
  bool advance();
  /// Of all processes; the number of attempts, host and time are left open.
  const RunRecord& run() const { return run_; }
  /// Whether another attempt may go better: a signal from elsewhere ended it, perhaps the kernel's
  /// for want of memory.
  bool was_struck() const;
  double seconds() const;  ///< since its start

 private:
  void start(const std::vector<std::string>& arguments);
  std::string note(const char* file) const { return store_.notes(scene_.name) + "/" + file; }
  void finish(bool scored, const std::string& complaint);
  void fail(const ChildResult& result);

  const BatchScene scene_;
  const SceneKey key_;
  const WorkerSettings settings_;
  const BatchStore& store_;
  std::unique_ptr<Child> child_;
  bool evaluating_ = false, timed_out_ = false;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  RunRecord run_;
};

}  // namespace sketchsplat

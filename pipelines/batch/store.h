// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "pipelines/batch/record.h"

namespace sketchsplat {

/// A part of a batch: of the scenes that in_shard() gives it. 1 of 1: all of them.
struct Shard {
  int index = 1, count = 1;
};

/// The output folder of a batch:
///
///   NAME/                     the result of a scene, with its record; whole or not there at all
///   summary.csv, .json        see summary.h
///   index.html
///   .batch/                   what differs from run to run; not needed to read results
///     scenes/NAME/run.json    how the last run of a scene went (RunRecord)
///     scenes/NAME/*.log       stderr of its processes, if it failed
///     timings.csv             all run.json
///     running/, trash/        results that are being written, or removed
///     lock*                   held by the batch that works here
///
/// Results are written into running/ and renamed when they are whole: there is no moment at which
/// a reader, or a batch after a crash, finds half of one. All functions throw OutputError.
class BatchStore {
 public:
  /// Makes the folder and takes its lock. Shards of one count may work side by side, on several
  /// machines if the file system's locks reach that far. Throws if another batch is at work in it.
  BatchStore(const std::string& out, const Shard& shard);
  ~BatchStore();
  BatchStore(const BatchStore&) = delete;
  BatchStore& operator=(const BatchStore&) = delete;

  std::string result(const std::string& scene) const { return out_ + "/" + scene; }
  /// Where a result is written first; only the folders above it are there.
  std::string running(const std::string& scene) const { return own("running/" + scene); }
  /// A folder for run.json and logs of a scene.
  std::string notes(const std::string& scene) const { return own("scenes/" + scene); }

  /// Refuses folders in the place of results that no reconstruction has made.
  void check_place(const std::string& scene) const;
  /// Makes the folders that a run of a scene needs; what is in running() is removed.
  void begin(const std::string& scene) const;
  /// Takes what is in running() as the scene's result; an older one goes.
  void publish(const std::string& scene) const;
  /// Removes a result of the scene, and what is in running().
  void withdraw(const std::string& scene) const;
  void forget_running(const std::string& scene) const;

  /// Writes a file of the output folder by way of .batch: a batch that is killed leaves no part of
  /// it.
  void write_file(const std::string& name, const std::function<void(std::ostream&)>& write) const;

  void write(const RunRecord& run, const std::string& scene) const {
    write_run(notes(scene) + "/run.json", run);
  }
  RunRecord run(const std::string& scene) const { return read_run(notes(scene) + "/run.json"); }

 private:
  std::string own(const std::string& name) const { return out_ + "/.batch/" + name; }
  void lock(const std::string& name, const std::string& shared_by);
  void remove_result(const std::string& scene) const;

  std::string out_;
  std::vector<int> locks_;
};

}  // namespace sketchsplat

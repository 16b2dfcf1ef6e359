// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/base/run_report.h"

namespace sketchsplat {

/// What decides whether a result is still valid.
struct SceneKey {
  std::string program;  ///< hash of version, commit and options
  std::string input;    ///< input_hash(); empty: nobody knows, there is no such folder

  /// Whether this is the key of a result that needs not be made again. An input that is gone has
  /// not changed.
  bool matches(const SceneKey& wanted) const {
    return !program.empty() && program == wanted.program &&
           (wanted.input.empty() || input == wanted.input);
  }
};

/// batch.json of a scene's result: the same for the same input, options and version.
struct SceneRecord {
  SceneKey key;
  std::vector<std::pair<std::string, std::uint64_t>> files;  ///< names and sizes of the others
  std::string format;
  Numbers counts;    ///< of report.json: views, curves of each kind and junctions
  int warnings = 0;  ///< in report.json
  Numbers scores;    ///< of `evaluate`; empty if there is no truth
  std::string note;  ///< why there is no score although there is a truth; empty if all is well
};

/// Reads what a reconstruction wrote into the folder, and the file of `evaluate --json` (may be
/// empty). The key is left open. Throws InputError if something is missing.
SceneRecord make_record(const std::string& folder, const std::string& evaluation);

/// Writes batch.json of the folder. Throws OutputError.
void write_record(const std::string& folder, const SceneRecord& record);

/// Whether the folder holds a record that matches the key, and the files that it names, of their
/// sizes. The record goes to `record`, without its files, if that is not null.
bool is_done(const std::string& folder, const SceneKey& key, SceneRecord* record = nullptr);

/// How the last run of a scene went: differs from run to run.
struct RunRecord {
  SceneKey key;        ///< matches none if it was never run
  int status = 0;      ///< of its process
  std::string reason;  ///< why it failed
  int attempts = 0;
  double seconds = 0, cpu_seconds = 0, peak_mb = 0;
  std::string host, ended;  ///< where, and the time in UTC
};

/// Throws OutputError. A file that is not there, or that is broken, has no key.
void write_run(const std::string& path, const RunRecord& run);
RunRecord read_run(const std::string& path);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "pipelines/batch/record.h"
#include "pipelines/batch/scene_list.h"
#include "pipelines/batch/store.h"

namespace sketchsplat {

/// A scene as the summary shows it. Nothing in it differs from run to run. Small: there may be a
/// hundred thousand.
struct SceneRow {
  enum class State { kFailed, kOpen, kDone };

  std::string scene;
  State state = State::kOpen;
  int status = 0;      ///< exit status if it failed
  std::string reason;  ///< why it failed
  SceneRecord record;  ///< if it is done
};

/// What is known of a scene from the output folder alone.
SceneRow scene_row(const BatchScene& scene, const SceneKey& key, const BatchStore& store);

/// Failures first, then open ones, then by name.
void sort_rows(std::vector<SceneRow>* rows);

int count_rows(const std::vector<SceneRow>& rows, SceneRow::State state);

/// A row each: scene, state, status, reason, format, counts, warnings, scores, note.
void write_summary_csv(std::ostream& out, const std::vector<SceneRow>& rows);

/// {program, version, commit, done, failed, open, mean (of the scores), options, scenes: [...]}, a
/// line for each scene.
void write_summary_json(std::ostream& out, const std::vector<SceneRow>& rows,
                        const std::string& options_json);

/// The same as a page that needs nothing but itself: a table to sort and search, with links to the
/// report of each scene, or to its log if it failed.
void write_summary_html(std::ostream& out, const std::vector<SceneRow>& rows,
                        const std::string& options_json);

/// scene, status, seconds, cpu_seconds, peak_mb, attempts, host, ended of the last runs.
void write_timings_csv(std::ostream& out, const std::vector<SceneRow>& rows,
                       const BatchStore& store);

}  // namespace sketchsplat

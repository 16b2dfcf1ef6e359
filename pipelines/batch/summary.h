// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/batch/record.h"
#include "pipelines/batch/scene_list.h"
#include "pipelines/batch/store.h"

namespace sketchsplat {

/// A scene as the summary shows it. Nothing in it differs from run to run.
struct SceneRow {
  enum class State { kDone, kFailed, kOpen };

  std::string scene;
  State state = State::kOpen;
  int status = 0;      ///< exit status if it failed
  std::string reason;  ///< why it failed
  SceneRecord record;  ///< if it is done
};

/// What is known of a scene from the output folder alone.
SceneRow scene_row(const BatchScene& scene, const SceneKey& key, const BatchStore& store);

/// scene, state, status, reason, format, counts of views, curves of each kind and junctions,
/// warnings, scores (means below them), note. Failures first, then open ones, then by name.
std::string summary_csv(const std::vector<SceneRow>& rows);

/// The same as JSON: {program, version, commit, options, done, failed, open, mean, scenes}.
std::string summary_json(const std::vector<SceneRow>& rows, const std::string& options_json);

/// The same as a page that needs nothing but itself: a table to sort and search, with a drawing of
/// each result; links to its report, or to what it said when it failed.
std::string summary_html(const std::vector<SceneRow>& rows, const std::string& options_json);

/// scene, status, seconds, cpu_seconds, peak_mb, attempts, host, ended of the last runs.
std::string timings_csv(const std::vector<BatchScene>& scenes, const BatchStore& store);

}  // namespace sketchsplat

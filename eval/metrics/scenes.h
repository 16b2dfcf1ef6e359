// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/metrics/evaluate.h"

namespace sketchsplat {

/// What counts for a scene without a prediction: nothing found (F, P and R are 0; it has no Acc and
/// Comp), or it is left out, as EMAP's and CurveGaussian's evaluators do.
enum class Missing { kZero, kSkip };

/// A scene of a data set, and where somebody's edges of it are.
struct ScenePair {
  std::string name;        ///< of the sub-folder
  std::string truth;       ///< folder
  std::string prediction;  ///< folder or file; empty if there is none
};

struct SceneEvaluation {
  std::string name;
  bool missing = false;  ///< no prediction
  Evaluation evaluation;
};

/// Is this a folder without a ground truth of its own? Then its sub-folders are the scenes.
bool is_folder_of_scenes(const std::string& truth);

/// Sub-folders of `truth` that hold a ground truth, by name; the prediction is NAME, NAME.json,
/// NAME.obj, NAME.ply or record_NAME_stage2_cubic.json (NEF) in `predictions`. Throws InputError if
/// there is no such scene, no such folder of predictions, or no prediction of any scene.
std::vector<ScenePair> find_scenes(const std::string& predictions, const std::string& truth);

/// Throws InputError; also if a prediction is there but broken: that is no missing one.
SceneEvaluation evaluate_scene(const ScenePair& scene, const EvaluateOptions& options);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "eval/metrics/scenes.h"

#include <algorithm>
#include <filesystem>

#include "datasets/truth/ground_truth.h"
#include "datasets/types/errors.h"

namespace fs = std::filesystem;

namespace sketchsplat {
namespace {

std::string prediction_of(const fs::path& folder, const std::string& name) {
  for (const std::string& file : {name, name + ".json", name + ".obj", name + ".ply",
                                  "record_" + name + "_stage2_cubic.json"}) {
    const std::string path = (folder / file).string();
    if (has_prediction(path)) return path;
  }
  return "";
}

}  // namespace

bool is_folder_of_scenes(const std::string& truth) {
  std::error_code none;
  return fs::is_directory(truth, none) && !has_ground_truth(truth);
}

std::vector<ScenePair> find_scenes(const std::string& predictions, const std::string& truth) {
  std::error_code none;
  if (!fs::is_directory(predictions, none)) {
    throw InputError(predictions, "a folder of results, one a scene", "none");
  }
  std::vector<ScenePair> scenes;
  for (const auto& entry : fs::directory_iterator(truth, none)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory(none) || !has_ground_truth(entry.path().string())) continue;
    scenes.push_back({name, entry.path().string(), prediction_of(predictions, name)});
  }
  const auto found = [](const ScenePair& scene) { return !scene.prediction.empty(); };
  if (!scenes.empty() && std::none_of(scenes.begin(), scenes.end(), found)) {
    throw InputError(predictions, "results called like the scenes in " + truth, "none");
  }
  if (scenes.empty()) {
    throw InputError(truth, "ground truth (gt/, groundtruth/, gt.json), or scenes that have it",
                     "none");
  }
  std::sort(scenes.begin(), scenes.end(),
            [](const ScenePair& a, const ScenePair& b) { return a.name < b.name; });
  return scenes;
}

SceneEvaluation evaluate_scene(const ScenePair& scene, const EvaluateOptions& options) {
  SceneEvaluation result;
  result.name = scene.name;
  result.missing = scene.prediction.empty();
  const Prediction prediction = result.missing ? Prediction() : read_prediction(scene.prediction);
  result.evaluation = evaluate(prediction, find_ground_truth(scene.truth), options);
  return result;
}

}  // namespace sketchsplat

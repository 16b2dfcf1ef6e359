// SPDX-License-Identifier: MIT
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "eval/metrics/evaluate.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/report.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/command/cli.h"
#include "pipelines/pages/overlay.h"
#include "pipelines/results/brep_plugin.h"

namespace fs = std::filesystem;

namespace sketchsplat {
namespace {

struct EvaluateArguments {
  std::string prediction, truth, solid, json, out;
  Missing missing = Missing::kZero;
  int overlays = 0;
  EvaluateOptions options;
};

bool on_stdout(const EvaluateArguments& arguments) { return arguments.json == "-"; }

// Missed edges in red, wrong strokes in blue. Polylines are cut finely: a part of them
// may lie behind the camera.
void write_worst(const Evaluation& evaluation, const std::string& folder, const std::string& out,
                 int count, Progress* progress) {
  std::vector<PaintedLine> lines;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  const auto add = [&](const std::vector<CurveScore>& curves, std::array<float, 3> color) {
    for (const CurveScore& curve : curves) {
      const double length = polyline_length(curve.polyline);
      lines.push_back({length > 0 ? resample(curve.polyline, length / 96) : curve.polyline, color});
      target += lines.back().points.rowwise().mean();
    }
  };
  add(evaluation.worst_strokes, {0.15f, 0.39f, 0.92f});
  add(evaluation.worst_edges, {0.86f, 0.15f, 0.15f});
  if (lines.empty()) return;
  target /= double(lines.size());
  write_overlays(out, "worst", lines, open_scene(folder).views, target, count,
                 [&](const std::string& text) { progress->warn(text); });
}

void check_usage(const EvaluateArguments& arguments) {
  if (arguments.overlays > 0 && arguments.out.empty()) {
    throw UsageError("--overlays needs --out, the folder to write them to");
  }
  if (!arguments.solid.empty() && is_folder_of_scenes(arguments.truth))
    throw UsageError("--solid is one solid, and --gt a folder of scenes");
  std::error_code none;
  if (arguments.overlays > 0 && fs::is_regular_file(arguments.truth, none)) {
    throw UsageError("--overlays needs the scene's folder as --gt, for its images");
  }
}

void write_files(const EvaluateArguments& arguments, const std::string& json,
                 const std::vector<SceneEvaluation>& scenes) {
  if (!arguments.json.empty() && !on_stdout(arguments)) write_text(arguments.json, json);
  if (arguments.out.empty()) return;
  write_text(arguments.out + "/evaluation.json", json);
  write_text(arguments.out + "/evaluation.csv", scenes_to_csv(scenes));
  write_text(arguments.out + "/strokes.csv", strokes_to_csv(scenes));
}

// The solid of a result folder, or of a file, against the part of a scene, if both are there.
std::optional<SolidComparison> compare_solids(const std::string& solid, const std::string& scene,
                                              Progress* progress) {
  const std::string part = scene + "/groundtruth/part.step";
  std::error_code none;
  if (!fs::exists(solid, none) || !fs::exists(part, none)) return std::nullopt;
  try {
    return brep_plugin().compare_solids(solid, part);
  } catch (const std::runtime_error& e) {
    progress->warn(e.what());
    return std::nullopt;
  }
}

void check_solid(const EvaluateArguments& arguments) {
  if (arguments.solid.empty()) return;
  const std::string part = arguments.truth + "/groundtruth/part.step";
  std::error_code none;
  for (const std::string& path : {arguments.solid, part})
    if (!fs::exists(path, none)) throw InputError(path, "a STEP file", "nothing");
}

void evaluate_one(const EvaluateArguments& arguments, Progress* progress) {
  SceneEvaluation scene;
  scene.name = fs::path(arguments.truth).lexically_normal().stem().string();
  scene.evaluation = evaluate(read_prediction(arguments.prediction),
                              find_ground_truth(arguments.truth), arguments.options);
  scene.evaluation.solid = compare_solids(
      arguments.solid.empty() ? arguments.prediction + "/solid.step" : arguments.solid,
      arguments.truth, progress);
  write_files(arguments, to_json(scene.evaluation), {scene});
  if (arguments.overlays > 0) {
    write_worst(scene.evaluation, arguments.truth, arguments.out, arguments.overlays, progress);
  }
  if (on_stdout(arguments))
    std::cout << to_json(scene.evaluation);
  else
    std::cout << to_table(scene.evaluation) << solid_row(scene.evaluation)
              << worst_curves(scene.evaluation);
}

void evaluate_folder(const EvaluateArguments& arguments, Progress* progress) {
  std::vector<SceneEvaluation> results;
  for (const ScenePair& scene : find_scenes(arguments.prediction, arguments.truth)) {
    if (scene.prediction.empty()) {
      const bool skip = arguments.missing == Missing::kSkip;
      progress->warn(scene.name + ": no prediction in " + arguments.prediction +
                     (skip ? ", left out" : ", counts as zero"));
      if (skip) continue;
    }
    results.push_back(evaluate_scene(scene, arguments.options));
    results.back().evaluation.solid =
        compare_solids(scene.prediction + "/solid.step", scene.truth, progress);
    if (arguments.overlays == 0) continue;
    const std::string out = arguments.out + "/" + scene.name;
    prepare_output_folder(out);
    write_worst(results.back().evaluation, scene.truth, out, arguments.overlays, progress);
  }
  write_files(arguments, scenes_to_json(results), results);
  std::cout << (on_stdout(arguments) ? scenes_to_json(results) : scenes_to_table(results));
}

void run_evaluate(const EvaluateArguments& arguments, Progress* progress) {
  check_usage(arguments);
  check_solid(arguments);
  if (!arguments.out.empty()) prepare_output_folder(arguments.out);
  if (is_folder_of_scenes(arguments.truth)) {
    evaluate_folder(arguments, progress);
  } else {
    evaluate_one(arguments, progress);
  }
}

}  // namespace

Verb evaluate_verb() {
  const auto arguments = std::make_shared<EvaluateArguments>();
  Fields f;
  f.group("Arguments");
  f.add("pred", &arguments->prediction, "DIR|FILE",
        "A result folder, or a .json, .obj or .ply; or a folder of these with the scenes' names")
      .required = true;
  f.add("gt", &arguments->truth, "SCENE|FILE|DIR",
        "A scene with ground truth, or the truth itself; or a folder of scenes")
      .required = true;
  f.choose("protocol", &arguments->options.protocol, {"sketchsplat", "emap", "curvegaussian"},
           "How predictions are sampled");
  f.add("solid", &arguments->solid, "FILE",
        "A STEP file to compare with the scene's part, instead of solid.step of the result");
  f.choose("missing", &arguments->missing, {"zero", "skip"},
           "Of several scenes, one without a result counts as zero or is skipped");
  f.add("json", &arguments->json, "FILE",
        "Write all numbers as JSON to this file; without FILE, only that to standard output")
      .value_optional = true;
  f.add("out", &arguments->out, "DIR",
        "Write evaluation.json, evaluation.csv, strokes.csv and overlays there");
  f.add("overlays", &arguments->overlays, "images", 0, 100,
        "Draw missed edges (red) and wrong curves (blue) over this many images");
  Verb verb;
  verb.name = "evaluate";
  verb.summary = "Compare curves with the ground truth";
  verb.examples = {"sketchsplat evaluate --pred out/part --gt scenes/part",
                   "sketchsplat evaluate --pred out --gt scenes --out numbers --overlays 3",
                   "sketchsplat evaluate --pred out/part/sketch.obj --gt scenes/part "
                   "--protocol emap --json numbers.json"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    if (common.json) arguments->json = "-";
    run_evaluate(*arguments, progress);
  };
  return verb;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>

#include "eval/evaluate.h"
#include "eval/report.h"
#include "pipelines/atomic_file.h"
#include "pipelines/cli.h"

namespace sketchsplat {
namespace {

struct EvaluateArguments {
  std::string prediction, truth, json;
  EvaluateOptions options;
};

void run_evaluate(const EvaluateArguments& arguments) {
  const Prediction prediction = read_prediction(arguments.prediction);
  const GroundTruth truth = find_ground_truth(arguments.truth);
  const Evaluation evaluation = evaluate(prediction, truth, arguments.options);
  if (!arguments.json.empty())
    write_atomically(arguments.json,
                     [&](std::ostream& out) { out << to_json(evaluation) << "\n"; });
  std::cout << to_table(evaluation);
}

}  // namespace

Verb evaluate_verb() {
  const auto arguments = std::make_shared<EvaluateArguments>();
  Fields f;
  f.group("Arguments");
  f.add("pred", &arguments->prediction, "DIR|FILE", "A result folder, or a .json, .obj or .ply")
      .required = true;
  f.add("gt", &arguments->truth, "SCENE|FILE", "A scene with ground truth, or the truth itself")
      .required = true;
  f.choose("protocol", &arguments->options.protocol, {"sketchsplat", "emap", "curvegaussian"},
           "Whose way of sampling predictions");
  f.add("json", &arguments->json, "FILE", "Write all numbers to this file, too");
  Verb verb;
  verb.name = "evaluate";
  verb.summary = "Compare edges with the ground truth";
  verb.examples = {"sketchsplat evaluate --pred out/part --gt scenes/part",
                   "sketchsplat evaluate --pred out/part/sketch.obj --gt scenes/part "
                   "--protocol emap --json numbers.json"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions&, Progress*) { run_evaluate(*arguments); };
  return verb;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>
#include <sstream>

#include "pipelines/bench/charts.h"
#include "pipelines/bench/run.h"
#include "pipelines/command/cli.h"

namespace sketchsplat {
namespace {

struct BenchArguments {
  std::string scenes;  // one a line
  std::string out, suite, scene_folder;
  std::string presets, detectors;
  std::string with;
  bool ablation = false;
  int repeats = 0;
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    if (!part.empty()) parts.push_back(part);
  return parts;
}

// "rounds=1,without=conics,close": what has no name of its own belongs to the value before it.
OptionTexts option_texts(const std::string& text) {
  OptionTexts options;
  for (const std::string& part : split(text, ',')) {
    const size_t equals = part.find('=');
    if (equals == std::string::npos) {
      if (options.empty()) throw UsageError("--with: expected NAME=VALUE, got '" + part + "'");
      options.back().second += "," + part;
      continue;
    }
    options.push_back({part.substr(0, equals), part.substr(equals + 1)});
  }
  return options;
}

// Wrong options are said before hours of work, not after.
Suite suite_of(const BenchArguments& arguments) {
  if (arguments.suite.empty() == arguments.scenes.empty())
    throw UsageError("bench needs either SCENES or --suite FILE");
  Suite suite = arguments.suite.empty() ? suite_of_folders(split(arguments.scenes, '\n'))
                                        : read_suite(arguments.suite);
  if (!arguments.presets.empty() || !arguments.detectors.empty()) {
    const std::vector<std::string> presets = split(arguments.presets, ','),
                                   detectors = split(arguments.detectors, ',');
    suite.variants = preset_variants(
        arguments.presets.empty() ? preset_names() : presets,
        arguments.detectors.empty() ? std::vector<std::string>{"image"} : detectors);
    if (suite.variants.empty())
      throw UsageError("--presets, --detectors: expected at least one of each");
  }
  if (arguments.ablation) suite.variants = ablation_variants_of(split(arguments.detectors, ','));
  if (arguments.repeats > 0) suite.repeats = arguments.repeats;
  check_suite_options(suite);
  Suite with;
  with.reconstruct = option_texts(arguments.with);
  check_suite_options(with);
  return suite;
}

// Every row and the means over the scenes, or of axes the means of each level.
std::string report(const std::vector<BenchRow>& runs, const Suite& suite) {
  std::vector<std::string> columns = {"F5", "F5_visible", "F2", "F1", "fine_F1", "acc"};
  std::vector<BenchRow> rows;
  if (suite.axes.empty()) {
    rows = runs;
    columns.insert(columns.end(), {"fine_F2", "comp", "structure_strokes", "peak_mb"});
  }
  columns.insert(columns.end(), {"structure_strokes_per_edge", "structure_f", "solid_right",
                                 "solid_wrong", "total", "cpu_seconds", "total_per_decode"});
  for (const BenchRow& mean : mean_rows(runs)) rows.push_back(mean);
  return bench_table(rows, columns);
}

void run_bench_verb(const BenchArguments& arguments, const CommonOptions& common,
                    Progress* progress) {
  BenchRun run;
  run.suite = suite_of(arguments);
  run.with = option_texts(arguments.with);
  run.with.insert(run.with.begin(), {"seed", std::to_string(common.seed)});
  run.out = arguments.out;
  run.scenes = arguments.scene_folder;
  run.threads = common.threads;
  const std::vector<BenchRow> rows = run_suite(run, progress);
  write_charts(run.out, progress);
  std::cout << (common.json ? bench_json(rows, run.suite) : report(rows, run.suite));
}

}  // namespace

Verb bench_verb() {
  const auto arguments = std::make_shared<BenchArguments>();
  Fields f;
  f.group("Arguments");
  Field& scenes = f.add("scenes", &arguments->scenes, "SCENES", "Scene folders with ground truth");
  scenes.positional = scenes.several = true;
  f.add("suite", &arguments->suite, "FILE",
        "A suite of scenes, parts to synthesize and what to vary, instead of SCENES");
  Field& out = f.add("out", &arguments->out, "DIR",
                     "The folder for tables and charts; its rows are not run again");
  out.required = true;
  out.short_name = "o";
  f.add("scene-folder", &arguments->scene_folder, "DIR",
        "Folder of synthesized scenes, which are reused; default: scenes/ in --out");
  f.group("What is run");
  f.add("presets", &arguments->presets, "NAMES",
        "Presets to compare, with commas between; default: those of the suite, or all");
  f.add("detectors", &arguments->detectors, "NAMES",
        "Detectors to compare, with commas between; default: those of the suite, or image");
  f.add("ablation", &arguments->ablation,
        "Leave out parts of the method in turn; with --detectors 2dgs-sn, compare its variants");
  f.add("with", &arguments->with, "NAME=VALUE,...", "Options of reconstruct for all runs");
  f.add("repeats", &arguments->repeats, "runs", 0, 1000,
        "Repeat each run N times; keep the fastest; 0: as the suite states, or once");
  Verb verb;
  verb.name = "bench";
  verb.summary = "Measure accuracy beside time, and where it breaks, with ground truth";
  verb.examples = {"sketchsplat bench scenes/* --out out/bench",
                   "sketchsplat bench --suite eval/suites/stability.yml --out out/stability",
                   "sketchsplat bench scenes/part --out out/ablation --ablation",
                   "sketchsplat bench scenes/part --out out/bench --presets fast --with "
                   "lift-views=10,rounds=2"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_bench_verb(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "pipelines/base/atomic_file.h"
#include "pipelines/bench/accuracy_chart.h"
#include "pipelines/bench/axis_report.h"
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

// A suite of the scenes on the command line.
Suite suite_of_scenes(const std::string& scenes) {
  Suite suite;
  suite.keep = true;
  for (const std::string& folder : split(scenes, '\n')) {
    const std::filesystem::path path = std::filesystem::path(folder + "/.").lexically_normal();
    const std::string stem = path.parent_path().filename();
    const auto taken = [&](const std::string& name) {
      for (const BenchScene& scene : suite.scenes)
        if (scene.name == name) return true;
      return false;
    };
    std::string name = stem;
    for (int k = 2; taken(name); ++k) name = stem + "_" + std::to_string(k);
    suite.scenes.push_back({name, folder, "", {}});
  }
  return suite;
}

// Wrong options are said before hours of work, not after.
Suite suite_of(const BenchArguments& arguments) {
  if (arguments.suite.empty() == arguments.scenes.empty())
    throw UsageError("bench needs either SCENES or --suite FILE");
  Suite suite =
      arguments.suite.empty() ? suite_of_scenes(arguments.scenes) : read_suite(arguments.suite);
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

void write_text(const std::string& path, const std::string& text) {
  write_atomically(path, [&](std::ostream& out) { out << text; });
}

// Results of one axis stand together.
template <typename Result, typename Draw>
void write_axis_charts(const std::vector<Result>& results, const std::string& folder, Draw draw) {
  for (size_t i = 0; i < results.size();) {
    std::vector<Result> axis;
    for (; i < results.size() && (axis.empty() || results[i].axis == axis[0].axis); ++i)
      axis.push_back(results[i]);
    write_chart(draw(axis), folder + "/" + axis[0].axis->name);
  }
}

std::string report_axes(const Suite& suite, const std::vector<BenchRow>& rows,
                        const std::string& out) {
  const std::vector<AxisResult> limits = axis_results(suite, rows);
  const std::vector<GrowthResult> growth = growth_results(suite, rows);
  std::string tables;
  if (!limits.empty()) {
    write_text(out + "/limits.md", limits_markdown(limits));
    write_text(out + "/limits.csv", limits_csv(limits));
    write_axis_charts(limits, out, axis_chart);
    tables += limits_markdown(limits);
  }
  if (!growth.empty()) {
    write_text(out + "/growth.md", growth_markdown(growth));
    write_text(out + "/growth.csv", growth_csv(growth));
    write_axis_charts(growth, out, growth_chart);
    tables += growth_markdown(growth);
  }
  return tables;
}

std::string report_scenes(const std::vector<BenchRow>& runs, const std::string& out,
                          bool ablation) {
  write_chart(accuracy_chart(runs), out + "/chart");
  const std::vector<BenchRow> means = mean_rows(runs);
  std::vector<BenchRow> rows = runs;
  rows.insert(rows.end(), means.begin(), means.end());
  std::vector<std::string> columns = {"F5", "F2", "F1", "fine_F2", "fine_F1", "acc", "comp"};
  const std::vector<std::string> rest =
      ablation ? std::vector<std::string>{"structure_strokes", "structure_strokes_per_edge",
                                          "structure_f", "total", "cpu_seconds"}
               : std::vector<std::string>{"structure_strokes_per_edge",
                                          "structure_f",
                                          "detect",
                                          "hull",
                                          "lift",
                                          "fit",
                                          "round",
                                          "polish",
                                          "write",
                                          "total",
                                          "total_per_decode",
                                          "peak_mb"};
  columns.insert(columns.end(), rest.begin(), rest.end());
  const std::string solids = solid_counts(runs);
  if (!solids.empty())
    columns.insert(columns.end(), {"solid_right", "solid_wrong", "solid_refused"});
  return bench_table(rows, columns) + (solids.empty() ? "" : "\n" + solids);
}

void run_bench_verb(const BenchArguments& arguments, const CommonOptions& common,
                    Progress* progress) {
  BenchRun run;
  run.suite = suite_of(arguments);
  if (arguments.suite.empty()) run.suite.seeds = {common.seed};
  run.with = option_texts(arguments.with);
  run.out = arguments.out;
  run.scenes = arguments.scene_folder;
  run.threads = common.threads;
  const std::vector<BenchRow> rows = run_suite(run, progress);
  const bool scenes = run.suite.axes.empty();
  const std::string tables = scenes ? report_scenes(rows, run.out, arguments.ablation)
                                    : report_axes(run.suite, rows, run.out);
  std::cout << (common.json ? bench_json(rows, run.suite.name) : tables);
}

}  // namespace

Verb bench_verb() {
  const auto arguments = std::make_shared<BenchArguments>();
  Fields f;
  f.group("Arguments");
  Field& scenes = f.add("scenes", &arguments->scenes, "SCENES", "Scene folders with ground truth");
  scenes.positional = scenes.several = true;
  f.add("suite", &arguments->suite, "FILE",
        "A list of scenes, parts to synthesize and what is varied, instead of SCENES");
  Field& out = f.add("out", &arguments->out, "DIR",
                     "The folder for tables and charts; rows that it holds are not run again");
  out.required = true;
  out.short_name = "o";
  f.add("scene-folder", &arguments->scene_folder, "DIR",
        "The folder of synthesized scenes, which are reused; if left out, scenes/ in --out");
  f.group("What is run");
  f.add("presets", &arguments->presets, "NAMES",
        "Presets to compare, with commas; if left out, those of the suite, or all");
  f.add("detectors", &arguments->detectors, "NAMES",
        "Detectors to compare, with commas; if left out, those of the suite, or image");
  f.add("ablation", &arguments->ablation,
        "Compare parts of the method instead of presets; with --detectors 2dgs-sn, parts of that");
  f.add("with", &arguments->with, "NAME=VALUE,...", "Options of reconstruct for all runs");
  f.add("repeats", &arguments->repeats, "runs", 0, 1000,
        "Of each; the fastest counts. 0 is what the suite says, or 1");
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

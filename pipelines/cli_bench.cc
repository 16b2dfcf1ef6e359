// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>
#include <sstream>

#include "pipelines/atomic_file.h"
#include "pipelines/bench.h"
#include "pipelines/bench_report.h"
#include "pipelines/cli.h"

namespace sketchsplat {
namespace {

struct BenchArguments {
  std::string scenes, out;  // scenes one a line
  std::string presets = "fast,balanced,accurate";
  std::string with;
  bool ablation = false;
  int repeats = 1;
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    if (!part.empty()) parts.push_back(part);
  return parts;
}

OptionTexts option_texts(const std::string& text) {
  OptionTexts options;
  for (const std::string& part : split(text, ',')) {
    const size_t equals = part.find('=');
    if (equals == std::string::npos)
      throw UsageError("--with: expected NAME=VALUE, got '" + part + "'");
    options.push_back({part.substr(0, equals), part.substr(equals + 1)});
  }
  return options;
}

// Wrong options are said before hours of work, not after.
void check_options(const BenchOptions& options) {
  for (const BenchVariant& variant : options.variants) {
    ReconstructOptions method;
    set_options(variant.options, &method);
    set_options(options.options, &method);
  }
  if (options.variants.empty()) throw UsageError("--presets: expected at least one");
}

void run_bench_verb(const BenchArguments& arguments, const CommonOptions& common,
                    Progress* progress) {
  BenchOptions options;
  options.scenes = split(arguments.scenes, '\n');
  options.variants =
      arguments.ablation ? ablation_variants() : preset_variants(split(arguments.presets, ','));
  options.options = option_texts(arguments.with);
  options.out = arguments.out;
  options.repeats = arguments.repeats;
  options.seed = common.seed;
  check_options(options);
  prepare_output_folder(arguments.out);

  std::vector<BenchRow> rows = run_bench(options, progress);
  const auto write = [&](const char* name, const std::string& text) {
    write_atomically(arguments.out + "/" + name, [&](std::ostream& out) { out << text; });
  };
  write("rows.csv", bench_csv(rows));
  write("rows.json", bench_json(rows, options.options));
  write("chart.svg", bench_chart(rows));
  const std::vector<BenchRow> means = mean_rows(rows);
  rows.insert(rows.end(), means.begin(), means.end());
  const std::vector<std::string> ablation_columns = {
      "F5",          "F2",    "F1", "fine_F1", "Acc", "Comp", "strokes", "strokes_per_edge",
      "structure_F", "total", "cpu"};
  std::cout << bench_table(rows,
                           arguments.ablation ? ablation_columns : std::vector<std::string>());
}

}  // namespace

Verb bench_verb() {
  const auto arguments = std::make_shared<BenchArguments>();
  Fields f;
  f.group("Arguments");
  Field& scenes = f.add("scenes", &arguments->scenes, "SCENES", "Scene folders with ground truth");
  scenes.required = scenes.positional = scenes.several = true;
  Field& out = f.add("out", &arguments->out, "DIR",
                     "The folder for rows.csv, rows.json, chart.svg and all results");
  out.required = true;
  out.short_name = "o";
  f.group("What is run");
  f.add("presets", &arguments->presets, "NAMES", "Presets to compare, with commas");
  f.add("ablation", &arguments->ablation, "Compare parts of the method instead of presets");
  f.add("with", &arguments->with, "NAME=VALUE,...", "Options of reconstruct for all runs");
  f.add("repeats", &arguments->repeats, "runs", 1, 1000, "Of each; the fastest counts");
  Verb verb;
  verb.name = "bench";
  verb.summary = "Measure accuracy beside time on scenes with ground truth";
  verb.examples = {"sketchsplat bench scenes/* --out out/bench",
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

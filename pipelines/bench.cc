// SPDX-License-Identifier: MIT
#include "pipelines/bench.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>

#include "datasets/errors.h"
#include "eval/evaluate.h"
#include "pipelines/atomic_file.h"
#include "pipelines/outputs.h"
#include "pipelines/reconstruct.h"

namespace sketchsplat {
namespace fs = std::filesystem;
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

// The peak counts per process; Linux starts it anew when asked. Where it does not, later runs
// report the largest of the runs so far.
void restart_peak_memory() {
  malloc_trim(0);  // what an earlier run left behind is not this run's
  std::ofstream("/proc/self/clear_refs") << 5;
}

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Seconds that one thread takes to read the images. The second pass counts: as for the runs that
// follow, the files are in the cache of the system.
double decode_seconds(const Scene& scene) {
  double seconds = 0;
  for (int pass = 0; pass < 2; ++pass) {
    const Clock::time_point began = Clock::now();
    for (const View& view : scene.views) {
      try {
        read_picture(view.image_path);
      } catch (const InputError&) {
        // the run itself warns of it
      }
    }
    seconds = seconds_since(began);
  }
  return seconds;
}

struct Run {
  Prediction prediction;  // empty if there was too little
  std::vector<StageReport> stages;
  double total = 0, cpu = 0, peak_mb = 0;
};

// All that `sketchsplat reconstruct` does, timed from opening the scene to the last file.
Run run_once(const std::string& folder, const ReconstructOptions& method, const std::string& out,
             Progress* progress) {
  Run run;
  restart_peak_memory();
  const Clock::time_point began = Clock::now();
  const double cpu_began = cpu_seconds();
  const Scene scene = open_scene(folder);
  prepare_output_folder(out);
  bool written = true;
  try {
    const Reconstruction result = reconstruct(scene, method, progress);
    const Clock::time_point writing = Clock::now();
    write_outputs(out, result, scene, method, OutputOptions(), progress);
    run.stages = result.report.stages;
    run.stages.push_back({"write", seconds_since(writing), 0, ""});
  } catch (const TooLittleError& e) {
    progress->warn(folder + ": " + e.what());
    written = false;
  }
  run.total = seconds_since(began);
  run.cpu = cpu_seconds() - cpu_began;
  run.peak_mb = peak_memory_mb();
  if (written) run.prediction = read_prediction(out);
  return run;
}

// Seconds of the stages whose name begins like this; "round" gathers all rounds.
double stage_seconds(const Run& run, const std::string& name) {
  double sum = 0;
  for (const StageReport& stage : run.stages)
    if (stage.name.rfind(name, 0) == 0) sum += stage.seconds;
  return sum;
}

Numbers numbers_of(const Run& run, const Evaluation& e, double decode) {
  const bool structure = e.has_curves && e.has_strokes;
  Numbers n;
  for (const int k : {2, 3, 4})  // levels 0 and 1 are 0.020 and 0.010
    n.push_back({"F" + std::to_string(k == 2 ? 5 : k == 3 ? 2 : 1), e.published.levels[k].f});
  n.push_back({"Acc", 1000 * e.published.accuracy});
  n.push_back({"Comp", 1000 * e.published.completeness});
  n.push_back({"fine_F5", e.fine.levels[0].f});
  n.push_back({"fine_F2", e.fine.levels[1].f});
  n.push_back({"fine_F1", e.fine.levels[2].f});
  n.push_back({"strokes", double(e.structure.strokes)});
  n.push_back(
      {"strokes_per_edge", structure ? double(e.structure.strokes) / e.structure.edges : kNone});
  n.push_back({"structure_F", structure ? e.structure.f : kNone});
  for (const char* stage : {"detect", "lift", "fit", "round", "polish", "write"})
    n.push_back({stage, stage_seconds(run, stage)});
  n.push_back({"total", run.total});
  n.push_back({"cpu", run.cpu});
  n.push_back({"decode", decode});
  n.push_back({"total_per_decode", decode > 0 ? run.total / decode : kNone});
  n.push_back({"peak_mb", run.peak_mb});
  return n;
}

std::string scene_name(const std::string& folder, const std::vector<BenchRow>& rows) {
  const std::string stem = fs::path(folder + "/.").lexically_normal().parent_path().filename();
  const auto taken = [&](const std::string& name) {
    return std::any_of(rows.begin(), rows.end(),
                       [&](const BenchRow& row) { return row.scene == name; });
  };
  std::string name = stem;
  for (int k = 2; taken(name); ++k) name = stem + "_" + std::to_string(k);
  return name;
}

std::string folder_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return text;
}

}  // namespace

std::vector<BenchVariant> preset_variants(const std::vector<std::string>& presets) {
  std::vector<BenchVariant> variants;
  for (const std::string& preset : presets) variants.push_back({preset, {{"preset", preset}}});
  return variants;
}

std::vector<BenchVariant> ablation_variants() {
  const std::pair<std::string, std::string> no_rounds = {"rounds", "0"}, no_steps = {"steps", "0"},
                                            no_topology = {"simplify", "false"},
                                            no_visibility = {"visibility", "false"},
                                            no_early = {"early-polish", "false"},
                                            no_final = {"final-polish", "false"};
  return {
      {"lift and fit only", {no_early, no_final, no_rounds}},
      {"+ raster rounds", {no_early, no_final, no_topology, no_visibility}},
      {"+ topology", {no_early, no_final, no_visibility}},
      {"+ visibility", {no_early, no_final}},
      {"+ final polish", {no_early}},
      {"+ polish in fit and rounds = all", {}},
      {"all but rounds", {no_rounds}},
      {"all but raster steps", {no_steps}},
      {"all but topology", {no_topology}},
      {"all but visibility", {no_visibility}},
      {"all but final polish", {no_final}},
  };
}

std::vector<BenchRow> run_bench(const BenchOptions& options, Progress* progress) {
  std::vector<BenchRow> rows;
  for (const std::string& folder : options.scenes) {
    const Scene scene = open_scene(folder);
    GroundTruth truth;
    try {
      truth = find_ground_truth(folder);
    } catch (const InputError& e) {
      progress->warn(std::string("left out: ") + e.what());
      continue;
    }
    const std::string name = scene_name(folder, rows);
    const double decode = decode_seconds(scene);
    for (const BenchVariant& variant : options.variants) {
      ReconstructOptions method;
      set_options(variant.options, &method);
      set_options(options.options, &method);
      method.seed = options.seed;
      progress->note(name + ", " + variant.name);
      const std::string out = options.out + "/" + name + "/" + folder_name(variant.name);
      Run best = run_once(folder, method, out, progress);
      for (int k = 1; k < options.repeats; ++k) {
        Run again = run_once(folder, method, out, progress);
        if (again.total < best.total) best = std::move(again);
      }
      rows.push_back(
          {name, variant.name, numbers_of(best, evaluate(best.prediction, truth), decode)});
    }
  }
  if (rows.empty()) throw InputError(options.scenes.at(0), "a scene with ground truth", "none");
  return rows;
}

std::vector<BenchRow> mean_rows(const std::vector<BenchRow>& rows) {
  std::vector<BenchRow> means;
  std::vector<std::vector<int>> counts;
  for (const BenchRow& row : rows) {
    size_t m = 0;
    while (m < means.size() && means[m].variant != row.variant) ++m;
    if (m == means.size()) {
      means.push_back({"mean", row.variant, row.numbers});
      for (auto& [name, value] : means[m].numbers) value = 0;
      counts.push_back(std::vector<int>(row.numbers.size()));
    }
    for (size_t i = 0; i < row.numbers.size(); ++i) {
      if (!std::isfinite(row.numbers[i].second)) continue;
      means[m].numbers[i].second += row.numbers[i].second;
      ++counts[m][i];
    }
  }
  for (size_t m = 0; m < means.size(); ++m)
    for (size_t i = 0; i < counts[m].size(); ++i)
      means[m].numbers[i].second = counts[m][i] ? means[m].numbers[i].second / counts[m][i] : kNone;
  return means;
}

}  // namespace sketchsplat

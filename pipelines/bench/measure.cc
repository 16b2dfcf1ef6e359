// SPDX-License-Identifier: MIT
#include "pipelines/bench/measure.h"

#include <omp.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "datasets/readers/scene.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/child.h"
#include "pipelines/base/hash.h"
#include "pipelines/base/version.h"
#include "pipelines/command/cli.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += word + "\n";
  return text;
}

std::string cpu_model() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos)
      return line.substr(colon + 2);
  }
  return "unknown";
}

// What tells a folder from an older one of the same name: its markers' sizes and times.
std::string identity_of_folder(const std::string& folder) {
  std::error_code none;
  std::string identity = fs::weakly_canonical(folder, none).string();
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (!entry.is_regular_file(none)) continue;
    const auto time = entry.last_write_time(none).time_since_epoch().count();
    identity += "\n" + entry.path().filename().string() + " " + std::to_string(time);
  }
  return identity;
}

// All numbers of an object; those of objects in it are called OUTER_INNER.
void add_numbers(const Json& object, const std::string& prefix, BenchRow* row) {
  for (const auto& [name, value] : object.items()) {
    if (value.is_number()) row->set(prefix + name, value.get<double>());
    if (value.is_null()) row->set(prefix + name, std::nan(""));
    if (value.is_object()) add_numbers(value, prefix + name + "_", row);
  }
}

// Seconds per stage; "round 1", "round 2" ... are one.
void add_stages(const Json& report, BenchRow* row) {
  for (const Json& stage : report.at("stages")) {
    std::string name = stage.at("name");
    while (!name.empty() &&
           (std::isdigit(static_cast<unsigned char>(name.back())) || name.back() == ' '))
      name.pop_back();
    const double before = row->number(name);
    row->set(name, stage.at("seconds").get<double>() + (std::isfinite(before) ? before : 0));
  }
}

double decode_seconds(const Scene& scene) {
  const auto began = std::chrono::steady_clock::now();
  for (const View& view : scene.views) {
    try {
      read_picture(view.image_path);
    } catch (const InputError&) {
      // the run itself warns of it
    }
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

// Failures that more runs would only repeat.
void check_environment(const ChildResult& child) {
  if (child.status == kNoOutput) throw OutputError("bench", child.last_words);
  if (child.status == kWrongUsage) throw UsageError(reason_of(child, 0));
}

// Threads are a matter of the run, not of the method.
int threads_of(const BenchJob& job, int otherwise) {
  for (const auto& [name, text] : job.reconstruct)
    if (name == "threads" && text != "0") return std::stoi(text);
  return otherwise;
}

std::vector<std::string> method_flags(const BenchJob& job, const std::vector<Field>& fields) {
  OptionTexts options;
  for (const auto& option : job.reconstruct)
    if (option.first != "threads") options.push_back(option);
  return flags_of(options, fields);
}

}  // namespace

OptionTexts machine_labels() {
  const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  return {{"version", program_version()},
          {"program", hash_of_file("/proc/self/exe")},
          {"cpu", cpu_model()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"memory", std::to_string(std::lround(bytes / 1e9)) + " GB"}};
}

Measurer::Measurer(const Settings& settings)
    : settings_(settings),
      machine_(machine_labels()),
      synthesize_(synthesize_verb()),
      reconstruct_(reconstruct_verb()),
      renderer_(hash_of_file(synthesis_plugin_path())) {
  if (settings_.threads <= 0) settings_.threads = omp_get_max_threads();
}

std::string Measurer::scene_folder(const BenchJob& job) const {
  if (!job.folder.empty()) return job.folder;
  std::string what = renderer_ + "\n" + joined(flags_of(job.synthesize, synthesize_.fields));
  for (const auto& [name, text] : job.synthesize)
    if (name == "part" && fs::exists(text)) what += hash_of_file(text);
  return settings_.scenes + "/" + hash_of(what);
}

std::string Measurer::key(const BenchJob& job) const {
  std::string what = joined(method_flags(job, reconstruct_.fields));
  for (const auto& [name, text] : machine_) what += name + " " + text + "\n";
  what += std::to_string(threads_of(job, settings_.threads)) + " " +
          std::to_string(settings_.repeats) + "\n";
  const std::string folder = scene_folder(job);
  return hash_of(what + (job.folder.empty() ? fs::path(folder).filename().string()
                                            : identity_of_folder(folder)));
}

bool Measurer::make_scene(const BenchJob& job, BenchRow* row) {
  const std::string folder = scene_folder(job);
  if (!job.folder.empty()) return true;
  for (const char* last : kLastFiles)
    if (fs::exists(folder + "/" + last)) return true;
  std::vector<std::string> arguments = {"synthesize", "--quiet", "--out", folder};
  const std::vector<std::string> flags = flags_of(job.synthesize, synthesize_.fields);
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  const ChildResult child = run_self(arguments, settings_.log, settings_.timeout_seconds);
  if (child.status == 0) return true;
  // A part may refuse a dimension: that is this scene's affair. A full disk is everybody's.
  if (child.status != kWrongUsage) check_environment(child);
  row->set("status", "no scene");
  row->set("reason", reason_of(child, settings_.timeout_seconds));
  return false;
}

bool Measurer::reconstruct(const BenchJob& job, const std::string& result, BenchRow* row) {
  std::vector<std::string> arguments = {"reconstruct", scene_folder(job), "--quiet", "--out",
                                        result};
  const std::vector<std::string> flags = method_flags(job, reconstruct_.fields);
  const int threads = threads_of(job, settings_.threads);
  arguments.insert(arguments.end(), {"--threads", std::to_string(threads)});
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  ChildResult best;
  Json report;
  for (int k = 0; k < settings_.repeats; ++k) {
    const ChildResult child = run_self(arguments, settings_.log, settings_.timeout_seconds);
    check_environment(child);
    if (k > 0 && child.status == 0 && child.seconds >= best.seconds) continue;
    best = child;
    if (child.status != 0) break;
    report = json_of_file(result + "/report.json");
  }
  row->set("status", std::to_string(best.status));
  if (best.status != 0) row->set("reason", reason_of(best, settings_.timeout_seconds));
  row->set("result", best.status == 0 ? hash_of_file(result + "/parametric_edges.json") : "");
  if (best.status == 0) {
    add_stages(report, row);
    row->set("peak_mb", report.at("peak_mb").get<double>());
    row->set("solid", report.at("solid").at("written").get<bool>() ? "written" : "refused");
  }
  row->set("total", best.seconds);
  row->set("cpu_seconds", best.cpu_seconds);
  return best.status == 0;
}

void Measurer::add_accuracy(const std::string& prediction, const std::string& truth,
                            BenchRow* row) {
  const std::string file = settings_.log + ".json";
  const ChildResult child =
      run_self({"evaluate", "--pred", prediction, "--gt", truth, "--json", file}, settings_.log,
               settings_.timeout_seconds);
  check_environment(child);
  if (child.status != 0) {
    row->set("reason", "evaluate: " + reason_of(child, settings_.timeout_seconds));
    return;
  }
  Json numbers = json_of_file(file);
  fs::remove(file);
  for (const char* no_number : {"protocol", "prediction", "ground_truth"}) numbers.erase(no_number);
  add_numbers(numbers, "", row);
}

// Of scenes whose part is known.
void Measurer::judge_solid(const std::string& truth, bool written, BenchRow* row) const {
  constexpr double kRight = 0.99;  // IoU of the volumes
  std::error_code none;
  if (!fs::exists(truth + "/groundtruth/part.step", none)) return;
  const bool right = written && row->number("solid_iou") >= kRight;
  row->set("solid_right", right);
  row->set("solid_wrong", written && !right);
  row->set("solid_refused", !written);
}

const Measurer::SceneFacts& Measurer::facts_of(const std::string& folder) {
  const auto known = facts_.find(folder);
  if (known != facts_.end()) return known->second;
  SceneFacts facts = {std::nan(""), std::nan(""), std::nan("")};
  try {
    const Scene scene = open_scene(folder);
    decode_seconds(scene);  // now the files are in the cache of the system, as for the runs
    facts = {decode_seconds(scene), double(scene.views.size()), 0};
    for (const View& view : scene.views)
      facts.pixels += double(view.camera.width) * view.camera.height;
  } catch (const InputError&) {
    // the run itself says so
  }
  return facts_[folder] = facts;
}

BenchRow Measurer::measure(const BenchJob& job, const std::string& result) {
  BenchRow row = {job.scene, job.variant, machine_, {}};
  row.set("threads", std::to_string(threads_of(job, settings_.threads)));
  for (const auto& [name, text] : job.reconstruct)
    if (name == "preset" || name == "detector" || name == "seed") row.set(name, text);
  row.set("options", [&] {
    std::string all;
    for (const std::string& word : method_flags(job, reconstruct_.fields))
      all += (all.empty() ? "" : " ") + word;
    return all;
  }());
  row.set("status", "");
  row.set("reason", "");
  if (!make_scene(job, &row)) return row;
  BenchRow run;
  const std::string folder = scene_folder(job);
  const bool done = reconstruct(job, result, &run);
  const std::string nothing = settings_.log + ".nothing.json";
  if (!done) {
    write_atomically(nothing, [](std::ostream& out) {
      out << R"({"lines_end_pts": [], "curves_ctl_pts": []})"
          << "\n";
    });
    for (const char* f : {"F20", "F10", "F5", "F2", "F1"}) row.set(f, 0.0);
  }
  add_accuracy(done ? result : nothing, folder, &row);
  if (!done) fs::remove(nothing);
  for (const auto& [name, text] : run.labels) row.set(name, text);
  for (const auto& [name, value] : run.numbers) row.set(name, value);
  judge_solid(folder, row.label("solid") == "written", &row);
  const SceneFacts& facts = facts_of(folder);
  row.set("decode", facts.decode);
  row.set("total_per_decode", row.number("total") / facts.decode);
  row.set("views", facts.views);
  row.set("pixels", facts.pixels);
  return row;
}

}  // namespace sketchsplat

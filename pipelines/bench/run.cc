// SPDX-License-Identifier: MIT
#include "pipelines/bench/run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "datasets/truth/ground_truth.h"
#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/bench/measure.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

constexpr double kCollapsedF5 = 20;  // an axis ends where no part is above [per cent]

std::string folder_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return !std::isalnum(c) && c != '-'; }, '_');
  return text;
}

bool same_place(const BenchRow& a, const BenchRow& b) {
  return a.scene == b.scene && a.variant == b.variant && a.label("axis") == b.label("axis") &&
         a.label("at") == b.label("at");
}

// The rows of a suite, those of an earlier call among them, and their files.
class Rows {
 public:
  explicit Rows(const BenchRun& run) : run_(run) {
    const BenchRow here = {"", "", machine_labels(), {}};
    for (BenchRow& row : read_bench_json(run.out + "/rows.json")) {
      const bool same = std::all_of(here.labels.begin(), here.labels.end(), [&](const auto& label) {
        return row.label(label.first) == label.second;
      });
      if (same && finished(row)) old_.push_back(std::move(row));
    }
  }
  // A run that was ended from outside may go better next time.
  static bool finished(const BenchRow& row) {
    const std::string status = row.label("status");
    return status == "no scene" || (!status.empty() && std::stoi(status) < 128);
  }
  const BenchRow* find(const std::string& key) const {
    for (const std::vector<BenchRow>* rows : {&rows_, &old_})
      for (const BenchRow& row : *rows)
        if (row.label("key") == key) return &row;
    return nullptr;
  }
  void add(const BenchRow& row) {
    rows_.push_back(row);
    old_.erase(std::remove_if(old_.begin(), old_.end(),
                              [&](const BenchRow& r) { return same_place(r, row); }),
               old_.end());
  }
  // `all`: the suite is done, and what is left of earlier rows is no part of it.
  void write(bool all) const {
    std::vector<BenchRow> rows = rows_;
    if (!all) rows.insert(rows.end(), old_.begin(), old_.end());
    write_atomically(run_.out + "/rows.json",
                     [&](std::ostream& out) { out << bench_json(rows, run_.suite); });
    write_atomically(run_.out + "/rows.csv", [&](std::ostream& out) { out << bench_csv(rows); });
  }
  const std::vector<BenchRow>& list() const { return rows_; }

 private:
  const BenchRun& run_;
  std::vector<BenchRow> rows_, old_;
};

void place(const BenchJob& job, BenchRow* row) {
  row->scene = job.scene;
  row->variant = job.variant;
  row->set("axis", job.axis ? job.axis->name : "");
  row->set("at", job.level);
  if (const auto level = level_number(job.level); job.axis && level) row->set("level", *level);
}

std::string result_folder(const BenchRun& run, const BenchJob& job) {
  if (!run.suite.keep) return run.out + "/running";
  std::string folder = run.out;
  if (job.axis) folder += "/" + folder_name(job.axis->name) + "/" + folder_name(job.level);
  return folder + "/" + job.scene + "/" + folder_name(job.variant);
}

// Runs the jobs of one level. Returns whether any of them still works.
bool run_level(const BenchRun& run, const BenchLevel& jobs, Measurer* measurer, Rows* rows,
               Stage* stage, Progress* progress) {
  bool works = false;
  for (const BenchJob& job : jobs) {
    const std::string key = measurer->key(job);
    BenchRow row;
    bool fresh = false;
    if (const BenchRow* known = rows->find(key)) {
      row = *known;
    } else {
      const std::string result = result_folder(run, job);
      row = measurer->measure(job, result);
      row.set("key", key);
      fresh = true;
      if (!run.suite.keep) fs::remove_all(result);
      if (!row.label("reason").empty())
        progress->warn(job.scene + ", " + job.variant +
                       (job.level.empty() ? "" : ", " + job.axis->name + " " + job.level) + ": " +
                       row.label("reason"));
    }
    place(job, &row);
    rows->add(row);
    if (fresh) rows->write(false);
    works |= row.number("F5") >= kCollapsedF5;
    stage->step();
  }
  return works;
}

void run_axis(const BenchRun& run, const BenchAxis* axis, Measurer* measurer, Rows* rows,
              Progress* progress) {
  const std::vector<BenchLevel> levels = plan_jobs(run.suite, axis, run.with);
  size_t total = 0;
  for (const BenchLevel& level : levels) total += level.size();
  Stage stage(axis ? axis->name : "runs", {nullptr, progress}, int(total));
  size_t done = 0;
  for (const BenchLevel& level : levels) {
    const bool works = run_level(run, level, measurer, rows, &stage, progress);
    done += level.size();
    if (!works && axis && axis->report == "drop") break;
  }
  stage.result(std::to_string(done) + " rows");
}

// Scenes without truth cannot be measured.
std::vector<BenchScene> with_truth(const std::vector<BenchScene>& scenes, Progress* progress) {
  std::vector<BenchScene> usable;
  for (const BenchScene& scene : scenes) {
    try {
      if (!scene.folder.empty()) find_ground_truth(scene.folder);
      usable.push_back(scene);
    } catch (const InputError& e) {
      progress->warn(std::string("left out: ") + e.what());
    }
  }
  if (usable.empty() && !scenes.empty())
    throw InputError(scenes[0].folder, "a scene with ground truth", "none");
  return usable;
}

}  // namespace

std::vector<BenchRow> run_suite(const BenchRun& given, Progress* progress) {
  BenchRun run = given;
  run.suite.scenes = with_truth(run.suite.scenes, progress);
  for (BenchAxis& axis : run.suite.axes) axis.scenes = with_truth(axis.scenes, progress);
  prepare_output_folder(run.out);
  Measurer::Settings settings;
  settings.scenes = run.scenes.empty() ? run.out + "/scenes" : run.scenes;
  settings.log = run.out + "/running.log";
  settings.threads = run.threads;
  settings.repeats = run.suite.repeats;
  settings.timeout_seconds = run.suite.timeout_seconds;
  Measurer measurer(settings);
  Rows rows(run);
  if (run.suite.axes.empty()) run_axis(run, nullptr, &measurer, &rows, progress);
  for (const BenchAxis& axis : run.suite.axes) run_axis(run, &axis, &measurer, &rows, progress);
  rows.write(true);
  return rows.list();
}

}  // namespace sketchsplat

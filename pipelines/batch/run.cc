// SPDX-License-Identifier: MIT
#include "pipelines/batch/run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <ctime>
#include <list>
#include <memory>

#include "datasets/types/errors.h"
#include "pipelines/base/hash.h"
#include "pipelines/base/resources.h"
#include "pipelines/base/version.h"
#include "pipelines/batch/scene_input.h"
#include "pipelines/batch/worker.h"
#include "pipelines/bench/plan.h"
#include "pipelines/method/estimate.h"

namespace sketchsplat {
namespace {

constexpr double kMemoryShare = 0.9;  // of what is available
constexpr double kTickSeconds = 10;   // between looks at workers, if nothing happens

void list_all(ReconstructOptions* method, OutputOptions* output, Fields* fields) {
  fields->add("seed", &method->seed, "", 0, HUGE_VAL, "");
  list_fields(method, fields);
  list_fields(output, fields);
}

// The names, one a line, as --like takes names that lie in this folder.
std::string joined_to(const std::string& folder, const std::string& names) {
  std::string paths = folder + "/./";
  for (const char c : names) paths += c == '\n' ? "\n" + folder + "/./" : std::string(1, c);
  return paths;
}

// The options of reconstruct that differ from what the preset says, as a command line.
std::vector<std::string> worker_flags(const BatchRun& run) {
  ReconstructOptions method = run.method, preset;
  OutputOptions output = run.output, usual;
  apply_preset(method.preset, &preset);
  if (!method.like_folder.empty()) method.like = joined_to(method.like_folder, method.like);
  Fields wanted, known;
  list_all(&method, &output, &wanted);
  list_all(&preset, &usual, &known);
  OptionTexts texts = {{"preset", method.preset}};
  for (size_t i = 0; i < wanted.list.size(); ++i)
    if (text_of(wanted.list[i]) != text_of(known.list[i]))
      texts.push_back({wanted.list[i].name, text_of(wanted.list[i])});
  std::vector<std::string> flags = flags_of(texts, wanted.list);
  if (!run.open.format.empty()) flags.insert(flags.end(), {"--format", run.open.format});
  if (run.open.allow_outside) flags.push_back("--allow-outside");
  flags.insert(flags.end(), {"--threads", std::to_string(run.threads)});
  return flags;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc = {};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string host_name() {
  char name[65] = {};
  gethostname(name, sizeof name - 1);
  return name;
}

// While it lives, SIGCHLD and the signals by which people and systems end programs are kept until
// somebody asks for them: they cannot strike in the middle of anything. Of a program with one
// thread at that time.
class KeptSignals {
 public:
  KeptSignals() {
    std::signal(SIGCHLD, SIG_DFL);  // whoever started us may have had it ignored
    sigemptyset(&kept_);
    for (const int number : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) sigaddset(&kept_, number);
    pthread_sigmask(SIG_BLOCK, &kept_, &before_);
  }
  ~KeptSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  // Waits for one, at most so long; its number, or 0.
  int wait(double seconds) const {
    const double whole = std::floor(std::max(0.0, seconds));
    const timespec time = {std::time_t(whole), long((seconds - whole) * 1e9)};
    return std::max(0, sigtimedwait(&kept_, nullptr, &time));
  }

 private:
  sigset_t kept_, before_;
};

// Starts workers, looks after them, and writes down how they ended.
class Coordinator {
 public:
  Coordinator(const BatchGroup& group, const BatchStore& store, Progress* progress)
      : scenes_(group.scenes),
        plan_(plan_batch(group, progress)),
        store_(store),
        progress_(progress),
        schedule_(plan_.loads, plan_.jobs, plan_.memory_mb),
        settings_{worker_flags(group.run), group.run.memory_mb, group.run.timeout_seconds},
        retries_(group.run.retries),
        attempts_(plan_.open.size()) {
    for (const Load& load : plan_.loads) all_seconds_ += load.seconds;
  }

  // Nothing half done stays, whatever ends us.
  ~Coordinator() {
    for (Work& work : workers_) {
      work.worker.reset();
      try {
        store_.forget_running(scene(work.piece).scene.name);
      } catch (const std::exception&) {
        // the next batch will
      }
    }
  }

  void work() {
    KeptSignals signals;
    Stage stage("batch", {nullptr, progress_}, int(plan_.open.size()));
    for (;;) {
      start_what_fits();
      if (workers_.empty()) break;
      const int signal = signals.wait(pause());
      if (signal != 0 && signal != SIGCHLD) interrupt(signal);
      while (look_after_workers(&stage)) start_what_fits();
    }
    stage.result(std::to_string(plan_.open.size() - failed_) + " scenes" +
                 (failed_ > 0 ? ", " + std::to_string(failed_) + " failed" : ""));
  }

 private:
  struct Work {
    int piece;  // of plan.open
    std::unique_ptr<SceneWorker> worker;
  };

  const PlannedScene& scene(int piece) const { return scenes_[plan_.open[piece]]; }

  void start_what_fits() {
    for (int piece; (piece = schedule_.next()) >= 0;) {
      workers_.push_back({piece, nullptr});
      ++attempts_[piece];
      workers_.back().worker =
          std::make_unique<SceneWorker>(scene(piece).scene, scene(piece).key, settings_, store_);
    }
  }

  // Until somebody takes too long.
  double pause() const {
    double seconds = kTickSeconds;
    if (settings_.timeout_seconds > 0)
      for (const Work& work : workers_)
        seconds = std::min(seconds, settings_.timeout_seconds - work.worker->seconds());
    return seconds;
  }

  // Whether one of them has ended.
  bool look_after_workers(Stage* stage) {
    for (auto work = workers_.begin(); work != workers_.end(); ++work) {
      if (!work->worker->advance()) continue;
      const int piece = work->piece;
      const std::unique_ptr<SceneWorker> worker = std::move(work->worker);
      workers_.erase(work);
      schedule_.ended(piece, worker->run().peak_mb);
      if (worker->was_struck() && attempts_[piece] <= retries_)
        schedule_.again(piece);
      else
        write_down(piece, worker->run(), stage);
      return true;
    }
    return false;
  }

  void write_down(int piece, RunRecord record, Stage* stage) {
    const std::string& name = scene(piece).scene.name;
    record.key = scene(piece).key;
    record.attempts = attempts_[piece];
    record.host = host_name();
    record.ended = utc_now();
    store_.write(record, name);
    ++ended_;
    done_seconds_ += plan_.loads[piece].seconds;
    if (all_seconds_ > 0) progress_->share(done_seconds_ / all_seconds_);
    stage->step();
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.1f s", record.seconds);
    if (record.status == 0)
      progress_->info("[" + std::to_string(ended_) + "/" + std::to_string(plan_.open.size()) +
                      "] " + name + ": " + seconds);
    else
      progress_->warn(name + ": " + record.reason);
    failed_ += record.status != 0;
  }

  [[noreturn]] void interrupt(int signal) {
    throw Interrupted(signal, "interrupted: " + std::to_string(ended_ - failed_) + " of " +
                                  std::to_string(plan_.open.size()) +
                                  " scenes were done; the same command does the rest");
  }

  const std::vector<PlannedScene>& scenes_;
  const BatchPlan plan_;
  const BatchStore& store_;
  Progress* progress_;
  Schedule schedule_;
  const WorkerSettings settings_;
  const int retries_;
  std::vector<int> attempts_;
  std::list<Work> workers_;
  int ended_ = 0, failed_ = 0;
  double all_seconds_ = 0, done_seconds_ = 0;
};

// What decides a scene's result beside its input.
std::string program_text(const BatchRun& run) {
  return program_version() + "\n" + program_commit() + "\n" + run.open.format +
         (run.open.allow_outside ? " and beyond\n" : "\n") + batch_options_json(run);
}

}  // namespace

std::string batch_options_json(const BatchRun& run) {
  ReconstructOptions method = run.method;
  OutputOptions output = run.output;
  Fields fields;
  list_all(&method, &output, &fields);
  return fields_json(fields.list);
}

std::vector<PlannedScene> plan_scenes(const std::vector<BatchScene>& scenes, const BatchRun& run) {
  const std::string program = program_text(run);
  std::vector<PlannedScene> planned;
  for (const BatchScene& scene : scenes) {
    SceneKey key = {hash_of(program), input_hash(scene.folder)};
    // A truth may lie elsewhere; one that comes later is worth another run.
    if (!key.input.empty() && has_truth(scene.folder)) key.input += "+truth";
    planned.push_back({scene, key});
  }
  return planned;
}

std::vector<BatchGroup> batch_groups(const std::vector<PlannedScene>& scenes, const BatchRun& run) {
  if (run.family == 0) return {{scenes, run}};
  const auto middle = scenes.begin() + std::min(scenes.size(), size_t(run.family));
  BatchGroup first = {{scenes.begin(), middle}, run}, rest = {{middle, scenes.end()}, run};
  rest.run.method.like_folder = run.out;
  std::string siblings;
  for (const PlannedScene& s : first.scenes) {
    const std::string folder = run.out + "/" + s.scene.name;
    if (!is_done(folder, s.key)) continue;
    rest.run.method.like += (siblings.empty() ? "" : "\n") + s.scene.name;
    siblings += hash_of_file(folder + "/sketch.json") + "\n";
  }
  if (siblings.empty()) return {first, {rest.scenes, run}};  // cold, as they are keyed
  for (PlannedScene& s : rest.scenes) s.key.program = hash_of(program_text(rest.run) + siblings);
  return {first, rest};
}

BatchPlan plan_batch(const BatchGroup& group, Progress* progress) {
  const BatchRun& run = group.run;
  const int count = int(group.scenes.size());
  BatchPlan plan;
  for (int i = 0; i < count; ++i)
    if (run.force || !is_done(run.out + "/" + group.scenes[i].scene.name, group.scenes[i].key))
      plan.open.push_back(i);
  const int open = int(plan.open.size());
  if (open == 0) return plan;
  Stage stage("look", {nullptr, progress}, open);
  for (const int i : plan.open) {
    const SceneSize size = scene_size(group.scenes[i].scene.folder, run.open);
    plan.loads.push_back(expected_load(size.views, size.pixels, run.method, run.threads));
    stage.step();
  }
  plan.jobs = std::min(open, run.jobs > 0 ? run.jobs : std::max(1, usable_cores() / run.threads));
  plan.memory_mb = run.jobs > 0 ? HUGE_VAL : kMemoryShare * usable_memory_mb();
  stage.result(std::to_string(open) + " of " + std::to_string(count) + " scenes to do, " +
               std::to_string(plan.jobs) + " at a time");
  return plan;
}

void run_batch(const BatchGroup& group, const BatchStore& store, Progress* progress) {
  for (const PlannedScene& scene : group.scenes) store.check_place(scene.scene.name);
  Coordinator(group, store, progress).work();
}

}  // namespace sketchsplat

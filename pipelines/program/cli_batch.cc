// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pipelines/batch/run.h"
#include "pipelines/command/cli.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

struct BatchArguments {
  std::string roots, match;  // one a line
  std::string list, shard;
  bool merge = false, dry_run = false;
  BatchRun run;
};

Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  char slash = 0;
  std::istringstream in(text);
  in >> shard.index >> slash >> shard.count;
  if (!in || !in.eof() || slash != '/' || shard.index < 1 || shard.index > shard.count)
    throw UsageError("--shard: expected I/N with I from 1 to N, got '" + text + "'");
  return shard;
}

void check_usage(const BatchArguments& arguments) {
  if (arguments.roots.empty() && arguments.list.empty())
    throw UsageError("batch needs ROOT or --list FILE");
  if (arguments.merge && !arguments.shard.empty())
    throw UsageError("--merge is for all shards: leave --shard out");
  if (arguments.run.family > 0 && !arguments.shard.empty())
    throw UsageError(
        "--family is for a whole batch: reconstruct its first scenes, then give all "
        "shards --like");
  if (arguments.run.family > 0 && !arguments.run.method.like.empty())
    throw UsageError("--family and --like name siblings: one of them, please");
}

std::vector<BatchScene> scenes_of(const BatchArguments& arguments, Progress* progress) {
  SceneSearch search;
  search.roots = lines_of(arguments.roots);
  if (!arguments.list.empty()) search.list = read_scene_list(arguments.list);
  search.match = lines_of(arguments.match);
  search.format = arguments.run.open.format;
  search.out = arguments.run.out;
  std::vector<std::string> warnings;
  std::vector<BatchScene> mine;
  for (const BatchScene& scene : find_scene_folders(search, &warnings))
    if (in_shard(scene.name, arguments.run.shard.index, arguments.run.shard.count))
      mine.push_back(scene);
  for (const std::string& warning : warnings) progress->warn(warning);
  return mine;
}

// What is to do, roughly how long it takes, and how much memory.
void print_plan(const std::vector<BatchGroup>& groups, bool json, Progress* progress) {
  Json open = Json::array();
  double seconds = 0, largest_mb = 0;
  size_t scenes = 0;
  int jobs = 1;
  for (const BatchGroup& group : groups) {
    const BatchPlan plan = plan_batch(group, progress);
    double sum = 0, longest = 0;
    for (const Load& load : plan.loads) {
      sum += load.seconds;
      longest = std::max(longest, load.seconds);
      largest_mb = std::max(largest_mb, load.memory_mb);
    }
    seconds += std::max(longest, sum / plan.jobs);
    jobs = std::max(jobs, plan.jobs);
    scenes += group.scenes.size();
    for (const int i : plan.open) open.push_back(group.scenes[i].scene.folder);
  }
  if (json) {
    print_json(Json{{"scenes", scenes},
                    {"done", scenes - open.size()},
                    {"jobs", jobs},
                    {"expected_seconds", std::round(seconds)},
                    {"largest_mb", std::round(largest_mb)},
                    {"open", open}});
    return;
  }
  for (const auto& folder : open) std::cout << folder.get<std::string>() << "\n";
  std::cout << scenes << " scenes, " << scenes - open.size() << " done, " << open.size()
            << " to do";
  if (!open.empty())
    std::cout << ": " << jobs << " at a time, roughly " << rough_duration(seconds) << " and up to "
              << std::lround(largest_mb) << " MB each";
  std::cout << "\n";
}

// The names of the scenes that are not done, some of them.
std::string names_of(const std::vector<SceneRow>& rows, SceneRow::State state) {
  constexpr int kMost = 10;
  std::string names;
  int n = 0;
  for (const SceneRow& row : rows)
    if (row.state == state && n++ < kMost) names += (names.empty() ? "" : ", ") + row.scene;
  return n > kMost ? names + " and " + std::to_string(n - kMost) + " more" : names;
}

// What is there now: files, unless others write them too; and the rows.
std::vector<SceneRow> sum_up(const std::vector<PlannedScene>& scenes, const BatchRun& run,
                             const BatchStore& store) {
  std::vector<SceneRow> rows;
  for (const BatchGroup& group : batch_groups(scenes, run))
    for (const PlannedScene& scene : group.scenes)
      rows.push_back(scene_row(scene.scene, scene.key, store));
  sort_rows(&rows);
  if (run.shard.count > 1) return rows;
  const std::string options = batch_options_json(run);
  store.write_file("summary.csv", [&](std::ostream& out) { write_summary_csv(out, rows); });
  store.write_file("summary.json",
                   [&](std::ostream& out) { write_summary_json(out, rows, options); });
  store.write_file("index.html",
                   [&](std::ostream& out) { write_summary_html(out, rows, options); });
  store.write_file(".batch/timings.csv",
                   [&](std::ostream& out) { write_timings_csv(out, rows, store); });
  return rows;
}

void print_rows(const std::vector<SceneRow>& rows, const BatchRun& run, bool json) {
  const int done = count_rows(rows, SceneRow::State::kDone);
  const int failed = count_rows(rows, SceneRow::State::kFailed);
  const int open = int(rows.size()) - done - failed;
  if (json) {
    write_summary_json(std::cout, rows, batch_options_json(run));
  } else {
    std::cout << run.out << ": " << done << " of " << rows.size() << " scenes done";
    if (run.shard.count > 1)
      std::cout << " in shard " << run.shard.index << "/" << run.shard.count
                << "; --merge writes the summary of all\n";
    else
      std::cout << "\n" << run.out << "/index.html: to look at\n";
  }
  if (failed + open == 0) return;
  std::string text;
  if (failed > 0)
    text = std::to_string(failed) + " of " + std::to_string(rows.size()) +
           " scenes failed: " + names_of(rows, SceneRow::State::kFailed);
  if (open > 0)
    text += std::string(text.empty() ? "" : "; ") + std::to_string(open) +
            " are open: " + names_of(rows, SceneRow::State::kOpen);
  throw SomeFailedError(text);
}

void run_batch_verb(BatchArguments arguments, const CommonOptions& common, Progress* progress) {
  check_usage(arguments);
  BatchRun& run = arguments.run;
  run.method.seed = common.seed;
  run.threads = std::max(1, common.threads);
  run.shard = shard_of(arguments.shard);
  const std::vector<PlannedScene> scenes = plan_scenes(scenes_of(arguments, progress), run);
  if (arguments.dry_run) {
    print_plan(batch_groups(scenes, run), common.json, progress);
    return;
  }
  const BatchStore store(run.out, run.shard);
  try {
    // The second group is made again: it is keyed by what the first came to.
    const size_t groups = arguments.merge ? 0 : batch_groups(scenes, run).size();
    for (size_t i = 0; i < groups; ++i) run_batch(batch_groups(scenes, run)[i], store, progress);
  } catch (const Interrupted&) {
    sum_up(scenes, run, store);
    throw;
  }
  print_rows(sum_up(scenes, run, store), run, common.json);
}

void list_run_fields(BatchArguments* a, Fields* f) {
  f->group("Running");
  f->add("jobs", &a->run.jobs, "scenes", 0, 4096,
         "Scenes at a time, with --threads each (default 1); 0: what cores and memory allow");
  f->add("timeout", &a->run.timeout_seconds, "s", 0, 1e7,
         "Stop a scene that takes longer; 0: never");
  f->add("memory", &a->run.memory_mb, "MB", 0, 1e9,
         "Limit of the address space of a scene; 0: none");
  f->add("retries", &a->run.retries, "times", 0, 100,
         "Retries of a scene that another process killed, perhaps for lack of memory");
  f->add("family", &a->run.family, "scenes", 0, 1000,
         "Reconstruct this many scenes first, by name, and start all others from them (--like)");
  f->add("force", &a->run.force, "Repeat scenes that are done");
  f->add("shard", &a->shard, "I/N",
         "Only the I-th of N shares of the scenes, by hashes of their names");
  f->add("merge", &a->merge, "Only write the summary of all shards");
  f->add("dry-run", &a->dry_run, "Only print what is to be done, and the expected time and memory");
}

}  // namespace

Verb batch_verb() {
  const auto arguments = std::make_shared<BatchArguments>();
  arguments->run.output.reproducible = true;
  Fields f;
  f.group("Arguments");
  Field& roots = f.add("roots", &arguments->roots, "ROOT",
                       "Reconstruct every scene folder in or below this folder");
  roots.positional = roots.several = true;
  Field& out =
      f.add("out", &arguments->run.out, "DIR",
            "The folder for results, one folder a scene; scenes that are done are not repeated");
  out.required = true;
  out.short_name = "o";
  f.add("list", &arguments->list, "FILE", "More scene folders, one a line; - is standard input");
  f.add("match", &arguments->match, "GLOB",
        "Only scenes whose name, or its last part, matches; may be repeated")
      .several = true;
  list_open_fields(&arguments->run.open, &f);
  list_run_fields(arguments.get(), &f);
  list_fields(&arguments->run.method, &f);
  list_fields(&arguments->run.output, &f);
  Verb verb;
  verb.name = "batch";
  verb.summary = "Reconstruct every scene below a folder, and go on where it was interrupted";
  verb.examples = {"sketchsplat batch scenes --out results",
                   "sketchsplat batch scenes --out results --match '0000*' --preset fast --jobs 8",
                   "sketchsplat batch --list scenes.txt --out results --shard 3/16",
                   "sketchsplat batch --list scenes.txt --out results --merge"};
  verb.fields = f.list;
  verb.run = [arguments](const CommonOptions& common, Progress* progress) {
    run_batch_verb(*arguments, common, progress);
  };
  return verb;
}

}  // namespace sketchsplat

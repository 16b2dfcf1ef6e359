// SPDX-License-Identifier: MIT
#include "pipelines/batch/worker.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "datasets/types/errors.h"
#include "pipelines/batch/scene_input.h"
#include "pipelines/command/cli.h"

namespace sketchsplat {
namespace {

// A folder that begins with a dash must not be taken for an option.
std::string as_argument(const std::string& folder) {
  return folder[0] == '-' ? "./" + folder : folder;
}

// An output error that no other scene would escape.
bool is_everybodys(const std::string& words) {
  for (const int error : {ENOSPC, EDQUOT, EROFS, EIO, EMFILE, ENFILE})
    if (words.find(std::strerror(error)) != std::string::npos) return true;
  return false;
}

// A signal that processes do not give themselves.
bool was_sent(int status) {
  return status == 128 + SIGKILL || status == 128 + SIGTERM || status == 128 + SIGINT ||
         status == 128 + SIGHUP;
}

}  // namespace

SceneWorker::SceneWorker(const BatchScene& scene, const SceneKey& key,
                         const WorkerSettings& settings, const BatchStore& store)
    : scene_(scene), key_(key), settings_(settings), store_(store) {
  store_.begin(scene_.name);
  std::vector<std::string> arguments = {"reconstruct", as_argument(scene_.folder), "--out",
                                        store_.running(scene_.name)};
  arguments.insert(arguments.end(), settings_.flags.begin(), settings_.flags.end());
  start(arguments);
}

void SceneWorker::start(const std::vector<std::string>& arguments) {
  child_ = std::make_unique<Child>(arguments, note((arguments[0] + ".log").c_str()),
                                   settings_.memory_mb);
}

double SceneWorker::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

bool SceneWorker::advance() {
  if (!child_->ended()) {
    if (settings_.timeout_seconds <= 0 || seconds() < settings_.timeout_seconds) return false;
    timed_out_ = true;
    child_->kill();
    child_->wait();
  }
  ChildResult result = child_->result();
  result.timed_out = timed_out_ && result.status != 0;
  run_.cpu_seconds += result.cpu_seconds;
  run_.peak_mb = std::max(run_.peak_mb, result.peak_mb);
  run_.seconds = seconds();
  // An evaluation that was struck gets a score at another attempt.
  const bool only_no_score = evaluating_ && (timed_out_ || !was_sent(result.status));
  if (result.status != 0 && !only_no_score) {
    fail(result);
  } else if (evaluating_) {
    const bool scored = result.status == 0;
    finish(scored, scored ? "" : "no score: " + reason_of(result, settings_.timeout_seconds));
  } else if (has_truth(scene_.folder)) {
    evaluating_ = true;
    start({"evaluate", "--pred", store_.running(scene_.name), "--gt", as_argument(scene_.folder),
           "--json", note("evaluation.json"), "--quiet"});
    return false;
  } else {
    finish(false, "");
  }
  return true;
}

bool SceneWorker::was_struck() const { return was_sent(run_.status) && !timed_out_; }

void SceneWorker::finish(bool scored, const std::string& complaint) {
  const std::string folder = store_.running(scene_.name);
  try {
    SceneRecord record = make_record(folder, scored ? note("evaluation.json") : "");
    record.key = key_;
    record.note = complaint;
    write_record(folder, record);
  } catch (const InputError& e) {
    ChildResult defect;
    defect.status = kDefect;
    defect.last_words = e.what();
    fail(defect);
    return;
  }
  store_.publish(scene_.name);
  std::remove(note("reconstruct.log").c_str());
  std::remove(note("evaluation.json").c_str());
  if (complaint.empty()) std::remove(note("evaluate.log").c_str());
}

void SceneWorker::fail(const ChildResult& result) {
  run_.status = result.status;
  run_.reason = reason_of(result, settings_.timeout_seconds);
  if (result.status == kNoOutput && is_everybodys(run_.reason))
    throw OutputError(store_.result(scene_.name), run_.reason);
  store_.withdraw(scene_.name);
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/batch/store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

void check(const std::error_code& error, const std::string& path) {
  if (error) throw OutputError(path, error.message());
}

void make_folders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  check(error, folder.string());
}

// Removes the folders between `root` and what was in it, as far as they are empty.
void remove_empty(const fs::path& root, const fs::path& name) {
  std::error_code error;
  for (fs::path above = name.parent_path(); !above.empty(); above = above.parent_path())
    if (!fs::remove(root / above, error)) return;
}

// Whoever holds the lock has written its name into it.
std::string holder(int file) {
  char text[128] = {};
  const ssize_t n = pread(file, text, sizeof text - 1, 0);
  return n > 0 ? " (" + std::string(text, size_t(n)) + ")" : "";
}

std::string own_name() {
  char host[65] = {};
  gethostname(host, sizeof host - 1);
  return "process " + std::to_string(getpid()) + " on " + host;
}

std::string shard_lock(int index, int count) {
  return "lock." + std::to_string(index) + "-of-" + std::to_string(count);
}

}  // namespace

BatchStore::BatchStore(const std::string& out, const Shard& shard) : out_(out), shard_(shard) {
  prepare_output_folder(own(""));
  const bool shared = shard.count > 1;
  lock("lock", shared);
  if (shared) {
    lock(shard_lock(shard.index, shard.count), false);
    refuse_other_counts(shard.count);
  } else {
    // Nobody else is here: what is left was left by a batch that was ended.
    std::error_code error;
    fs::remove_all(own("running"), error);
    check(error, own("running"));
    fs::remove_all(own("trash"), error);
    check(error, own("trash"));
  }
}

BatchStore::~BatchStore() {
  for (const int file : locks_) close(file);
}

void BatchStore::lock(const std::string& name, bool shared) {
  const int file = open(own(name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) throw OutputError(own(name), std::strerror(errno));
  locks_.push_back(file);
  if (flock(file, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) throw OutputError(own(name), std::strerror(errno));
    throw OutputError(out_, "another batch at work there" + holder(file));
  }
  const std::string text = shared ? "" : own_name();  // an older name would be a wrong one
  if (ftruncate(file, 0) != 0 || pwrite(file, text.data(), text.size(), 0) != ssize_t(text.size()))
    throw OutputError(own(name), std::strerror(errno));
}

// Shards of 1/2 and of 1/3 would work on the same scenes.
void BatchStore::refuse_other_counts(int count) const {
  const std::string ours = "-of-" + std::to_string(count);
  for (const fs::directory_entry& entry : fs::directory_iterator(own(""))) {
    const std::string name = entry.path().filename().string();
    const size_t at = name.find("-of-");
    if (name.rfind("lock.", 0) != 0 || at == std::string::npos || name.substr(at) == ours) continue;
    const int file = open(entry.path().c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) continue;
    const bool held = flock(file, LOCK_EX | LOCK_NB) != 0;
    const std::string who = holder(file);
    close(file);
    if (held) throw OutputError(out_, "a batch of another number of shards at work there" + who);
  }
}

std::string BatchStore::running(const std::string& scene) const { return own("running/" + scene); }

std::string BatchStore::make_running(const std::string& scene) const {
  forget_running(scene);
  make_folders(fs::path(running(scene)).parent_path());
  return running(scene);
}

void BatchStore::forget_running(const std::string& scene) const {
  std::error_code error;
  fs::remove_all(running(scene), error);
  check(error, running(scene));
  remove_empty(own("running"), scene);
}

std::string BatchStore::notes(const std::string& scene) const { return own("scenes/" + scene); }

std::string BatchStore::make_notes(const std::string& scene) const {
  make_folders(notes(scene));
  return notes(scene);
}

void BatchStore::check_place(const std::string& scene) const {
  std::error_code none;
  const fs::path place = result(scene);
  if (!fs::exists(place, none) || fs::exists(place / "batch.json", none)) return;
  if (fs::exists(place / "report.json", none) && fs::exists(place / "sketch.json", none)) return;
  if (fs::is_directory(place, none) && fs::is_empty(place, none)) return;
  throw OutputError(place.string(), "something that is no result and would be lost");
}

void BatchStore::withdraw(const std::string& scene) const {
  const fs::path place = result(scene), trash = own("trash/" + scene);
  std::error_code error;
  if (!fs::exists(fs::symlink_status(place, error))) return;
  make_folders(trash.parent_path());
  fs::remove_all(trash, error);
  check(error, trash.string());
  fs::rename(place, trash, error);
  check(error, place.string());
  fs::remove_all(trash, error);
  check(error, trash.string());
  remove_empty(out_, scene);
}

void BatchStore::publish(const std::string& scene) const {
  withdraw(scene);
  make_folders(fs::path(result(scene)).parent_path());
  std::error_code error;
  fs::rename(running(scene), result(scene), error);
  check(error, result(scene));
  remove_empty(own("running"), scene);
}

void BatchStore::write_file(const std::string& name,
                            const std::function<void(std::ostream&)>& write) const {
  const std::string part = own(fs::path(name).filename().string() + ".new");
  write_atomically(part, write);
  std::error_code error;
  fs::rename(part, result(name), error);
  check(error, result(name));
}

void BatchStore::write(const RunRecord& run, const std::string& scene) const {
  write_run(make_notes(scene) + "/run.json", run);
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/batch/store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
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

void remove_all(const std::string& place) {
  std::error_code error;
  fs::remove_all(place, error);
  check(error, place);
}

// With the folders above the new place.
void move(const std::string& from, const std::string& to) {
  make_folders(fs::path(to).parent_path());
  std::error_code error;
  fs::rename(from, to, error);
  check(error, to);
}

// Removes the folders between `root` and what was in it, as far as they are empty.
void remove_empty(const fs::path& root, const fs::path& name) {
  std::error_code error;
  for (fs::path above = name.parent_path(); !above.empty(); above = above.parent_path())
    if (!fs::remove(root / above, error)) return;
}

std::string own_name() {
  char host[65] = {};
  gethostname(host, sizeof host - 1);
  return "process " + std::to_string(getpid()) + " on " + host;
}

}  // namespace

BatchStore::BatchStore(const std::string& out, const Shard& shard) : out_(out) {
  prepare_output_folder(own(""));
  if (shard.count > 1) {
    lock("lock", "shards of " + std::to_string(shard.count));
    lock("lock." + std::to_string(shard.index), "");
  } else {
    lock("lock", "");
    // Nobody else is here: what is left was left by a batch that was ended.
    remove_all(own("running"));
    remove_all(own("trash"));
  }
}

BatchStore::~BatchStore() {
  for (const int file : locks_) close(file);
}

// A lock for one process, or shared by those that give the same text: whoever is first writes it
// into the file. Shards of 1/2 and of 1/3 would work on the same scenes.
void BatchStore::lock(const std::string& name, const std::string& shared_by) {
  const int file = open(own(name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) throw OutputError(own(name), std::strerror(errno));
  locks_.push_back(file);
  const std::string text = shared_by.empty() ? own_name() : shared_by;
  char holder[128] = {};
  for (int tries = shared_by.empty() ? 1 : 50; tries > 0; --tries) {  // others may be writing
    const bool alone = flock(file, LOCK_EX | LOCK_NB) == 0;
    if (!alone && errno != EWOULDBLOCK) throw OutputError(own(name), std::strerror(errno));
    if (alone && (ftruncate(file, 0) != 0 ||
                  pwrite(file, text.data(), text.size(), 0) != ssize_t(text.size())))
      throw OutputError(own(name), std::strerror(errno));
    if (alone && shared_by.empty()) return;
    const bool shared = !shared_by.empty() && flock(file, LOCK_SH | LOCK_NB) == 0;
    holder[std::max<ssize_t>(0, pread(file, holder, sizeof holder - 1, 0))] = 0;
    if (shared && holder == text) return;
    if (shared) break;
    usleep(20000);
  }
  throw OutputError(out_, "another batch at work there (" + std::string(holder) + ")");
}

void BatchStore::check_place(const std::string& scene) const {
  std::error_code none;
  const fs::path place = result(scene);
  if (!fs::exists(place, none) || fs::exists(place / "batch.json", none)) return;
  if (fs::exists(place / "report.json", none) && fs::exists(place / "sketch.json", none)) return;
  if (fs::is_directory(place, none) && fs::is_empty(place, none)) return;
  throw OutputError(place.string(), "something that is no result and would be lost");
}

void BatchStore::begin(const std::string& scene) const {
  forget_running(scene);
  make_folders(fs::path(running(scene)).parent_path());
  make_folders(notes(scene));
}

void BatchStore::forget_running(const std::string& scene) const {
  remove_all(running(scene));
  remove_empty(own("running"), scene);
}

// By way of the trash: it is whole, or not there.
void BatchStore::remove_result(const std::string& scene) const {
  std::error_code none;
  if (!fs::exists(fs::symlink_status(result(scene), none))) return;
  const std::string trash = own("trash/" + scene);
  remove_all(trash);
  move(result(scene), trash);
  remove_all(trash);
}

void BatchStore::withdraw(const std::string& scene) const {
  forget_running(scene);
  remove_result(scene);
  remove_empty(out_, scene);
}

void BatchStore::publish(const std::string& scene) const {
  remove_result(scene);
  move(running(scene), result(scene));
  remove_empty(own("running"), scene);
}

void BatchStore::write_file(const std::string& name,
                            const std::function<void(std::ostream&)>& write) const {
  const std::string part = own(fs::path(name).filename().string() + ".new");
  write_atomically(part, write);
  move(part, result(name));
}

}  // namespace sketchsplat

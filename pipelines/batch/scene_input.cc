// SPDX-License-Identifier: MIT
#include "pipelines/batch/scene_input.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "datasets/readers/scene.h"
#include "datasets/truth/ground_truth.h"
#include "pipelines/base/hash.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 4;             // folders below a scene that belong to it
constexpr std::uintmax_t kLargest = 1e8;  // [bytes] of a file with cameras; else by its size
constexpr double kProbeMegabytes = 4e3;

bool may_hold_cameras(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".json" || ending == ".txt" || ending == ".bin";
}

// What one scene is, as it goes through the pipe.
struct Message {
  int index;
  SceneSize size;
};

SceneSize size_of(const std::string& folder, const OpenOptions& options) {
  SceneSize size;
  try {
    const Scene scene = open_scene(folder, options);
    size.views = int(scene.views.size());
    for (const View& view : scene.views)
      size.pixels += double(view.camera.width) * view.camera.height;
  } catch (const std::exception&) {
    size = {};  // its worker will say why
  }
  return size;
}

// The child: tells the sizes of the scenes from `first` on.
[[noreturn]] void tell_sizes(const std::vector<BatchScene>& scenes, const OpenOptions& options,
                             int first, int pipe, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  const rlimit memory = {rlim_t(kProbeMegabytes * 1e6), rlim_t(kProbeMegabytes * 1e6)};
  const rlimit core = {0, 0};
  setrlimit(RLIMIT_AS, &memory);
  setrlimit(RLIMIT_CORE, &core);
  const int null = open("/dev/null", O_RDWR);
  dup2(null, 1);
  dup2(null, 2);
  for (int i = first; i < int(scenes.size()); ++i) {
    const Message message = {i, size_of(scenes[i].folder, options)};
    if (write(pipe, &message, sizeof message) != sizeof message) _exit(1);
  }
  _exit(0);
}

// Reads one message; false at the end, or if nothing comes for too long.
bool receive(int pipe, double patience_seconds, Message* message) {
  pollfd something = {pipe, POLLIN, 0};
  int n = 0;
  do n = poll(&something, 1, int(patience_seconds * 1000));
  while (n < 0 && errno == EINTR);
  // Messages are shorter than PIPE_BUF: they come whole.
  return n > 0 && read(pipe, message, sizeof *message) == sizeof *message;
}

}  // namespace

std::string input_hash(const std::string& folder) {
  std::vector<std::string> lines;
  std::error_code error;
  const auto options = fs::directory_options::follow_directory_symlink |
                       fs::directory_options::skip_permission_denied;
  fs::recursive_directory_iterator entry(folder, options, error), end;
  if (error) return "";
  for (; !error && entry != end; entry.increment(error)) {
    if (entry.depth() >= kDeepest - 1) entry.disable_recursion_pending();
    std::error_code none;
    if (!entry->is_regular_file(none)) continue;
    const std::uintmax_t size = entry->file_size(none);
    std::string line =
        entry->path().lexically_relative(folder).string() + " " + std::to_string(size);
    if (may_hold_cameras(entry->path()) && size <= kLargest)
      line += " " + hash_of_file(entry->path());
    lines.push_back(line + "\n");
  }
  std::sort(lines.begin(), lines.end());
  std::string all;
  for (const std::string& line : lines) all += line;
  return hash_of(all);
}

bool has_truth(const std::string& folder) {
  try {
    return has_ground_truth(folder);
  } catch (const std::exception&) {
    return true;  // `evaluate` will say what is wrong with it
  }
}

std::vector<SceneSize> scene_sizes(const std::vector<BatchScene>& scenes,
                                   const OpenOptions& options, double patience_seconds,
                                   const std::function<void()>& step) {
  std::vector<SceneSize> sizes(scenes.size());
  for (int next = 0; next < int(scenes.size());) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe can be made");
    const pid_t parent = getpid(), child = fork();
    if (child < 0) throw std::runtime_error("no process can be made");
    if (child == 0) tell_sizes(scenes, options, next, ends[1], parent);
    close(ends[1]);
    for (Message message; receive(ends[0], patience_seconds, &message); step()) {
      sizes[message.index] = message.size;
      next = message.index + 1;
    }
    close(ends[0]);
    kill(child, SIGKILL);
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    if (next < int(scenes.size())) {  // that one it died of
      ++next;
      step();
    }
  }
  return sizes;
}

}  // namespace sketchsplat

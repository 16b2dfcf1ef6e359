// SPDX-License-Identifier: MIT
#include "pipelines/bench/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace sketchsplat {
namespace {

constexpr char kSelf[] = "/proc/self/exe";

// What the child does between fork and exec: nothing that takes a lock.
[[noreturn]] void become(char* const* argv, const char* log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it died before it was asked to be watched
  const int null = open("/dev/null", O_RDWR), file = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (null < 0 || file < 0) _exit(127);
  dup2(null, 0);
  dup2(null, 1);
  dup2(file, 2);
  execv(kSelf, argv);
  _exit(127);
}

// Ends the child if it takes too long. Without pidfd (Linux before 5.3) it may take for ever.
bool wait_or_kill(pid_t pid, double timeout_seconds) {
  const int fd = int(syscall(SYS_pidfd_open, pid, 0));  // glibc's header cannot be linked from C++
  if (fd < 0) return false;
  pollfd ended = {fd, POLLIN, 0};
  const int n = poll(&ended, 1, int(std::min(timeout_seconds * 1000, 2e9)));
  close(fd);
  if (n == 0) kill(pid, SIGKILL);
  return n == 0;
}

std::string last_line(const std::string& path) {
  std::ifstream in(path);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

double seconds_of(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

}  // namespace

ChildResult run_self(const std::vector<std::string>& arguments, const std::string& log,
                     double timeout_seconds) {
  std::vector<char*> argv = {const_cast<char*>("sketchsplat")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const auto began = std::chrono::steady_clock::now();
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) throw std::runtime_error("no process can be made");
  if (pid == 0) become(argv.data(), log.c_str(), parent);
  ChildResult result;
  result.timed_out = wait_or_kill(pid, timeout_seconds);
  int status = 0;
  rusage usage = {};
  while (wait4(pid, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  result.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.last_words = last_line(log);
  if (result.status == 0) std::remove(log.c_str());
  return result;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/base/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace sketchsplat {
namespace {

constexpr char kSelf[] = "/proc/self/exe";

void limit_memory(double megabytes) {
  if (!(megabytes > 0)) return;
  const rlimit limit = {rlim_t(megabytes * 1e6), rlim_t(megabytes * 1e6)};
  if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(127);
}

// It is the child that the kernel shall choose where memory runs out.
void offer_to_the_kernel() {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  if (write(file, "500", 3) != 3) return;  // then it chooses for itself
  close(file);
}

// What the child does between fork and exec: nothing that takes a lock.
[[noreturn]] void become(char* const* argv, const char* log, double memory_mb, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it died before it was asked to be watched
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);  // whatever the parent waits for
  const int null = open("/dev/null", O_RDWR), file = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (null < 0 || file < 0) _exit(127);
  dup2(null, 0);
  dup2(null, 1);
  dup2(file, 2);
  offer_to_the_kernel();
  limit_memory(memory_mb);
  execv(kSelf, argv);
  _exit(127);
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

Child::Child(const std::vector<std::string>& arguments, const std::string& log, double memory_mb)
    : log_(log), began_(std::chrono::steady_clock::now()) {
  std::vector<char*> argv = {const_cast<char*>("sketchsplat")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("no process can be made");
  if (pid_ == 0) become(argv.data(), log.c_str(), memory_mb, parent);
  setpgid(pid_, pid_);  // by the first of the two
}

Child::~Child() {
  if (ended_) return;
  kill();
  wait();
}

bool Child::reap(int flags) {
  if (ended_) return true;
  // While it is not reaped its number stays reserved, so that its group can be ended.
  siginfo_t info = {};
  while (waitid(P_PID, id_t(pid_), &info, WEXITED | WNOWAIT | flags) < 0 && errno == EINTR) {
  }
  if (info.si_pid != pid_) return false;
  ::kill(-pid_, SIGKILL);  // what it has started and not waited for
  int status = 0;
  rusage usage = {};
  while (wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  ended_ = true;
  result_.seconds = seconds();
  result_.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  result_.peak_mb = double(usage.ru_maxrss) * 1024 / 1e6;  // Linux counts in KiB
  result_.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result_.last_words = last_line(log_);
  return true;
}

bool Child::ended() { return reap(WNOHANG); }

void Child::wait() { reap(0); }

bool Child::wait_for(double seconds) {
  const int fd = int(syscall(SYS_pidfd_open, pid_, 0));  // glibc's header cannot be linked from C++
  if (fd < 0) {
    wait();
    return true;
  }
  pollfd end = {fd, POLLIN, 0};
  poll(&end, 1, int(std::min(seconds * 1000, 2e9)));
  close(fd);
  return ended();
}

void Child::kill() {
  if (!ended_) ::kill(-pid_, SIGKILL);
}

double Child::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

ChildResult run_self(const std::vector<std::string>& arguments, const std::string& log,
                     double timeout_seconds) {
  Child child(arguments, log);
  const bool in_time = child.wait_for(timeout_seconds);
  if (!in_time) {
    child.kill();
    child.wait();
  }
  ChildResult result = child.result();
  result.timed_out = !in_time;
  if (result.status == 0) std::remove(log.c_str());
  return result;
}

std::string reason_of(const ChildResult& child, double timeout_seconds) {
  if (child.timed_out) {
    char text[64];
    std::snprintf(text, sizeof text, "took longer than %g s", timeout_seconds);
    return text;
  }
  std::string text = child.last_words;
  if (text.rfind("sketchsplat: ", 0) == 0) text = text.substr(13);
  if (child.status >= 128) {
    const int number = child.status - 128;
    const char* name = sigabbrev_np(number);
    const bool says_why = text.find("what(): ") != std::string::npos;  // of an exception
    return "ended by signal " + std::to_string(number) +
           (name ? " (SIG" + std::string(name) + ")" : "") + (says_why ? ": " + text : "");
  }
  return text.empty() ? "exit status " + std::to_string(child.status) : text;
}

}  // namespace sketchsplat

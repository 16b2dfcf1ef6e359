// SPDX-License-Identifier: MIT
#include "datasets/step/child_bytes.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <new>
#include <stdexcept>

namespace sketchsplat {
namespace {

bool is_child = false;  // of run_in_child

bool write_all(int fd, const std::string& bytes) {
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t n = write(fd, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) at += size_t(n);
  }
  return true;
}

std::string read_all(int fd) {
  std::string text;
  char bytes[1 << 16];
  for (ssize_t n; (n = read(fd, bytes, sizeof bytes)) > 0 || (n < 0 && errno == EINTR);)
    if (n > 0) text.append(bytes, size_t(n));
  return text;
}

ChildBytes run_in_place(const std::function<std::string()>& work) {
  ChildBytes out;
  try {
    out.bytes = work();
  } catch (const std::bad_alloc&) {
    out.exit_status = ChildBytes::kNoMemory;
  } catch (...) {
    out.exit_status = ChildBytes::kThrew;
  }
  return out;
}

// Without destructors, buffers and handlers of the process that it is a copy of.
[[noreturn]] void be_child(const std::function<std::string()>& work, unsigned seconds, int out,
                           pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(ChildBytes::kOrphan);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGINT, SIGTERM})
    signal(number, SIG_DFL);
  const rlimit cpu = {seconds, seconds}, core = {0, 0};
  setrlimit(RLIMIT_CPU, &cpu);
  setrlimit(RLIMIT_CORE, &core);
  is_child = true;
  const ChildBytes done = run_in_place(work);
  _exit(write_all(out, done.bytes) ? done.exit_status : ChildBytes::kThrew);
}

}  // namespace

ChildBytes run_in_child(const std::function<std::string()>& work, unsigned seconds) {
  if (is_child) return run_in_place(work);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe can be made");
  const pid_t parent = getpid(), child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error("no process can be made");
  }
  if (child == 0) be_child(work, seconds, ends[1], parent);
  close(ends[1]);
  ChildBytes out;
  out.bytes = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) out.signal = WTERMSIG(status);
  if (WIFEXITED(status)) out.exit_status = WEXITSTATUS(status);
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace sketchsplat {

/// How a child process ended, and what it took.
struct ChildResult {
  int status = 0;          ///< exit status; 128 + the signal that ended it
  bool timed_out = false;  ///< was ended because it took too long
  double seconds = 0;      ///< wall clock, from its start to its end
  double cpu_seconds = 0;  ///< of all its threads
  double peak_mb = 0;      ///< peak resident memory [MB = 1e6 bytes]
  std::string last_words;  ///< the last line on its stderr
};

/// This program once more, with these arguments, in a process group of its own. What it writes to
/// stdout is dropped, stderr goes to the file `log`. It dies with its parent's thread, and with
/// this object. The kernel ends it before its parent where memory runs out.
class Child {
 public:
  /// `memory_mb`: limit of its address space, 0: none. Throws std::runtime_error if no process can
  /// be made.
  Child(const std::vector<std::string>& arguments, const std::string& log, double memory_mb = 0);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Whether it has ended; does not wait. The result is there then.
  bool ended();
  /// Waits for its end.
  void wait();
  /// Waits for its end, at most so long. Without pidfd (Linux before 5.3) as long as it takes.
  bool wait_for(double seconds);
  /// Ends it and what it has started; ended() is still to be asked for.
  void kill();

  const ChildResult& result() const { return result_; }
  double seconds() const;  ///< since its start
  pid_t pid() const { return pid_; }

 private:
  bool reap(int flags);

  pid_t pid_ = -1;
  bool ended_ = false;
  std::string log_;
  ChildResult result_;
  std::chrono::steady_clock::time_point began_;
};

/// Runs a child to its end, or until it takes too long. The log is removed if it ends well. Throws
/// std::runtime_error if no process can be made.
ChildResult run_self(const std::vector<std::string>& arguments, const std::string& log,
                     double timeout_seconds);

/// Why a child failed, in words: its last words without the program's name, the signal that ended
/// it, or its exit status.
std::string reason_of(const ChildResult& child, double timeout_seconds);

}  // namespace sketchsplat

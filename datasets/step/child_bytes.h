// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace sketchsplat {

/// What a child process had to say before it ended.
struct ChildBytes {
  enum ExitStatus { kDone = 0, kThrew = 1, kNoMemory = 2, kOrphan = 3 };

  std::string bytes;
  int exit_status = kDone;  ///< without meaning if a signal ended it
  int signal = 0;  ///< that ended it, 0 if none: SIGSEGV of a crash, SIGXCPU of the time limit
};

/// Runs `work` in a copy of this process and returns the bytes that it returned there. Whatever
/// happens to the copy - a crash, a loop without end - this process goes on. An exception of `work`
/// gives kThrew and no bytes; of memory that ran out, kNoMemory. Of threads, the copy has
/// only the calling one. `seconds`: of CPU, > 0. In such a copy itself `work` runs in place,
/// without limits of its own. Throws std::runtime_error if there is no process to be had.
ChildBytes run_in_child(const std::function<std::string()>& work, unsigned seconds);

}  // namespace sketchsplat

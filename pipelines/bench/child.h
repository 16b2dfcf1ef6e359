// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sketchsplat {

/// How a child process ended, and what it took.
struct ChildResult {
  int status = 0;          ///< exit status; 128 + the signal that ended it
  bool timed_out = false;  ///< was ended because it took too long
  double seconds = 0;      ///< wall clock, from its start to its end
  double cpu_seconds = 0;  ///< of all its threads
  std::string last_words;  ///< the last line on its stderr
};

/// Runs this program again with these arguments and waits for it. What it writes to stdout is
/// dropped, stderr goes to the file `log`, which is removed if the child ends well. The child dies
/// with its parent. Throws std::runtime_error if no process can be made.
ChildResult run_self(const std::vector<std::string>& arguments, const std::string& log,
                     double timeout_seconds);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <climits>
#include <cstdlib>

#include "pipelines/base/version.h"
#include "pipelines/command/cli.h"
#include "pipelines/commit.h"  // written by cmake/commit.cmake

namespace {

// Threads that wait for others burn their core for milliseconds by default, which beside a busy
// neighbour costs more than they gain. libgomp asks the environment once, when it is loaded, so
// the program starts itself anew; whoever has set one of these keeps it.
void spin_briefly(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  char program[PATH_MAX] = {};
  const ssize_t length = ::readlink("/proc/self/exe", program, sizeof(program) - 1);
  if (length <= 0 || ::setenv("GOMP_SPINCOUNT", "2000", 1) != 0) return;
  ::execv(program, argv);  // comes back if it cannot: then threads spin
}

}  // namespace

int main(int argc, char** argv) {
  using namespace sketchsplat;
  spin_briefly(argv);
  set_program_commit(SKETCHSPLAT_COMMIT);
  return run_command_line(argc, argv, all_verbs());
}

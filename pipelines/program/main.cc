// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <opencv2/core/utility.hpp>

#include "pipelines/base/version.h"
#include "pipelines/command/cli.h"
#include "pipelines/commit.h"  // written by cmake/commit.cmake

namespace {

void set_unless_set(const char* name, const char* value) {
  if (!std::getenv(name)) ::setenv(name, value, 1);
}

// Some libraries ask the environment once, when they are loaded, so the program starts itself anew;
// a value that the user has set is kept.
// - libgomp: threads that wait for others burn their core for milliseconds by default, which beside
//   a busy neighbour costs more than they gain.
// - libm: exp and its kin have versions by what the CPU can do (FMA, AVX2), which differ in the
//   last bit. Results shall be the same on every x86-64; this costs no time that can be measured.
// - malloc: what held a picture goes back to the system at once by default, and its pages have to
//   be cleared for the next one.
void set_environment(char** argv) {
  constexpr char kMark[] = "SKETCHSPLAT_ENVIRONMENT";
  if (std::getenv(kMark)) return;
  char program[PATH_MAX] = {};
  const ssize_t length = ::readlink("/proc/self/exe", program, sizeof(program) - 1);
  if (length <= 0 || ::setenv(kMark, "set", 1) != 0) return;
  if (!std::getenv("OMP_WAIT_POLICY")) set_unless_set("GOMP_SPINCOUNT", "2000");
  set_unless_set("GLIBC_TUNABLES",
                 "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX_Usable,-AVX2_Usable,-FMA_Usable,"
                 "-FMA4_Usable:glibc.malloc.mmap_threshold=33554432:"  // 32 MB, the most it takes
                 "glibc.malloc.trim_threshold=67108864");
  ::execv(program, argv);  // comes back if it cannot
}

}  // namespace

int main(int argc, char** argv) {
  using namespace sketchsplat;
  set_environment(argv);
  cv::setUseOptimized(false);  // OpenCV's own versions by CPU differ, too
  set_program_commit(SKETCHSPLAT_COMMIT);
  return run_command_line(argc, argv, all_verbs());
}

// SPDX-License-Identifier: MIT
#include "pipelines/cli.h"
#include "pipelines/commit.h"  // written by cmake/commit.cmake
#include "pipelines/version.h"

int main(int argc, char** argv) {
  using namespace sketchsplat;
  set_program_commit(SKETCHSPLAT_COMMIT);
  return run_command_line(argc, argv, all_verbs());
}

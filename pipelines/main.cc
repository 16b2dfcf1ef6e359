// SPDX-License-Identifier: MIT
#include "pipelines/cli.h"

int main(int argc, char** argv) {
  using namespace sketchsplat;
  return run_command_line(argc, argv,
                          {reconstruct_verb(), detect_verb(), evaluate_verb(), export_verb(),
                           inspect_verb(), synthesize_verb(), bench_verb()});
}

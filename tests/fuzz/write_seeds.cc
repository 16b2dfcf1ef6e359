// SPDX-License-Identifier: MIT
// TARGET --write-seeds DIR: the seeds of a target as files, for libFuzzer, whose main() calls this.
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (*argc != 3 || std::string((*argv)[1]) != "--write-seeds") return 0;
  int n = 0;
  for (const std::string& seed : sketchsplat::fuzz_seeds())
    std::ofstream((*argv)[2] + ("/seed" + std::to_string(n++)), std::ios::binary) << seed;
  std::exit(0);
}

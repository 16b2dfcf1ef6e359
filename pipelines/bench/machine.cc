// SPDX-License-Identifier: MIT
#include "pipelines/bench/machine.h"

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "pipelines/base/hash.h"
#include "pipelines/base/version.h"

namespace sketchsplat {
namespace {

std::string cpu_model() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos)
      return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

OptionTexts machine_labels() {
  const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  return {{"version", program_version()},
          {"program", hash_of_file("/proc/self/exe")},
          {"cpu", cpu_model()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"memory", std::to_string(std::lround(bytes / 1e9)) + " GB"}};
}

}  // namespace sketchsplat

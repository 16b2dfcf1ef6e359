// SPDX-License-Identifier: MIT
#include "pipelines/bench/machine.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <thread>

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

std::string hash_of(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3u;
  char text[32];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::string hash_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return hash_of({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
}

OptionTexts machine_labels() {
  const double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  return {{"version", SKETCHSPLAT_VERSION},
          {"program", hash_of_file("/proc/self/exe")},
          {"cpu", cpu_model()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"memory", std::to_string(std::lround(bytes / 1e9)) + " GB"}};
}

}  // namespace sketchsplat

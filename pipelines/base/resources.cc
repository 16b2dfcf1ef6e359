// SPDX-License-Identifier: MIT
#include "pipelines/base/resources.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr char kGroups[] = "/sys/fs/cgroup";

// The control group of this process: the line "0::/path".
std::string own_group() {
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("0::/", 0) == 0) return line.substr(4);
  return "";
}

double available_memory() {
  std::ifstream in("/proc/meminfo");
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name;
    double kib = 0;
    if (words >> name >> kib && name == "MemAvailable:") return kib * 1024;
  }
  return kInfinity;
}

}  // namespace

double least_of_groups(const std::string& root, const std::string& path, const std::string& file) {
  double least = kInfinity;
  fs::path group = fs::path(root) / path;
  for (;; group = group.parent_path()) {
    std::ifstream in(group / file);
    double value = 0, per = 1;
    if (in >> value) least = std::min(least, in >> per ? value / per : value);
    if (group.string().size() <= root.size()) return least;
  }
}

int usable_cores() {
  const double quota = least_of_groups(kGroups, own_group(), "cpu.max");
  const double cores = omp_get_num_procs();  // obeys the affinity
  return std::max(1, int(std::min(cores, std::ceil(quota - 0.01))));
}

double usable_memory_mb() {
  const double limit = least_of_groups(kGroups, own_group(), "memory.max");
  return std::min(available_memory(), limit) / 1e6;
}

}  // namespace sketchsplat

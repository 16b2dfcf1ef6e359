// SPDX-License-Identifier: MIT
#include "pipelines/base/run_report.h"

#include <sys/resource.h>

#include <fstream>
#include <new>

namespace sketchsplat {

// The high-water mark of this program's memory; getrusage's counts that of the program before it in
// the process, too.
double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0;
    if (word == "VmHWM:" && status >> kib) return kib * 1024 / 1e6;
  }
  rusage usage;
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return double(usage.ru_maxrss) * 1024 / 1e6;  // Linux counts in KiB
}

void RunLog::count(const std::string& name, double value) const {
  if (report) report->counts.push_back({name, value});
}

void RunLog::warn(const std::string& text) const {
  if (report) report->warnings.push_back(text);
  if (progress) progress->warn(text);
}

void RunLog::note(const std::string& text) const {
  if (progress) progress->note(text);
}

Stage::Stage(const std::string& name, const RunLog& log, int total)
    : name_(name), log_(log), began_(std::chrono::steady_clock::now()) {
  if (log_.progress) log_.progress->begin(name, total);
}

Stage::~Stage() {
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began_;
  try {
    if (log_.report)
      log_.report->stages.push_back({name_, seconds.count(), peak_memory_mb(), result_});
    if (log_.progress) log_.progress->end(result_);
  } catch (const std::bad_alloc&) {
    // No exception may leave a destructor; the next allocation reports the lack of memory.
  }
}

void Stage::step() {
  if (log_.progress) log_.progress->step();
}

}  // namespace sketchsplat

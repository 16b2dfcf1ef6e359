// SPDX-License-Identifier: MIT
#include "pipelines/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace sketchsplat {

bool Progress::stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

void Progress::begin(const std::string& stage, int total) {
  std::lock_guard<std::mutex> lock(mutex_);
  stage_ = stage;
  total_ = total;
  count_ = 0;
  began_ = drawn_ = Clock::now();
  if (mode_ == Mode::kBar) draw();
}

void Progress::step() {
  ++count_;
  if (mode_ != Mode::kBar) return;
  std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // somebody else is drawing
  const Clock::time_point now = Clock::now();
  if (now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  draw();
}

void Progress::end(const std::string& result) {
  std::lock_guard<std::mutex> lock(mutex_);
  const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
  char line[256];
  std::snprintf(line, sizeof(line), "%-12s %7.2f s  %s", stage_.c_str(), seconds, result.c_str());
  say(line);
}

void Progress::warn(const std::string& text) {
  std::lock_guard<std::mutex> lock(mutex_);
  say("warning: " + text);
}

void Progress::note(const std::string& text) {
  std::lock_guard<std::mutex> lock(mutex_);
  if (verbose_) say("  " + text);
}

void Progress::draw() {
  constexpr int kCells = 30;
  bar_on_screen_ = true;
  if (total_ <= 0) {
    std::fprintf(stderr, "\r\033[K%-12s ...", stage_.c_str());
  } else {
    const int count = std::min(count_.load(), total_);
    const int full = int(int64_t(kCells) * count / total_);
    const std::string bar = std::string(full, '#') + std::string(kCells - full, '.');
    std::fprintf(stderr, "\r\033[K%-12s [%s] %d/%d", stage_.c_str(), bar.c_str(), count, total_);
  }
  std::fflush(stderr);
}

void Progress::clear_bar() {
  if (bar_on_screen_) std::fputs("\r\033[K", stderr);
  bar_on_screen_ = false;
}

void Progress::say(const std::string& line) {
  if (mode_ == Mode::kSilent) return;
  clear_bar();
  const size_t end = line.find_last_not_of(' ');
  std::fprintf(stderr, "%s\n", line.substr(0, end + 1).c_str());
}

}  // namespace sketchsplat

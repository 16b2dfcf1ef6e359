// SPDX-License-Identifier: MIT
#include "pipelines/base/progress.h"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr size_t kMostRepeated = 20;  // warnings; all of them are in the report
constexpr double kLeastSeconds = 2;   // before the rest can be estimated

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm local = {};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &local);
  return text;
}

}  // namespace

bool Progress::stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1 && variable("TERM") != "dumb";
}

bool Progress::stderr_has_color() { return stderr_is_terminal() && variable("NO_COLOR").empty(); }

void Progress::log_to(const std::string& path) {
  errno = 0;
  log_.open(path, std::ios::app);
  if (!log_) throw OutputError(path, errno ? std::strerror(errno) : "an error of the file system");
}

void Progress::log(const std::string& text) {
  if (log_.is_open()) log_ << time_of_day() << " " << text << std::endl;
}

void Progress::begin(const std::string& stage, int total) {
  std::lock_guard<std::mutex> lock(mutex_);
  stage_ = stage;
  total_ = total;
  count_ = 0;
  share_ = -1;
  began_ = drawn_ = Clock::now();
  if (mode_ == Mode::kBar) draw();
  ask_watcher();
  if (cancelled_) throw CancelledError();
}

void Progress::step() {
  ++count_;
  if (cancelled_ && omp_get_level() == 0) throw CancelledError();
  if (mode_ != Mode::kBar && !watcher_) return;
  std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // another thread is drawing
  const Clock::time_point now = Clock::now();
  if (now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  if (mode_ == Mode::kBar) draw();
  ask_watcher();
}

void Progress::ask_watcher() {
  if (watcher_ && !watcher_(stage_, count_, total_)) cancelled_ = true;
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
  warnings_.push_back(text);
  say(text, true);
}

void Progress::info(const std::string& text) {
  std::lock_guard<std::mutex> lock(mutex_);
  if (mode_ != Mode::kBar || verbose_)
    say(text);
  else
    log(text);
}

void Progress::note(const std::string& text) {
  std::lock_guard<std::mutex> lock(mutex_);
  if (verbose_) say("  " + text);
}

void Progress::repeat_warnings() {
  std::lock_guard<std::mutex> lock(mutex_);
  if (!said_since_ || mode_ == Mode::kSilent) return;
  const size_t shown = std::min(warnings_.size(), kMostRepeated);
  for (size_t i = 0; i < shown; ++i) {
    const std::string text = warnings_[i];
    say(text, true);
  }
  if (shown < warnings_.size())
    say("and " + std::to_string(warnings_.size() - shown) + " more warnings");
}

std::string Progress::time_left(int count) const {
  const double given = share_, done = given >= 0 ? given : double(count) / total_;
  const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
  if (seconds < kLeastSeconds || !(done > 0) || done >= 1) return "";
  return ", " + rough_duration(seconds * (1 - done) / done) + " left";
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
    std::fprintf(stderr, "\r\033[K%-12s [%s] %d/%d%s", stage_.c_str(), bar.c_str(), count, total_,
                 time_left(count).c_str());
  }
  std::fflush(stderr);
}

void Progress::clear_bar() {
  if (bar_on_screen_) std::fputs("\r\033[K", stderr);
  bar_on_screen_ = false;
}

void Progress::say(const std::string& line, bool warning) {
  const std::string text = one_line(line.substr(0, line.find_last_not_of(' ') + 1));
  said_since_ |= !warning && !warnings_.empty();
  log((warning ? "warning: " : "") + text);
  if (mode_ == Mode::kSilent) return;
  clear_bar();
  const char* mark = !warning ? "" : color_ ? "\033[33mwarning:\033[0m " : "warning: ";
  std::fprintf(stderr, "%s%s\n", mark, text.c_str());
}

std::string rough_duration(double seconds) {
  const auto text = [](double big, const char* unit, double small, const char* part) {
    const std::string rest = small > 0 ? " " + std::to_string(int(small)) + " " + part : "";
    return std::to_string(int(big)) + " " + unit + rest;
  };
  const double minutes = std::round(seconds / 60), hours = std::round(minutes / 60);
  if (seconds < 59.5) return text(std::ceil(seconds), "s", 0, "");
  if (minutes < 60) return text(minutes, "min", 0, "");
  if (minutes < 48 * 60) return text(std::floor(minutes / 60), "h", std::fmod(minutes, 60), "min");
  return text(std::floor(hours / 24), "d", std::fmod(hours, 24), "h");
}

}  // namespace sketchsplat

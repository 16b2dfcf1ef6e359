// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace sketchsplat {

/// The watcher of a Progress has cancelled the run.
struct CancelledError : std::runtime_error {
  CancelledError() : std::runtime_error("cancelled") {}
};

/// Shows on stderr how far the work is: a bar on a terminal, else one line per finished stage.
/// step() may be called from several threads.
class Progress {
 public:
  enum class Mode { kSilent, kLines, kBar };

  explicit Progress(Mode mode, bool verbose = false) : mode_(mode), verbose_(verbose) {}
  /// Whether stderr is a terminal that can move its cursor.
  static bool stderr_is_terminal();
  /// The same, unless NO_COLOR is set (https://no-color.org).
  static bool stderr_has_color();

  void use_color(bool color) { color_ = color; }
  /// Appends all messages to this file, too, with the time of day, even if silent. Throws
  /// OutputError.
  void log_to(const std::string& path);
  /// A line for the log alone.
  void log(const std::string& text);

  /// Called with a stage, how many of its steps are done, and how many there are: when a stage
  /// begins, and now and then in it; from any thread, never from two at once. If it returns false,
  /// begin() or step(), outside of parallel regions, throws CancelledError.
  using Watcher = std::function<bool(const std::string& stage, int done, int total)>;
  void watch(Watcher watcher) { watcher_ = std::move(watcher); }

  /// `total` is the number of step()s that will come; 0 if unknown.
  void begin(const std::string& stage, int total);
  void step();
  /// How much of the stage's work is done, if steps take unequally long: for the time left.
  void share(double done) { share_ = done; }
  /// Ends the stage; `result`: what came out, in a few words; may be empty.
  void end(const std::string& result = "");
  /// A line about a problem that does not stop the run. Nothing if silent.
  void warn(const std::string& text);
  /// A line about a part of a stage, unless a bar shows it.
  void info(const std::string& text);
  /// A line for --verbose.
  void note(const std::string& text);
  /// The warnings once more, at the end of everything, unless nothing came between.
  void repeat_warnings();

 private:
  using Clock = std::chrono::steady_clock;
  void draw();
  void ask_watcher();
  void clear_bar();
  void say(const std::string& line, bool warning = false);
  std::string time_left(int count) const;

  Mode mode_;
  bool verbose_, color_ = false;
  std::string stage_;
  int total_ = 0;
  std::atomic<int> count_{0};
  std::atomic<double> share_{-1};
  Clock::time_point began_, drawn_;
  bool bar_on_screen_ = false;
  std::vector<std::string> warnings_;
  bool said_since_ = false;  // another line, after a warning
  std::ofstream log_;
  Watcher watcher_;
  std::atomic<bool> cancelled_{false};
  std::mutex mutex_;
};

/// "40 s", "12 min", "3 h 20 min", "2 d 4 h": rounded as a rough estimate.
std::string rough_duration(double seconds);

}  // namespace sketchsplat

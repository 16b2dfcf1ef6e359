// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

namespace sketchsplat {

/// Says on stderr how far the work is: a bar on a terminal, else one line per finished stage.
/// step() may be called from several threads.
class Progress {
 public:
  enum class Mode { kSilent, kLines, kBar };

  explicit Progress(Mode mode, bool verbose = false) : mode_(mode), verbose_(verbose) {}
  static bool stderr_is_terminal();

  /// `total` is the number of step()s that will come; 0 if nobody knows.
  void begin(const std::string& stage, int total);
  void step();
  /// Ends the stage; `result` says in a few words what came out, may be empty.
  void end(const std::string& result = "");
  /// A line about something that went wrong but does not stop the run. Nothing if silent.
  void warn(const std::string& text);
  /// A line for those who asked for more (--verbose).
  void note(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  void draw();
  void clear_bar();
  void say(const std::string& line);

  Mode mode_;
  bool verbose_;
  std::string stage_;
  int total_ = 0;
  std::atomic<int> count_{0};
  Clock::time_point began_, drawn_;
  bool bar_on_screen_ = false;
  std::mutex mutex_;
};

}  // namespace sketchsplat

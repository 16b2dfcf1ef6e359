// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>

namespace sketchsplat {

/// When to stop refining. By default never.
class Deadline {
 public:
  Deadline() = default;
  /// So many seconds from now.
  explicit Deadline(double seconds)
      : at_(Clock::now() +
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))) {}
  bool passed() const { return at_ && Clock::now() >= *at_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> at_;
};

}  // namespace sketchsplat

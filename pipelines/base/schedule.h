// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <set>
#include <vector>

namespace sketchsplat {

/// What a piece of work is expected to take.
struct Load {
  double seconds = 0;
  double memory_mb = 0;
};

/// Which piece of work is next: longest first, so that no long one is left for the end; as many at
/// a time as there are places and memory.
class Schedule {
 public:
  Schedule(const std::vector<Load>& loads, int places, double memory_mb);

  /// Takes the next piece that may start now; -1 if none may. One that needs more memory than there
  /// is starts alone.
  int next();
  /// A piece has ended, and took so much memory: others will be taken to need as much more than
  /// expected (or the same, if it needed less).
  void ended(int piece, double peak_mb);
  /// A piece that has ended is to be done once more, after all others.
  void again(int piece) { waiting_.push_back(piece); }
  /// Whether nothing is left to start.
  bool empty() const { return waiting_.empty(); }
  int running() const { return int(running_.size()); }

 private:
  double expected(int piece) const { return loads_[piece].memory_mb * factor_; }

  std::vector<Load> loads_;
  std::deque<int> waiting_;
  std::set<int> running_;
  int places_;
  double memory_mb_, factor_ = 1;
};

}  // namespace sketchsplat

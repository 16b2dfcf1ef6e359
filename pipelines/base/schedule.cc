// SPDX-License-Identifier: MIT
#include "pipelines/base/schedule.h"

#include <algorithm>
#include <numeric>

namespace sketchsplat {

Schedule::Schedule(const std::vector<Load>& loads, int places, double memory_mb)
    : loads_(loads), waiting_(loads.size()), places_(places), memory_mb_(memory_mb) {
  std::iota(waiting_.begin(), waiting_.end(), 0);
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [&](int a, int b) { return loads_[a].seconds > loads_[b].seconds; });
}

int Schedule::next() {
  if (waiting_.empty() || running() >= places_) return -1;
  const int piece = waiting_.front();
  double memory = expected(piece);
  for (const int other : running_) memory += expected(other);
  if (!running_.empty() && memory > memory_mb_) return -1;
  waiting_.pop_front();
  running_.insert(piece);
  return piece;
}

void Schedule::ended(int piece, double peak_mb) {
  running_.erase(piece);
  if (loads_[piece].memory_mb > 0) factor_ = std::max(factor_, peak_mb / loads_[piece].memory_mb);
}

}  // namespace sketchsplat

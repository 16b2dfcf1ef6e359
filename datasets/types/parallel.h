// SPDX-License-Identifier: MIT
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <mutex>

namespace sketchsplat {

/// What went wrong first, in the order of a loop, not of time: the same for any number of threads.
class FirstFailure {
 public:
  bool is_before(int i) const { return at_.load(std::memory_order_relaxed) < i; }

  /// To be called while the exception is handled.
  void keep(int i) noexcept {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (i >= at_) return;
    at_ = i;
    what_ = std::current_exception();
  }

  void rethrow() const {
    if (what_) std::rethrow_exception(what_);
  }

 private:
  std::atomic<int> at_ = std::numeric_limits<int>::max();
  std::exception_ptr what_;
  std::mutex mutex_;
};

/// work(i) for all i below n, by all threads, which take `chunk` at a time; one thread does it if
/// that is all. An exception must not leave a parallel region of OpenMP, which would end the
/// program: the one of the lowest i is thrown here, and what comes after that i may stay undone.
template <class Work>
void parallel_for(int n, int chunk, const Work& work) {
  FirstFailure failure;
#pragma omp parallel for schedule(dynamic, chunk) if (n > chunk)
  for (int i = 0; i < n; ++i) {
    if (failure.is_before(i)) continue;
    try {
      work(i);
    } catch (...) {
      failure.keep(i);
    }
  }
  failure.rethrow();
}

/// The same for much work of one size: a few large parts for each thread.
template <class Work>
void parallel_for(int n, const Work& work) {
  parallel_for(n, std::max(1, n / (4 * omp_get_max_threads())), work);
}

}  // namespace sketchsplat

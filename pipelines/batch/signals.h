// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>

namespace sketchsplat {

/// While it lives, SIGCHLD and the signals by which people and systems end programs are kept until
/// somebody asks for them: they cannot strike in the middle of anything. Of a program with one
/// thread at that time.
class KeptSignals {
 public:
  KeptSignals();
  ~KeptSignals();
  KeptSignals(const KeptSignals&) = delete;
  KeptSignals& operator=(const KeptSignals&) = delete;

  /// Waits for one, at most so long; its number, or 0.
  int wait(double seconds);

 private:
  sigset_t kept_, before_;
};

}  // namespace sketchsplat

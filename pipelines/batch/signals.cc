// SPDX-License-Identifier: MIT
#include "pipelines/batch/signals.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace sketchsplat {

KeptSignals::KeptSignals() {
  std::signal(SIGCHLD, SIG_DFL);  // whoever started us may have had it ignored
  sigemptyset(&kept_);
  for (const int number : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) sigaddset(&kept_, number);
  pthread_sigmask(SIG_BLOCK, &kept_, &before_);
}

KeptSignals::~KeptSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

int KeptSignals::wait(double seconds) {
  const double whole = std::floor(std::max(0.0, seconds));
  const timespec time = {std::time_t(whole), long((seconds - whole) * 1e9)};
  const int number = sigtimedwait(&kept_, nullptr, &time);
  return number > 0 ? number : 0;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/base/run_report.h"

namespace sketchsplat {

struct ReconstructOptions;

/// One reconstruction on its way: what was asked for (options.h), until when (its deadline), and
/// where what happens is written down.
struct MethodRun {
  const ReconstructOptions& options;
  RunLog log;
};

}  // namespace sketchsplat

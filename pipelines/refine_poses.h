// SPDX-License-Identifier: MIT
#pragma once

#include "edges/lift.h"
#include "pipelines/run_report.h"
#include "sketches/sketch.h"

namespace sketchsplat {
struct ReconstructOptions;

void probe_poses(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options,
                 Progress* progress);

}  // namespace sketchsplat

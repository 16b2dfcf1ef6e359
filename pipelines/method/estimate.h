// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/base/schedule.h"
#include "pipelines/options/options.h"

namespace sketchsplat {

/// What a reconstruction takes, roughly (a factor of three), from the number and the size of the
/// pictures: fitted to runs on one core of a server of 2021. `threads` of them share the seconds.
Load expected_load(int views, double pixels, const ReconstructOptions& options, int threads);

}  // namespace sketchsplat

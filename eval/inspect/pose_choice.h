// SPDX-License-Identifier: MIT
#pragma once

#include "eval/inspect/alignment.h"
#include "eval/inspect/robust_fit.h"

namespace sketchsplat {

constexpr double kWidestReach = 0.06;  ///< [extents] of the first fits

/// Of the poses that directions, inertia and like strokes suggest (pose_candidates) that with the
/// least cost; of equal ones, because the nominal is symmetric, the one with the least turn. Sets
/// equal_poses and runner_up of `out`.
Similarity choose_pose(const RobustFit& robust, Alignment* out);

}  // namespace sketchsplat

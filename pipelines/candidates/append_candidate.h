// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/candidates/known_curves.h"

namespace sketchsplat {

/// Adds a candidate as a stroke of its own, with nodes of its own.
void append_candidate(const Candidate& candidate, Sketch* sketch);

}  // namespace sketchsplat

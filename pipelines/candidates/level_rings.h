// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/unexplained.h"
#include "pipelines/candidates/level_copies.h"

namespace sketchsplat {

/// A circle in a known level, and the number of views whose chains of edgels agree on it.
struct LevelRing {
  Candidate ring;
  int views = 0;
};

/// Circles in the known levels: small holes, of which edgels are too few to match them without
/// their plane. Of every direction in the eight levels that hold the most strokes; those of a level
/// that most views agree on first. `explained`: edgels that tell of something else. None if they
/// are more than `most` in all: texture has rings, too, and views agree on speckles of paint.
std::vector<LevelRing> level_rings(const std::vector<Levels>& levels, const EdgeWorld& world,
                                   const EdgelFlags& explained, size_t most);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "pipelines/options/options.h"
#include "pipelines/options/run.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct FamilyStart {
  Sketch sketch;         ///< empty: the part is none of the family, or there are no siblings
  bool all_free = true;  ///< enough views see every stroke; else some are where the family has them
};

/// The part in the views, by its siblings (options.like): the member of their family that fits
/// best, every stroke then moved onto its own edgels and judged as ever, but that siblings have it
/// counts in its favour. Strokes that fewer than options.select.sure_views views see stay with the
/// family. The part is none of it, and the report says so, if too many of its edgels lie on no
/// stroke, or too many strokes on no edgels. Throws InputError.
FamilyStart start_from_siblings(const EdgeWorld& world, const MethodRun& run);

/// The options for what follows: what siblings know needs no rounds, and what no view sees no
/// polish. What siblings lack and few views show is rather an accident.
ReconstructOptions options_after(const FamilyStart& family, ReconstructOptions options);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pipelines/stages/stages.h"

namespace sketchsplat {

/// snaps.csv: a heading and a row for each length that was made a standard one; nothing, and none
/// of an earlier run, if it was not asked for or the scale is not known. Throws OutputError.
void write_snaps(const std::string& folder, const SnapOutcome& outcome);

/// The same as a JSON object: unit, hypotheses, and the snaps as an array; unit null if the scale
/// is not known.
std::string snap_json(const SnapOutcome& outcome);

}  // namespace sketchsplat

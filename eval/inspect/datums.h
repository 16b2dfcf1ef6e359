// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/inspect/robust_fit.h"

namespace sketchsplat {

/// An edge or a plane of the nominal part that the pose rests on.
struct Datum {
  int edge = -1, plane = -1;
};
/// Throws InputError if the nominal has nothing of this name.
Datum datum_of(const Nominal& nominal, const std::string& name);
/// Is the edge that datum, or does it lie in its plane?
bool belongs(const Nominal& nominal, int edge, const Datum& datum);

/// The pose that the datums of the options hold, in their order, and the best fit what they leave
/// free. Throws InputError if one has no such name or nothing was measured near it.
Similarity fit_to_datums(const RobustFit& robust, Similarity pose);

}  // namespace sketchsplat

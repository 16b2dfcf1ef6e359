// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edges/views/lift.h"
#include "edges/views/match.h"

namespace sketchsplat {

/// Edgels of all views: of every view one flag per edgel.
using EdgelFlags = std::vector<std::vector<char>>;
EdgelFlags no_edgels(const EdgeWorld& world);  ///< all 0

struct ExplainOptions {
  double reach_px = 2.0;  ///< [px] around a curve in which edgels along it are not others' evidence
  double angle_deg = 20;  ///< [deg] largest angle of their planes to its tangent
};

/// Flags the edgels along a curve in every view, be it seen there or not. `samples` (one curve) lie
/// at most two pixels apart.
void explain(const EdgeWorld& world, const CurvePoints& samples, const ExplainOptions& options,
             EdgelFlags* explained);

/// The same in one view.
void explain_in_view(const EdgeWorld& world, int view, const CurvePoints& samples,
                     const ExplainOptions& options, std::vector<char>* explained);

/// The same views with those edgels alone that are not flagged, in runs of at least `min_chain`:
/// shorter rests are corners and noise. Masks are left out, the hull stays.
EdgeWorld unexplained(const EdgeWorld& world, const EdgelFlags& explained, int min_chain);

}  // namespace sketchsplat

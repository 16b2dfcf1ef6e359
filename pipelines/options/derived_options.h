// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/options/options.h"
#include "pipelines/survey/prior_odds.h"

namespace sketchsplat {

/// One price and one least deviation for all that is described.
Prices prices(const ReconstructOptions& options);

/// How strokes are chosen: at that price, by that deviation, and with the tolerance that edges of
/// the detector need. `odds`: of the first strokes, of which rounds and accidents
/// had not been left out yet; without, as the strokes at hand have them.
SelectOptions select_options(const ReconstructOptions& options, const PriorOdds& odds = {});

/// How far strokes reach: within the user's box, and past gaps as the detector leaves them.
ExtentOptions extent_options(const ReconstructOptions& options);

/// The polish before the last one.
PolishOptions early_polish(const ReconstructOptions& options);

/// The last polish: what is nearly one curve becomes one, and only near edgels count.
PolishOptions last_polish(const ReconstructOptions& options);

/// How regularities are weighed: at the price and the least deviation of all that is described, and
/// with the joints that polishing keeps smooth, ten times smoother.
RegularizeOptions regularize_options(const ReconstructOptions& options);

}  // namespace sketchsplat

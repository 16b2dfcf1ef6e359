// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/types/view.h"
#include "edges/image/colours.h"
#include "edges/image/detect.h"

namespace sketchsplat {

/// Which pixels a silhouette whose end errs by less than `slack_px` says to lie on the object, and
/// which around it, up to a fifth of its size away. `mask`: 1 on the object and up to `slack_px`
/// around it.
Image<Side> sides_of(const Image<uint8_t>& mask, double slack_px);

/// Takes from a silhouette, at its end, what the odds (odds_by_colours() of the picture) say to lie
/// around the object. Where colours tell it, it then reaches 2 px beyond the object; `slack_px`
/// becomes 4, if it was more.
void trim_silhouette(const Picture& odds, Image<uint8_t>* mask, double* slack_px);

/// Adds to the edgels of a view outlines that their colours tell better than their brightness does:
/// of `odds`, edgels of the picture's odds_by_colours(), those that lie at the silhouette's end,
/// where `map` shows none of their direction. Runs of fewer than `min_chain` are left out. Without
/// a look-up.
void add_outlines(const EdgelMap& odds, const View& view, const Image<uint8_t>& mask,
                  double slack_px, int min_chain, EdgelMap* map);

}  // namespace sketchsplat

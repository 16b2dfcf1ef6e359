// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/adjust/regularize.h"
#include "pipelines/adjust/standard_hypotheses.h"
#include "pipelines/adjust/standard_series.h"

namespace sketchsplat {

/// How large a world unit is, as far as lengths are to be standard ones.
struct SnapScale {
  double per_world = 1;       ///< mm, or inch for kInch, of a world unit
  double sigma_relative = 0;  ///< of it
};

/// A length that was made a standard one.
struct Snap {
  LengthKind kind = LengthKind::kDiameter;
  std::vector<int> strokes;  ///< ascending
  double measured = 0;       ///< mm or inch, as `standard`, of the sketch without any snap
  double sigma = 0;          ///< its standard deviation, with that of the scale
  double standard = 0;
  std::string series;
  double nats = 0;       ///< by which the description became shorter
  double chi2 = 0;       ///< largest growth of one of its strokes' sum of squares on the edgels
  double chi2_most = 0;  ///< that chance makes in one case of twenty
  double moved_px = 0;   ///< farthest that a place of its strokes went
  double noise_px = 0;   ///< scatter of the edgels about that stroke
};

struct Snapped {
  Sketch sketch;
  std::vector<Snap> snaps;  ///< by stroke
  int hypotheses = 0;       ///< lengths that could have been standard ones
  double scale = 1;         ///< by which SnapScale::per_world is to be multiplied since
  double scale_sigma = 0;   ///< relative
  std::string why_none;     ///< a clause, if nothing could be tried; else empty
};

/// Makes radii and distances standard ones where that makes the description shorter
/// (choose_standards()) and moves no stroke off its edgels by more than their noise: the growth of
/// a stroke's sum of squares in the constrained fit of everything together is one that chance makes
/// in one case of twenty (chi squared, as many degrees of freedom as lengths were set), and no
/// place of it goes farther than the edgels scatter. Where one does, the length that saves least of
/// those of the worst stroke is set free again. Sigmas hold what edgels do not know: what all views
/// get wrong of a stroke, and the pull of blur towards the centre of round ones.
/// `regular`: the sketch after regularize(), of which nothing is let go.
Snapped snap_to_standards(const Regularized& regular, const StrokeObservation& seen,
                          double footprint, const SnapScale& scale, StandardSystem system,
                          const RegularizeOptions& options);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include "edges/lift.h"
#include "pipelines/observe.h"
#include "sketches/sketch.h"
#include "topology/remap.h"

namespace sketchsplat {

struct SelectOptions {
  int min_views = 4;           ///< that must see a stroke by edgels no better stroke explains
  double min_cover = 0.5;      ///< share of its length that min_views views see
  double max_rms_px = 0.3;     ///< [px] scatter of its edgels, beyond that of the scene
  double still_rms_px = 0.3;   ///< [px] the same of what lies still in half of the views, if larger
  double max_bias_px = 0.12;   ///< [px] offset in half of the views, beyond that scatter
  double max_width = 1.25;     ///< width of its edgels over that of the scene's sharp edges
  double min_seen = 0.22;      ///< share of the sure sightings with an edgel, if it lies still
  double min_sure = 0.25;      ///< sure sightings that tell something, per sighting
  double min_length_px = 4.0;  ///< [px]
  double price = 3;            ///< [nat] of a parameter, see SegmentOptions
  double place_sigma_px = 0.2;  ///< [px] see place_sigma_px
};

/// Why a stroke was not kept; the first reason that holds.
enum class Verdict {
  kKept,
  kShort,      ///< shorter than min_length_px
  kUncovered,  ///< too little of it is seen by enough views
  kScattered,  ///< its edgels do not lie on it
  kMoving,     ///< it lies elsewhere in every view: the contour of a curved surface
  kBlurred,    ///< no sharp edge
  kUnseen,     ///< views that must see it do not
  kRedundant,  ///< better strokes explain its edgels
};
const char* verdict_name(Verdict verdict);

struct Selection : PassResult {
  std::vector<Verdict> verdicts;   ///< one per stroke that came in
  std::vector<StrokeStats> stats;  ///< what the verdicts rest on
  std::vector<double> seen;  ///< share of the sure sightings with an edgel; -1 if none is sure
};

/// Keeps the fewest strokes that explain the edgels: best supported first, a stroke stays if the
/// places where enough views see what no stroke before it explains would cost more without it, as
/// outliers, than its parameters and nodes do, and if it lies still in
/// space (contours of curved surfaces move with the view) and is as sharp as edges here are. A
/// stroke that few views see meets others' edgels in those that do not see it: where these would
/// condemn it, it is judged by the edgels alone that lie beside no better stroke.
Selection select_strokes(const Sketch& sketch, const EdgeWorld& world,
                         const SelectOptions& options);

}  // namespace sketchsplat

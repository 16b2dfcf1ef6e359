// SPDX-License-Identifier: MIT
// In: texts of options. Out: the structs of all stages, checked. This folder may not include
// cameras, the method, or what is written of it.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "edges/views/lift.h"
#include "pipelines/adjust/optimize.h"
#include "pipelines/adjust/polish.h"
#include "pipelines/adjust/regularize.h"
#include "pipelines/base/deadline.h"
#include "pipelines/base/fields.h"
#include "pipelines/candidates/add_missing.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/join/close_graph.h"
#include "pipelines/join/rechain.h"
#include "pipelines/join/splice.h"
#include "pipelines/options/common_options.h"
#include "pipelines/survey/extent.h"
#include "pipelines/survey/select.h"
#include "sketches/fit/segment.h"
#include "topology/passes/simplify.h"

namespace sketchsplat {

/// Everything that decides what `reconstruct` computes. Stage structs are members of this one.
struct ReconstructOptions : DetectionOptions {
  std::string without = "none";  ///< steps that are left out, as the user names them
  std::string preset = "balanced";
  /// Pictures at least twice as large are made smaller, to no less than this [px], see
  /// smaller_pictures.h; 0: never.
  int least_side = 1200;
  std::string refine_poses = "auto";  ///< see refine_poses.h
  std::string solid = "auto";         ///< "off": none is looked for; "require": must be found
  LiftOptions lift;
  SegmentOptions segment;
  SelectOptions select;
  ExtentOptions extent;
  OptimizeOptions optimize;
  TopologyOptions topology;
  PolishOptions polish;
  SpliceOptions splice;
  RechainOptions rechain;
  MissingOptions missing;
  CloseOptions close;
  RegularizeOptions regularize;
  int rounds = 3;            ///< of drawing, moving and simplifying; fewer if nothing changes
  bool simplify = true;      ///< run the topology passes between the rounds
  bool early_polish = true;  ///< least squares on the edgels in the fit and between the rounds, too
  bool second_look = true;   ///< at the edgels that no stroke explains
  bool silhouettes = true;   ///< told by colours, where there are no masks
  bool final_polish = true;  ///< end on the edgels themselves
  bool blends = false;            ///< find rounded edges, too; no strokes
  bool inferred = true;           ///< edges that no image shows and the solid implies
  std::string like;               ///< sketches of siblings, one a line; empty: none
  std::string like_folder;        ///< that these are below, if they are relative; not recorded
  double min_confidence = 0;      ///< probability below which a stroke is left out at last
  std::string box_text = "auto";  ///< as the user gives it
  Eigen::AlignedBox3d box;  ///< world units: only what is in it is the object; empty: found out
  bool tags = false;        ///< measure AprilTags; what is on them is not the object
  double budget = 0;        ///< [s] after which nothing is refined any more; 0: none
  Deadline deadline;        ///< of this run: set by reconstruct()
};

/// The members of the option structs, as --help, reports and README show them. To add an option: a
/// member with its default in the struct, and one line in options.cc.
void list_fields(DetectionOptions* options, Fields* fields);
void list_fields(ReconstructOptions* options, Fields* fields);

/// Sets what the preset (a name in preset_names()) stands for, leaves the rest alone. "balanced" is
/// the defaults.
void apply_preset(const std::string& preset, ReconstructOptions* options);

/// Sets options as a command line with these would, in this order. Throws UsageError.
void set_options(const OptionTexts& texts, ReconstructOptions* options);

}  // namespace sketchsplat

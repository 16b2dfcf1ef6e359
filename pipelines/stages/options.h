// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "edges/views/lift.h"
#include "edges/views/match.h"
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
#include "pipelines/survey/describe.h"
#include "pipelines/survey/extent.h"
#include "pipelines/survey/select.h"
#include "sketches/fit/segment.h"
#include "sketches/io/length_unit.h"
#include "topology/faces/planar_faces.h"
#include "topology/passes/simplify.h"

namespace sketchsplat {

/// What every verb understands.
struct CommonOptions {
  int threads = 0;  ///< 0: one per core. Results do not depend on it
  int seed = 0;
  bool quiet = false;
  bool verbose = false;
  bool json = false;                ///< results on standard output as JSON
  std::string log;                  ///< file for everything that is said, too; empty: none
  std::string config, save_config;  ///< files of options, see config_file.h; empty: none
};

/// Everything that decides what `reconstruct` computes. Stage structs are members of this one.
struct ReconstructOptions : DetectionOptions {
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
  /// [px] standard deviation of the edgels of surfels about their edge, see EvidenceModel
  double surfel_sigma_px = 0.25;
  /// Of edges that surfels tell of, if above extent.gap_price: print hides edges that it crosses
  double surfel_gap_price = 2;
  bool blends = false;            ///< find rounded edges, too; no strokes
  double blend_px = 40;           ///< [px] largest radius of one
  bool inferred = true;           ///< edges that no image shows and the solid implies
  std::string like;               ///< sketches of siblings, one a line; empty: none
  std::string like_folder;        ///< that these are below, if their paths are relative; not told
  double min_confidence = 0;      ///< probability below which a stroke is left out at last
  std::string box_text = "auto";  ///< as the user gives it
  Eigen::AlignedBox3d box;  ///< world units: only what is in it is the object; empty: found out
  bool tags = false;        ///< measure AprilTags; what is on them is not the object
  double budget = 0;        ///< [s] after which nothing is refined any more; 0: none
  Deadline deadline;        ///< of this run: set by reconstruct()
};

/// What files for CAD programs say beside the curves.
struct CadOptions {
  LengthUnit unit = LengthUnit::kMillimetre;  ///< of the numbers in the file
  double scale = 1.0;                         ///< units per world unit
  std::string scale_by = "none";              ///< what tells the scale instead, see known_scale.h
  bool unit_given = false, scale_given = false;  ///< by the user
  bool faces = false;                            ///< closed planar loops as faces, in STEP
  PlanarFaceOptions face;
};

/// What is written beside the sketch, and how.
struct OutputOptions {
  int overlays = 4;              ///< views that are drawn over
  double point_spacing = 0.005;  ///< fraction of the sketch's largest extent
  bool shell = false;            ///< the faces that are sure, where they do not close to a solid
  bool reproducible = false;     ///< no times, memory and threads in the reports
  CadOptions cad;                ///< of sketch.step
};

/// The members of the option structs, as --help, reports and README show them. To add an option: a
/// member with its default in the struct, and one line in options.cc.
void list_fields(CommonOptions* options, Fields* fields);
void list_fields(DetectionOptions* options, Fields* fields);
void list_fields(ReconstructOptions* options, Fields* fields);
void list_fields(CadOptions* options, Fields* fields);
void list_fields(OutputOptions* options, Fields* fields);

/// One price and one least deviation for all that is described.
Prices prices(const ReconstructOptions& options);

/// Sets what the preset (a name in preset_names()) stands for, leaves the rest alone. "balanced" is
/// the defaults.
void apply_preset(const std::string& preset, ReconstructOptions* options);
std::vector<std::string> preset_names();

/// Option names (as after "--") and the texts of their values.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

/// Sets options as a command line with these would, in this order. Throws UsageError.
void set_options(const OptionTexts& texts, ReconstructOptions* options);

}  // namespace sketchsplat

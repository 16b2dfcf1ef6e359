// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/readers/scene.h"
#include "edges/tags/tag_square.h"
#include "edges/views/lift.h"
#include "pipelines/adjust/optimize.h"
#include "pipelines/adjust/regularize.h"
#include "pipelines/base/run_report.h"
#include "pipelines/stages/options.h"
#include "pipelines/survey/rounded.h"

namespace sketchsplat {

/// Finds the edgels of every view by the detector (detectors.h). Frames that cannot be read are
/// left out with a warning. Throws TooLittleError if fewer than three views hold edges, InputError
/// if no image, or no map of that name, can be read. What lies on tags is left out.
EdgeWorld detect_scene(const Scene& scene, Detector* detector, const std::vector<TagSquare>& tags,
                       const ReconstructOptions& options, RunReport* report, Progress* progress);

/// Without masks: finds the object among other things (find_object.h) by the most meaningful edges,
/// and leaves out edgels that cannot be of it. With masks nothing changes. If the user gave a box,
/// the object is what lies in it, with masks or without.
EdgeWorld focus_on_object(EdgeWorld world, const ReconstructOptions& options, RunReport* report,
                          Progress* progress);

/// Without masks, where the object is known (focus_on_object): its silhouettes, told by colours, if
/// those of nearly all views agree (silhouettes.h); a detector that looks at single pictures looks
/// again at what lies on them, and for outlines by colours (outlines.h). `scene`: of the world's
/// views.
EdgeWorld tell_silhouettes(const Scene& scene, const Detector& detector, EdgeWorld world,
                           const ReconstructOptions& options, RunReport* report,
                           Progress* progress);

/// The space sweep over all edgels. Throws TooLittleError if no point is found.
std::vector<EdgePoint> lift_scene(const EdgeWorld& world, const ReconstructOptions& options,
                                  RunReport* report, Progress* progress);

/// How strokes are chosen: at one price and by one least deviation for all that is described, and
/// with the tolerance that edges of the detector need (surfel_sigma_px).
SelectOptions select_options(const ReconstructOptions& options);

/// How regularities are weighed: at the price and the least deviation of all that is described, and
/// with the joints that polishing keeps smooth, ten times smoother.
RegularizeOptions regularize_options(const ReconstructOptions& options);

struct FirstStrokes {
  Sketch sketch;
  double nats = 0;  ///< sum of the likelihood ratios [nat] by which they were chosen (select.h)
};

/// Strokes from lifted points: linked to chains, cut into the simplest curves, moved onto the
/// edgels, chosen by what they explain, and as long as the views see them.
FirstStrokes fit_strokes(const std::vector<EdgePoint>& points, const EdgeWorld& world,
                         const ReconstructOptions& options, RunReport* report, Progress* progress);

/// The sketch without strokes of which the detector knows that most of what it knows about lies on
/// a smooth surface: print (Detector::judge).
Sketch drop_print(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                  RunReport* report, Progress* progress);

/// The sketch without strokes of things beside the object (survey/other_things.h).
Sketch drop_things(const Sketch& sketch, const EdgeWorld& world, RunReport* report,
                   Progress* progress);

/// Rounds, until the graph does not change any more or `options` say so: strokes are drawn and
/// moved (optimize) if `options` have steps, weighed, and the graph is simplified; what it says
/// then is moved by least squares.
Sketch run_rounds(Sketch sketch, const EdgeWorld& world, const std::vector<EdgeTarget>& targets,
                  const ReconstructOptions& options, RunReport* report, Progress* progress);

/// Strokes of the edgels that no stroke of `sketch` explains, not chosen yet. They are few, so that
/// fewer views need to agree on a point.
Sketch strokes_of_rest(const Sketch& sketch, const EdgeWorld& world,
                       const ReconstructOptions& options);

/// A second look, at the edgels that no stroke explains (strokes_of_rest): nothing pulls at
/// what they show. Strokes that come of it are chosen among the
/// others as all are; if one was, one more round follows.
Sketch look_again(const Sketch& sketch, const EdgeWorld& world,
                  const std::vector<EdgeTarget>& targets, const ReconstructOptions& options,
                  RunReport* report, Progress* progress);

/// Gaps and loose ends closed where that takes fewer words.
Sketch close_sketch(const Sketch& sketch, const EdgeWorld& world, const ReconstructOptions& options,
                    RunReport* report);

/// A sketch with the edges that were missing.
struct WithMissing {
  Sketch sketch;
  std::vector<Eigen::Vector3d> corners;  ///< in pockets, where copies of rims end (add_missing.h)
  std::vector<ControlPoints> rings;      ///< circles of patterns and floors
};

/// Edges added that the others lead to expect and that the pictures show (add_missing.h), if they
/// are edges more probably than not, or floor and walls that bear one another out, and of no other
/// thing (drop_things). Nothing without pictures: other detectors' edgels are of something else.
WithMissing add_missing_edges(const Sketch& sketch, const EdgeWorld& world,
                              const ReconstructOptions& options, RunReport* report,
                              Progress* progress);

/// A sketch with what is known of it.
struct FinishedSketch {
  Sketch sketch;                  ///< with evidence
  std::vector<Regularity> kept;   ///< relations that its strokes keep to
  std::vector<Numbers> features;  ///< per stroke: what its confidence was made of
  int unsure = 0;                 ///< strokes that were left out as less probable than asked for
  int rounded = 0;                ///< and others that were left out as rounded edges
  double edgel_sigma_px = 0;      ///< of the edgels about the strokes
};

/// As the options say, but that what is nearly one curve becomes one.
PolishOptions last_polish(const ReconstructOptions& options);

/// Last polish on the edgels, regularities, and the evidence. Corners in pockets and rings of
/// patterns that move by more than a pixel go back: few views see them, and others what hides them.
FinishedSketch finish_sketch(const WithMissing& all, const EdgeWorld& world,
                             const ReconstructOptions& options, RunReport* report,
                             Progress* progress);

/// Fills in evidence and features. `implied`: per stroke the probability that something else than
/// the images gives it, or none. A stroke that is probable by this alone has the evidence of one
/// that no view sees.
void judge_strokes(const EdgeWorld& world, const ReconstructOptions& options,
                   const std::vector<double>& implied, FinishedSketch* finished);

/// Leaves out strokes that are rounded edges after all (rounded.h) and those of a confidence under
/// that of the options. Throws TooLittleError if none is left. Returns what each stroke is called
/// now, -1 for those left out.
std::vector<int> leave_out_doubtful(const StrokeOrigins& origins, const EdgeWorld& world,
                                    const ReconstructOptions& options, FinishedSketch* finished);

/// Fills the report's strokes, regularities (by curve, see curve_chain.h) and counts.
void report_sketch(const FinishedSketch& finished, const EdgeWorld& world, RunReport* report);

/// Of every view, in the order that Evidence::views counts in.
std::vector<std::string> view_names(const EdgeWorld& world);

}  // namespace sketchsplat

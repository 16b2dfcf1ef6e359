// SPDX-License-Identifier: MIT
// In: a reconstruction, and how large its world is. Out: all files of a result.
// This folder may not include command lines.
#pragma once

#include <string>

#include "pipelines/method/reconstruct.h"
#include "pipelines/options/options.h"
#include "pipelines/options/output_options.h"
#include "pipelines/pages/page_photos.h"
#include "pipelines/results/known_scale.h"
#include "sketches/io/io.h"

namespace sketchsplat {

constexpr double kPointSpacing = 0.005;  ///< of the samples in edge_points.ply, of the extent

/// Writes everything that `reconstruct` promises into the folder: sketch.json,
/// parametric_edges.json, sketch.obj, cameras/ (if they were refined), sketch.step,
/// edge_points.ply, the files of write_solid() (if a solid was found), overlay_<view>.png,
/// report.json and report.html. The time that this takes becomes a stage of the report. sketch.obj,
/// STEP and tables are at the scale that is returned, the others in world units. Throws
/// OutputError; TooLittleError, when all is written, if a solid is required and there is none.
/// `album`: of the scene, photographs for the report.
KnownScale write_outputs(const std::string& folder, Reconstruction reconstruction,
                         const Scene& scene, const PhotoAlbum& album,
                         ReconstructOptions reconstruct_options, OutputOptions output_options,
                         Progress* progress);

/// Options of write_step for this sketch.
StepOptions step_options(const Sketch& sketch, const std::string& name, const CadOptions& options);

}  // namespace sketchsplat

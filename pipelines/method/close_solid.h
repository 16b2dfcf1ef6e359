// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/lift.h"
#include "pipelines/base/run_report.h"
#include "pipelines/detectors/detectors.h"
#include "pipelines/stages/options.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// Which places of the strokes each view sees, rays through pixels well inside and well outside of
/// the masks, and lines of sight through edgels that no stroke explains.
SolidEvidence solid_evidence(const Sketch& sketch, const EdgeWorld& world);

/// The solid that the strokes bound, or why there is none; see find_solid.h. None, too, if the
/// views show edges that it lacks (lacking_edges.h). Never throws for want of one.
SolidSearch close_solid(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                        const ReconstructOptions& options, RunReport* report, Progress* progress);

}  // namespace sketchsplat

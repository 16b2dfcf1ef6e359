// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "edges/views/lift.h"
#include "pipelines/base/deadline.h"
#include "pipelines/survey/observe.h"
#include "raster/splats/loss.h"
#include "raster/splats/splats.h"

namespace sketchsplat {

/// Which sample is seen in which view, by the evidence: N x V, 1 where an edgel answers the sample,
/// or its neighbours along the stroke within `gap` samples on both sides; 0 where the stroke is
/// hidden (or its edge has no contrast): there nothing must be drawn.
Eigen::MatrixXf sample_visibility(const Observation& observation, int num_views, int gap);

struct OptimizeOptions {
  int steps = 0;            ///< gradient steps per round; 0 leaves the sketch alone, 8 move it
  double spacing_px = 2.0;  ///< [px] between splats
  double sigma_px = 1.0;    ///< [px] width of the edges in the edge maps
  bool visibility = true;   ///< draw nothing where a stroke is hidden
  int gap = 4;              ///< samples: see sample_visibility
  Deadline deadline;        ///< no step after it
};

/// The edge maps that renderings are compared with, one per view; none if there are no steps.
std::vector<EdgeTarget> make_targets(const EdgeWorld& world, const OptimizeOptions& options);

/// Strokes as they are drawn: `width` and `depth` are one per stroke.
struct Drawing {
  Sketch sketch;
  Eigen::VectorXd width;  ///< standard deviation of the splats across the stroke, world units, > 0
  Eigen::VectorXd depth;  ///< optical depth of the splats at their middle, > 0
};

/// A Gaussian per sample: as long as its piece of the stroke, so that their sum is an even ridge.
Splats draw_splats(const Drawing& drawing, const SampleLayout& layout);

/// Gradient of a scalar by all that descends.
struct DrawingGradient {
  SketchGradient sketch;
  Eigen::VectorXd log_width, log_depth;  ///< by the logarithms, one per stroke
};

/// Loss of the drawing against the edge maps, summed over the views, and its gradient (may be
/// null): samples, splats, pictures, pixels and all the way back. `visibility` as in
/// render_loss_views.
double edge_loss(const Drawing& drawing, const SampleLayout& layout,
                 const Eigen::MatrixXf& visibility, const std::vector<View>& views,
                 const std::vector<EdgeTarget>& targets, DrawingGradient* gradient);

struct OptimizeResult {
  Sketch sketch;
  double initial_loss = 0, final_loss = 0;  ///< sum over all views
  int splats = 0;
};

/// Draws the strokes as Gaussians into every view, compares with the edge maps and moves nodes and
/// handles, and each stroke's scale and opacity, down the gradient (Adam). Opacities end up in the
/// evidence of the strokes.
OptimizeResult optimize(const Sketch& sketch, const EdgeWorld& world,
                        const std::vector<EdgeTarget>& targets, const OptimizeOptions& options);

}  // namespace sketchsplat

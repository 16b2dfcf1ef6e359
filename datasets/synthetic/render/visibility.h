// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/synthetic/cad/truth.h"
#include "datasets/synthetic/render/tracer.h"
#include "datasets/types/image.h"
#include "datasets/types/view.h"

namespace sketchsplat {

// Everything in one frame, that of the tracer.

/// A point of an edge is in the picture and nothing hides it. The ray starts `lift` into the free
/// space between the edge's faces (`outward`), further than triangles stray from the surface; where
/// there is none, `lift` on the way to the eye.
bool sees(const View& view, const Tracer& tracer, const Eigen::Vector3d& point,
          const Eigen::Vector3d& outward, double lift);

/// Fills visible_views: how many views see each point.
void count_views(const Tracer& tracer, const std::vector<View>& views, double lift,
                 TruthCurve* curve);

/// The visible pieces of the true edges in one picture.
struct VisibleEdges {
  std::vector<Eigen::Matrix2Xd> polylines;  ///< 2 x N, N >= 2  [px], at most 1 px between points
  std::vector<int> curve;                   ///< one per polyline: of which true edge
};

/// Ends where something begins to hide an edge are found to about 0.05 px; pieces shorter than
/// 0.25 px are left out.
VisibleEdges visible_edges(const View& view, const Tracer& tracer,
                           const std::vector<TruthCurve>& curves, double lift);

/// Polylines as lines one pixel wide: how much of a pixel is covered, in [0, 1].
Image<float> draw(const VisibleEdges& edges, int width, int height);

/// {"polylines": [[[x, y], ...], ...], "curve": [index, ...]}, to a thousandth of a pixel.
std::string to_json(const VisibleEdges& edges);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// What a file tells about a stroke beside where it is.
struct StrokeFacts {
  std::string name;    ///< as the file calls it, or its index
  std::string kind;    ///< "line", "arc", "circle", "ellipse", "elliptic_arc", "bezier", "polyline"
  int parameters = 0;  ///< degrees of freedom, see eval/metrics/parameters.h
};

/// Edges to be judged: primitives, or points that are taken as the samples as they are.
struct Prediction {
  std::string path;                                 ///< file that was read
  std::vector<Eigen::Matrix<double, 3, 2>> lines;   ///< end points
  std::vector<Eigen::Matrix<double, 3, 4>> curves;  ///< control points of cubic Beziers
  Eigen::Matrix3Xd points;                          ///< 3 x N; only if there are no primitives
  bool points_only = false;                         ///< `points` counts, even if it is empty
  /// Samples of each stroke, 3 x N each: which primitives or points belong together. Empty if the
  /// file does not say; then every primitive is a stroke of its own.
  std::vector<Eigen::Matrix3Xd> strokes;
  std::vector<StrokeFacts> facts;  ///< of each stroke; as many, or none if the file does not say
};

/// Reads by name and content:
///   *.json  EMAP's {lines_end_pts, curves_ctl_pts}, {lines, curves}, {points}, a sketch graph, or
///           NEF's {scene_name, curves_ctl_pts}, brought to the frame of ABC-NEF's scenes
///   *.ply   points, with the strokes if a property tells (edge_points.ply, gaussians_all.ply)
///   *.obj   `v` and `l`: each consecutive pair of an `l` is a line, each `o` (or `l`) a stroke
///   folder  the first of parametric_edges.json (with the strokes of sketch.json or
///           edge_points.ply beside it),
///           fitting/parametric_edges.json, gaussians_all.ply, edge_points.ply, sketch.json,
///           sketch.obj
/// Throws InputError.
Prediction read_prediction(const std::string& path);

/// What read_prediction() reads from the sketch.json of this sketch.
Prediction prediction_of(const Sketch& sketch);

/// Is there a file that read_prediction() would read (broken or not)?
bool has_prediction(const std::string& path);

}  // namespace sketchsplat

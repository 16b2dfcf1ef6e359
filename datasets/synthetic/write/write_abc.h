// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/synthetic/scene/synthesize.h"

namespace sketchsplat {

/// A scene's truth as the ABC data set ships it, in the units of the CAD file:
///   feat/model_features_000.yml  curves (sharp, and smooth seams as sharp: false) and surfaces,
///   obj/model_trimesh_000.obj    the points of the curves, which the features number, then a mesh,
///   chunk_0000_stats.json        counts, types and the box of model "model".
/// Normalised by that box it is the scene's truth at extent 1. What ABC's definition of a curve
/// cannot hold (an arc of an ellipse that was not recognised) is a B-spline. Differences: vertex
/// parameters of circles are radians throughout; surfaces carry their type and their triangles, but
/// no parameters of their own.
/// Returns (path, content) of each file.
std::vector<std::pair<std::string, std::string>> abc_files(const SyntheticScene& scene);

}  // namespace sketchsplat

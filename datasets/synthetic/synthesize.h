// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/image.h"
#include "datasets/synthetic/brep.h"
#include "datasets/synthetic/render.h"
#include "datasets/synthetic/rig.h"
#include "datasets/synthetic/tracer.h"
#include "datasets/synthetic/truth.h"
#include "datasets/view.h"

namespace sketchsplat {

struct SynthesizeOptions {
  std::string part = "box-hole";  ///< one of part_names(), or the path of a STEP or mesh file
  std::uint64_t seed = 1;         ///< of the part's dimensions, the cameras and the noise
  double extent = 1.0;            ///< longest side of the object [world units], > 0
  double smooth_angle_deg = 1.0;  ///< faces that meet at less have no edge [deg], (0, 90)
  double crease_deg = 30.0;  ///< faces of a mesh that meet at more have an edge [deg], [1, 180]
  double deflection = 2e-5;  ///< of the triangles that are rendered [extents], [1e-6, 1e-2]
  RigOptions rig;
  RenderOptions render;
};

/// A part, its true edges and its cameras. The object's box is centred at (0.5, 0.5, 0.5) extents.
struct SyntheticScene {
  SynthesizeOptions options;
  Truth truth;                   ///< world units
  std::vector<View> views;       ///< world units
  std::vector<View> unit_views;  ///< the same in the unit frame, where rendering happens
  Eigen::Matrix3Xd hints;        ///< 3 x N  points along all edges, unit frame
  Tracer tracer;                 ///< the mesh, unit frame
};

/// Throws InputError if there is no such part or file, if it holds no sharp edge, or if an option
/// lies outside its range.
SyntheticScene synthesize(const SynthesizeOptions& options);

/// The picture of one view; any number of threads may ask at once.
Picture render(const SyntheticScene& scene, int view);

/// Writes a scene folder in the layout of ABC-NEF as EMAP ships it:
///   meta_data.json (last, so that a folder that has it is whole), color/<k>_colors.png,
///   groundtruth/gt.json: list of {"type", "closed", "points": [[x, y, z], ...],
///     "visible_views": [n, ...] one per point, "dihedral_deg"},
///   groundtruth/sketch.json: the same edges as a sketch graph.
/// Views are rendered in parallel (OpenMP). Throws OutputError.
void write_scene(const SyntheticScene& scene, const std::string& folder);

}  // namespace sketchsplat

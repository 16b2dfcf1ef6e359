// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "datasets/synthetic/cad/brep.h"
#include "datasets/synthetic/cad/truth.h"
#include "datasets/synthetic/catalogue/outputs.h"
#include "datasets/synthetic/catalogue/part_table.h"
#include "datasets/synthetic/photo/photo_light.h"
#include "datasets/synthetic/photo/photo_options.h"
#include "datasets/synthetic/render/clutter.h"
#include "datasets/synthetic/render/degrade.h"
#include "datasets/synthetic/render/render.h"
#include "datasets/synthetic/render/rig.h"
#include "datasets/synthetic/render/tracer.h"
#include "datasets/types/image.h"
#include "datasets/types/view.h"

namespace sketchsplat {

struct SynthesizeOptions {
  std::string part = "box-hole";  ///< one of part_names(), or the path of a STEP or mesh file
  std::uint64_t seed = 1;         ///< of the part's dimensions, the cameras and the noise
  PartValues parameters;          ///< of a built-in part, instead of what the seed gives
  double extent = 1.0;            ///< longest side of the object [world units], > 0
  double smooth_angle_deg = 1.0;  ///< faces that meet at less have no edge [deg], (0, 90)
  double crease_deg = 30.0;  ///< faces of a mesh that meet at more have an edge [deg], [1, 180]
  double deflection = 2e-5;  ///< of the triangles that are rendered [extents], [1e-6, 1e-2]
  RigOptions rig;
  RenderOptions render;
  PhotoOptions photo;  ///< of Style::kPhoto
  DegradeOptions degrade;
  std::string outputs = "all";  ///< what is written beside the images: see parse_outputs
};

/// A part, its true edges and its cameras. The object's box is centred at (0.5, 0.5, 0.5) extents.
struct SyntheticScene {
  SynthesizeOptions options;               ///< the rig resolved()
  Truth truth;                             ///< world units
  std::vector<View> views;                 ///< world units
  std::vector<View> unit_views;            ///< the same in the unit frame, where rendering happens
  std::vector<TruthCurve> unit_curves;     ///< truth.curves in the unit frame
  Eigen::Matrix3Xd hints;                  ///< 3 x N  points along all edges, unit frame
  Tracer tracer;                           ///< the mesh, unit frame
  std::shared_ptr<const Clutter> clutter;  ///< what stands behind it; null if nothing
  std::shared_ptr<const PhotoWorld> photo;  ///< of Style::kPhoto; unit frame
  double lift = 0;  ///< how far rays that leave the surface start above it, unit lengths
  Brep brep;        ///< in units of its own; empty for a mesh
  UnitFrame frame;  ///< from these to the unit frame
};

/// Throws InputError if there is no such part or file, if it holds no sharp edge, or if an option
/// lies outside its range.
SyntheticScene synthesize(const SynthesizeOptions& options);

/// One view, its image and what is known about its pixels. Of a photograph: the picture before it
/// is compressed, and the mask; the other maps are empty.
struct RenderedView {
  Picture picture;
  Image<float> mask;  ///< coverage by the object, in [0, 1], neither blurred nor noisy
  Image<float>
      depth;  ///< z in the camera of what the pixel's middle sees [world units]; 0: nothing
  /// Unit normal of the surface there, towards the camera, in its axes (x right, y down, z
  /// forward); zero where there is nothing.
  Image<float> normal_x, normal_y, normal_z;
};

/// Any number of threads may ask at once.
RenderedView render_view(const SyntheticScene& scene, int view);
Picture render(const SyntheticScene& scene, int view);  ///< its picture alone

/// Writes a scene folder: write_photos() for Style::kPhoto, else in the layout of ABC-NEF as EMAP
/// ships it:
///   meta_data.json (last, so that a folder that has it is whole), color/<k>_colors.png,
///   groundtruth/gt.json: list of {"type", "closed", "points": [[x, y, z], ...],
///     "visible_views": [n, ...] one per point, "dihedral_deg"},
///   groundtruth/sketch.json: the same edges as a sketch graph;
///   groundtruth/part.step: the part itself in world units (not of a mesh);
/// and of the outputs that were asked for, whatever happens to the image:
///   mask/<k>.png, depth/<k>.exr (channel Z, 32 bits), normal/<k>.exr (R, G, B = x, y, z, 16 bits),
///   as RenderedView says, edges_visible/<k>.png and .json: as draw() and to_json() of the visible
///   pieces of the true edges, whose "curve" counts the entries of gt.json.
/// Views are rendered in parallel (OpenMP). Throws OutputError.
void write_scene(const SyntheticScene& scene, const std::string& folder);

/// What is in a folder that write_scene() has finished, written last.
inline constexpr const char* kLastFiles[] = {"meta_data.json", "scene.json"};

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "datasets/types/geometry_maps.h"
#include "edges/surfels/fit/surfel_cylinders.h"
#include "edges/surfels/fit/surfel_moves.h"
#include "edges/surfels/fit/surfel_planes.h"
#include "edges/surfels/model/surfel_loss.h"
#include "edges/surfels/model/surfel_set.h"
#include "edges/surfels/model/surfel_shading.h"
#include "edges/surfels/start/photo_hull.h"

namespace sketchsplat {

enum class SurfelDensity { kSteep, kCloneSplit, kFixed };

struct SurfelFieldOptions {
  SurfelKernel kernel = SurfelKernel::kGaussian;
  bool shading = true;  ///< colours follow normals; else each surfel has its own
  SurfelDensity density = SurfelDensity::kSteep;
  bool merge = true;
  int surfels = 6000;       ///< at the start
  int most_surfels = 8000;  ///< ever
  int renderings = 1200;    ///< of a view, forward and backward, at the most
  int side_px = 800;        ///< [px] longer side of the pictures at the end; a quarter of it first
  int pixels = 80000;       ///< of the object in a picture, mean: larger pictures are made smaller
  int batch = 2;            ///< views per step
  double common_albedo = 0.3;  ///< weight of the surfels' departure from one albedo
  double smoothness = 0.3;     ///< weight of neighbours' departure from a common plane
  double mode_deg = 25;        ///< [deg] of what is one surface at a pixel, see render_geometry
  SurfelLossOptions loss;
  PhotoHullOptions hull;
  MoveOptions moves;          ///< before each level, where there is print
  PlaneOptions planes;        ///< at the end
  CylinderOptions cylinders;  ///< at the end, of what makes no plane
};

/// Evenness of colours, see SurfelField, above which little can be print.
constexpr double kEven = 0.5;

/// Surfels that look like the pictures.
struct SurfelField {
  SurfelSet surfels;
  Illumination illumination;  ///< all 0 if colours do not follow normals
  double evenness = 1;  ///< how far light and normals alone explain the colours, [0, 1]
  SurfelOptions drawing;
  double spacing = 0;      ///< of the first surfels, world units
  std::vector<double> losses;  ///< mean of each tenth of the steps
  int first_count = 0, split = 0, merged = 0, pruned = 0, moved = 0, flat = 0, round = 0;
  int planes = 0, emptied = 0;  ///< see SurfaceSamples
  int renderings = 0;
  int side_px = 0;  ///< longer side of the largest pictures it was fitted to
  SurfelCloud cloud() const;  ///< with the colours that are drawn
};

/// Fits surfels (2D Gaussian splatting, Huang et al., SIGGRAPH 2024) to views of one object, coarse
/// to fine: starts on the photo hull, which `sure` edges help to carve; per level, moves to planes
/// of neighbours where there is print, then Adam on mini-batches in a fixed order and density
/// control until the loss stops; at last what makes a plane or a cylinder is laid on it. `views` at
/// side_px or above; `bounds` hold the object. `step`, if given, is called after every rendering.
/// The same bytes for any number of threads. Precondition: at least one view. No surfels if the
/// hull is empty.
SurfelField train_surfels(const std::vector<TrainingView>& views,
                          const Eigen::AlignedBox3d& bounds, const SurfelFieldOptions& options,
                          const SureEdges& sure = {}, const std::function<void()>& step = {});

/// What the field looks like from a view: depth and unit normals where alpha >= 1/2, else none. Of
/// the surfels that make a pixel those count that lie with the heaviest part of them on one
/// surface: normals within `mode_deg` of each other and on one plane to the spacing; 0: all of
/// them, blended.
GeometryMaps render_geometry(const SurfelField& field, const View& view, double mode_deg);

/// PLY (binary, little endian) in the layout that viewers of 2DGS open: x, y, z, nx, ny, nz,
/// f_dc_0..2, opacity (logit), scale_0, scale_1 (logarithms), rot_0..3 (w, x, y, z). Returned as
/// bytes.
std::string surfel_ply(const SurfelField& field);

}  // namespace sketchsplat

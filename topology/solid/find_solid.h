// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sketches/graph/solid.h"
#include "topology/solid/evidence.h"

namespace sketchsplat {

struct SolidOptions {
  double tolerance = 1.5e-3;  ///< of a stroke from the surface that it lies on; of the extent
  double face_price = 3;      ///< [nat] of a face
  /// [nat] more of one that is no plane and no cylinder: of ten faces of parts nine are.
  double rare_price = 2;
  double smooth_price = 1;  ///< [nat] of an inferred edge along which surfaces touch
  double faint_price = 6;   ///< [nat] of one that images should have shown
  double copy_price = 2;    ///< [nat] of one that other strokes ask for, see EdgeOrigin
  double double_price = 4;  ///< [nat] of a stroke that is another one, seen twice
  double open_price = 5;    ///< [nat] at most, of an edge of a shell that borders one face
  double margin = 4;        ///< [nat] by which the second-best choice must be worse
  /// Share of the rays through masks that may contradict the solid.
  double contradicted = 2e-3;
  /// Cameras that must see a cone at every height: edges of steps that fewer see are easily missed.
  int taper_cameras = 8;
  int many_surfaces = 150;  ///< with more candidates it is not searched more than once
  int most_surfaces = 500;  ///< with more candidates it is not searched at all
  int nodes = 1000;         ///< of the search tree for the choice, which takes few if it is clear
  int most_exclusive = 20000;  ///< pairs of cells that run through one another: more is hopeless
  double hopeless = 2.0 / 3;   ///< share of the strokes that a first choice must not leave over
  EvidencePrices evidence;
};

struct SolidSearch {
  std::optional<Solid> solid;
  Sketch as_seen;            ///< edges of the solid or shell before they were moved onto its faces
  std::string why;           ///< if there is none: a clause
  std::vector<int> edge_of;  ///< per stroke: its edge of the solid, the first if it was cut, or -1
  /// If there is none: the faces of the best choice - where strokes are left over, of the best one
  /// in which they may border one face alone - if it explains half of the strokes and no mask says
  /// otherwise, but those without which the strokes would be explained about as well, and those on
  /// surfaces that hold strokes which are not explained.
  std::optional<Solid> shell;
  int faces = 0;              ///< of the best choice, one of a shell if it is that
  std::vector<int> doubtful;  ///< strokes that no face of the choice explains, ascending
  int twice = 0;              ///< strokes that are other edges of the choice seen twice
  double margin = 0;          ///< [nat] by which the second-best choice is worse
  int surfaces = 0, cells = 0;
  int rays = 0,
      contradicted = 0;  ///< rays through pixels of masks; those that the choice is against
};

/// The solid whose faces explain the strokes, if one does and no other does about as well: surfaces
/// through strokes, cells between strokes on them, and of these the choice of least price in which
/// every edge has two faces.
SolidSearch find_solid(const Sketch& sketch, const SolidOptions& options = {},
                       const SolidEvidence& evidence = {});

}  // namespace sketchsplat

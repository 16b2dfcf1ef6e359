// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/inspect/feature.h"

namespace sketchsplat {

enum class DimensionKind {
  kDiameter,
  kRadius,
  kPlaneDistance,   ///< of parallel planes
  kEdgeDistance,    ///< of parallel edges of one plane
  kCentreDistance,  ///< of circles in one plane
  kPitchDiameter,   ///< of the circle through the centres of three and more equal circles
  kPlaneAngle,      ///< between the normals of planes that share an edge
  kEdgeAngle        ///< of lines that meet, in one plane
};
const char* dimension_name(DimensionKind kind);
constexpr bool is_angle(DimensionKind kind) {
  return kind == DimensionKind::kPlaneAngle || kind == DimensionKind::kEdgeAngle;
}

/// One number of a drawing. Lengths in the nominal's unit, angles in degrees.
struct Dimension {
  DimensionKind kind = DimensionKind::kDiameter;
  std::vector<FeatureRef> features;
  std::string name;         ///< "diameter E5", "distance P1 P4"
  double nominal = 0;       ///< value
  double leg = 0;           ///< of an angle: length of its shorter side
  bool supplement = false;  ///< of an angle: 180 deg less that of the directions as they are
};

/// What a drawing would state: diameters and radii (of arcs from 30 deg); distances of neighbouring
/// parallel planes and of the outer ones; of neighbouring parallel edges of a plane; of circles of
/// a plane from their neighbours (least spanning tree); pitch circles; angles of planes and of
/// edges that meet.
std::vector<Dimension> find_dimensions(const Nominal& nominal, const Association& association);

/// Value of a dimension, of any part's features.
double dimension_value(const Dimension& dimension, const std::vector<Feature>& features);

struct DimensionCheck {
  Dimension dimension;
  bool measured = false;
  double value = 0;
  double sigma = 0, systematic = 0;  ///< from the edgels; from what they do not know
  ErrorShares shares = {};           ///< of the sizes of both, but for
  double stated = 0;                 ///< the part of `systematic` that is of a stated scale
};

/// Measures all of them; the errors of a stroke that two features share count once.
std::vector<DimensionCheck> measure_dimensions(const std::vector<Dimension>& dimensions,
                                               const Nominal& nominal,
                                               const Association& association,
                                               const Sketch& measured, const SigmaModel& sigma);

}  // namespace sketchsplat

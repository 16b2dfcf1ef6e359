// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "datasets/types/image.h"

namespace sketchsplat {

/// Linear light or the share of it that a surface sends back: red, green, blue.
using Color = Eigen::Array3f;

/// From hue, saturation and value, all in [0, 1]; linear.
Color color_of(float hue, float saturation, float value);

enum class PatternKind {
  kPlain,
  kWood,     ///< grain along u
  kPlaster,  ///< faint clouds
  kPlanks,   ///< boards along u
  kText,     ///< lines of strokes that look like print, along u
  kChecker,
  kCells,  ///< patches of random colours (Voronoi)
  kMarble,
  kStripes,  ///< along v
  kDots,
  kBricks,
  kBitmap,  ///< `bitmap` over the unit square, first row at v = 1
};

/// What is printed on a surface whose places are (u, v).
struct Pattern {
  PatternKind kind = PatternKind::kPlain;
  std::uint64_t seed = 0;
  Color light = Color::Constant(0.7f), dark = Color::Constant(0.1f);
  float size = 0.1f;  ///< of its largest features, in units of (u, v)
  std::shared_ptr<const Image<float>> bitmap;

  /// Share of the light that is sent back. `footprint`: of a pixel; what is finer has faded where
  /// the pattern is a continuous one.
  Color at(const Eigen::Vector2f& place, float footprint) const;
};

}  // namespace sketchsplat

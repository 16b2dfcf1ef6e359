// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "edges/tags/tag_square.h"
#include "pipelines/options/output_options.h"
#include "pipelines/options/scale_reference.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// Is a known length given?
bool has_reference(const CadOptions& options);

/// Is it that of tags in the images?
bool wants_tags(const CadOptions& options);

/// Throws UsageError if two options state the scale.
void check_scale(const CadOptions& options);

/// How large a world unit is.
struct KnownScale {
  std::string source;  ///< "--scale-by tag=10", "--scale"; empty: unknown
  LengthUnit unit = LengthUnit::kMillimetre;
  double units_per_world = 1;
  double sigma_relative = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown
  std::vector<TagSquare> tags;                                       ///< that determined it, if any
};

/// The scale of a sketch in world units, numbered as in its file, by the options.
/// `footprint`: world length of a pixel at the part, 0 if unknown. The sigma of a curve is that
/// which `inspect` gives it; the stated length counts as exact. Throws InputError if there is no
/// such thing in the sketch or if tags differ in size.
KnownScale known_scale(const CadOptions& options, const Sketch& sketch, double footprint,
                       const std::vector<TagSquare>& tags);

/// The same from a sketch.json that states it, in the options' unit if the user gave one.
KnownScale stated_scale(const CadOptions& options, const std::string& sketch_json);

/// The options for writing files at that scale.
CadOptions at_scale(CadOptions options, const KnownScale& scale);

/// As JSON: the member "scale" of report.json and sketch.json. Precondition: the scale is known.
std::string scale_json(const KnownScale& scale);

}  // namespace sketchsplat

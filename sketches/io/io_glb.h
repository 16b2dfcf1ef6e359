// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

struct GlbOptions {
  std::string name = "sketch";  ///< UTF-8
  double scale = 1.0;           ///< metres, which the format counts in, per world unit
};

/// Binary glTF 2.0: a mesh of line segments and a colour for each kind of stroke, below a node that
/// turns z up into the format's y up. The same sketch gives the same bytes.
void write_glb(std::ostream& out, const Sketch& sketch, const GlbOptions& options);

}  // namespace sketchsplat

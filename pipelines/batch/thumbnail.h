// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sketchsplat {

/// The curves of a parametric_edges.json from the front right above (z up), in parallel
/// projection, as path data of an SVG of 100 x 100: lines as such, cubics as such. The longest
/// ones, if they are many. Empty if there is none. Throws InputError.
std::string thumbnail_path(const std::string& parametric_edges);

}  // namespace sketchsplat

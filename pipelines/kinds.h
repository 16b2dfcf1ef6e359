// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/polish.h"

namespace sketchsplat {

struct KindOptions {
  double keep = 0.8;  ///< share of its edgels that a simpler curve must explain as well
};

/// Gives every open stroke the simplest kind that explains its edgels: cubics and
/// elliptic arcs are tried as lines and arcs, arcs as lines, each moved onto the edgels by itself
/// before it is compared. End nodes must belong to one stroke each (topology comes later).
Sketch choose_kinds(const Sketch& sketch, const EdgeWorld& world, const PolishOptions& polish,
                    const KindOptions& options);

}  // namespace sketchsplat

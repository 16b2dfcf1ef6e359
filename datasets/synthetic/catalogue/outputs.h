// SPDX-License-Identifier: MIT
#pragma once

#include <sstream>
#include <string>

#include "datasets/types/errors.h"

namespace sketchsplat {

/// What is written about each view beside its image.
struct Outputs {
  bool mask = false, depth = false, normal = false, edges = false;
};

/// From "all", "none" or names with commas between them: mask, depth, normal, edges. Throws
/// InputError. Here, so that the command line needs no OpenCASCADE to complain.
inline Outputs parse_outputs(const std::string& text) {
  Outputs out;
  if (text == "none") return out;
  if (text == "all") return {true, true, true, true};
  std::istringstream names(text + ",");
  for (std::string name; std::getline(names, name, ',');) {
    bool* flag = name == "mask"     ? &out.mask
                 : name == "depth"  ? &out.depth
                 : name == "normal" ? &out.normal
                 : name == "edges"  ? &out.edges
                                    : nullptr;
    if (!flag)
      throw InputError("outputs", "all, none or some of mask,depth,normal,edges",
                       "\"" + name + "\"");
    *flag = true;
  }
  return out;
}

}  // namespace sketchsplat

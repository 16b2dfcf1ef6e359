// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/synthetic/scene/synthesize.h"

namespace sketchsplat::test {

/// Three photographs of 480 x 360 px.
inline SynthesizeOptions small(const std::string& part = "l-bracket") {
  SynthesizeOptions options;
  options.part = part;
  options.render.style = Style::kPhoto;
  options.rig.views = 3;
  options.rig.resolution = 480;
  return options;
}

}  // namespace sketchsplat::test

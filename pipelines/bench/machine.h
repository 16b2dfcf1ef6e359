// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pipelines/options/common_options.h"

namespace sketchsplat {

/// Labels of everything that was measured here: "version", "program" (hash of the executable),
/// "cpu" (model), "cores", "memory" ("25 GB").
OptionTexts machine_labels();

}  // namespace sketchsplat

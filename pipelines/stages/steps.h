// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/stages/options.h"

namespace sketchsplat {

/// Adds --without, which leaves out terms of the fit of surfels by their names. Both options
/// structs must outlive the fields. What is not named is as it was when the field was listed.
void list_without(DetectionOptions* options, Fields* fields);

/// The same with the steps of the method, too.
void list_without(ReconstructOptions* options, Fields* fields);

}  // namespace sketchsplat

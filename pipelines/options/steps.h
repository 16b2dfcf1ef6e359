// SPDX-License-Identifier: MIT
#pragma once

#include "pipelines/options/options.h"

namespace sketchsplat {

/// Adds --without, which leaves out terms of the fit of surfels by their names; all others are as
/// they were when the field was listed. `options` must outlive the fields.
void list_without(DetectionOptions* options, Fields* fields);

/// The same with the steps of the method, too.
void list_without(ReconstructOptions* options, Fields* fields);

}  // namespace sketchsplat

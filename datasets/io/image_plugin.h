// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/io/image_planes.h"

namespace sketchsplat {

/// The plug-in with OpenImageIO, loaded on the first call: beside the executable, where it is
/// installed, or where it was built. Null if it is in none of these places. Safe from many threads.
const ImagePlugin* image_plugin();

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sketchsplat {

/// Of the library that is linked: "0.1.0".
std::string library_version();

}  // namespace sketchsplat

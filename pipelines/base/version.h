// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sketchsplat {

/// "0.1.0"
std::string program_version();

/// Short hash of the commit that the program was built from, with "-dirty" if files differed from
/// it; "unknown" in other programs than sketchsplat.
std::string program_commit();

/// Set by the main file, which alone is compiled anew with every commit.
void set_program_commit(const std::string& commit);

/// "Ceres 2.1.0, OpenCV 4.6.0, ...": what it was built with.
std::string library_versions();

}  // namespace sketchsplat

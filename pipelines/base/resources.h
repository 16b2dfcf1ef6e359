// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sketchsplat {

/// Cores that this process may use: of the machine, of its affinity, and of the quota of its
/// control group. At least 1.
int usable_cores();

/// Memory that this process and its children may take without swapping [MB = 1e6 bytes]:
/// what the machine has available, and what the limits of its control groups leave.
double usable_memory_mb();

/// The smallest value of a file such as memory.max in the control group `path` below `root` and in
/// those above it; infinite if none has one. The first number of the file counts, divided by the
/// second if there are two: cpu.max.
double least_of_groups(const std::string& root, const std::string& path, const std::string& file);

}  // namespace sketchsplat

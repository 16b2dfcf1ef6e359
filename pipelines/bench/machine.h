// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "pipelines/options.h"

namespace sketchsplat {

/// 64-bit FNV-1a of some bytes, as 16 hexadecimal digits (Fowler, Noll and Vo, RFC 9923).
std::string hash_of(const std::string& bytes);

/// The same of a file's bytes; of nothing if it cannot be read.
std::string hash_of_file(const std::string& path);

/// Labels of everything that was measured here: "version", "program" (hash of the executable),
/// "cpu" (model), "cores", "memory" ("25 GB").
OptionTexts machine_labels();

}  // namespace sketchsplat

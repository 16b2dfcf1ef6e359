// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/command/cli.h"

namespace sketchsplat {

/// The manual page sketchsplat(1) in the man macros of troff, made from the verbs and their fields.
std::string manual_page(const std::vector<Verb>& verbs, const std::vector<Field>& common);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/command/cli.h"

namespace sketchsplat {

/// The shells that completion_script() knows.
const std::vector<std::string>& completion_shells();

/// What makes a shell complete verbs, options, their choices and files: made from the fields, so
/// that it cannot drift. Precondition: one of completion_shells().
std::string completion_script(const std::string& shell, const std::vector<Verb>& verbs,
                              const std::vector<Field>& common);

}  // namespace sketchsplat

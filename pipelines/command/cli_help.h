// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/command/cli.h"

namespace sketchsplat {

/// Examples first, then the verbs and the options that all of them understand.
std::string program_help(const std::vector<Verb>& verbs, const std::vector<Field>& common);

/// Examples first, then every option with unit, range and default; those for experts, and more than
/// the names of the common ones where there are any, only if `all`.
std::string verb_help(const Verb& verb, const std::vector<Field>& common, bool all);

/// What the verb needs, as a pattern: "reconstruct SCENE --out DIR [options]".
std::string usage_line(const Verb& verb);

/// An option with what stands behind it: "-o, --out DIR".
std::string with_short_name(const Field& field);

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipelines/base/fields.h"

namespace sketchsplat {

/// Options of a verb as a file of the TOML language says them: lines "name = value", where names
/// are those of the command line without dashes; values of options that may be given several times
/// are lists. What stands in a section, "[reconstruct]", is that verb's alone; what stands before
/// all sections must be options of `verb`, or common ones. Option -> text. Throws InputError with
/// file and option if the file is none, or names an option that there is not.
std::map<std::string, std::string> read_config(const std::string& path, const std::string& verb,
                                               const std::vector<Field>& fields);

/// The options that are not at their defaults, as read_config reads them; a text that holds both
/// kinds of quotation marks or a line break of its own is no value there: UsageError. Neither what
/// is worked on nor where results go is an option in this sense.
std::string config_text(const std::string& verb, const std::vector<Field>& fields);

}  // namespace sketchsplat

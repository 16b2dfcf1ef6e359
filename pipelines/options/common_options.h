// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pipelines/base/fields.h"

namespace sketchsplat {

/// What every verb understands.
struct CommonOptions {
  int threads = 0;  ///< 0: one per core. Results do not depend on it
  int seed = 0;
  bool quiet = false;
  bool verbose = false;
  bool json = false;                ///< results on standard output as JSON
  std::string log;                  ///< file for everything that is said, too; empty: none
  std::string config, save_config;  ///< files of options, in TOML; empty: none
};

/// As in options.h.
void list_fields(CommonOptions* options, Fields* fields);

/// Of the presets of ReconstructOptions, see apply_preset.
std::vector<std::string> preset_names();

/// Option names (as after "--") and the texts of their values.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

}  // namespace sketchsplat

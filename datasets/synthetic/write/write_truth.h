// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "datasets/io/write_whole.h"
#include "datasets/synthetic/render/degrade.h"
#include "datasets/synthetic/scene/synthesize.h"

namespace sketchsplat {

// What all layouts of scenes have in common. Everything throws OutputError.

/// A folder and those above it.
void make_folder(const std::string& path);

/// One list a row.
nlohmann::json json_rows(const Eigen::MatrixXd& m);

/// Lets `write` write an image file, or what the fate leaves of it; of an earlier one with that
/// name, nothing.
void write_image(const std::string& path, Fate fate,
                 const std::function<void(const std::string&)>& write);

/// groundtruth/ of a scene folder, see write_scene().
void write_truth(const SyntheticScene& scene, const std::string& folder);

}  // namespace sketchsplat

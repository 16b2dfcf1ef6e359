// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "pipelines/detectors/detectors.h"
#include "sketchsplat/reconstruct.h"

namespace sketchsplat {

/// A scene whose pictures lie in the views' memory. Throws std::invalid_argument: a view without
/// size, a camera that is none, two views of one name.
Scene scene_of(const std::vector<InputView>& views);

/// A detector that finds what the views say as edges. The views must outlive it.
std::unique_ptr<Detector> make_given_edges(const std::vector<InputView>& views);

}  // namespace sketchsplat

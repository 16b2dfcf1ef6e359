// SPDX-License-Identifier: MIT
#include "datasets/synthetic/plugin.h"

namespace {

using namespace sketchsplat;

const SynthesisPlugin kPlugin = {
    [](const SynthesizeOptions& options) { return new SyntheticScene(synthesize(options)); },
    [](const SyntheticScene& scene, const std::string& folder) { write_scene(scene, folder); },
    [](SyntheticScene* scene) { delete scene; },
};

}  // namespace

extern "C" const SynthesisPlugin* sketchsplat_synthesis_plugin() { return &kPlugin; }

// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write/plugin.h"

namespace {

using namespace sketchsplat;

const SynthesisPlugin kPlugin = {
    [](const SynthesizeOptions& options) { return new SyntheticScene(synthesize(options)); },
    [](const SyntheticScene& scene, const std::string& folder) { write_scene(scene, folder); },
    [](SyntheticScene* scene) { delete scene; },
    [](const std::string& path, double smooth_angle_deg) {
      return new CadPart(read_cad_part(path, smooth_angle_deg));
    },
    [](CadPart* part, const std::vector<View>& views, const Eigen::Matrix3Xd& points,
       const std::vector<int>& strokes) { return count_views(part, views, points, strokes); },
    [](CadPart* part) { delete part; },
};

}  // namespace

extern "C" const void* sketchsplat_synthesis_plugin() { return &kPlugin; }

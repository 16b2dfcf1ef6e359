// SPDX-License-Identifier: MIT
#include "topology/simplify.h"

namespace sketchsplat {

namespace {
constexpr int kMaxRounds = 20;
}

std::vector<std::pair<std::string, int>> SimplifyCounts::named() const {
  return {{"low_opacity", low_opacity},
          {"unseen", unseen},
          {"overlaps", overlaps},
          {"collinear", collinear},
          {"endpoints", endpoints}};
}

Simplified simplify(const Sketch& sketch, const TopologyOptions& options) {
  Simplified out{sketch, Remap::identity(sketch.size()), {}, true};
  const auto take = [&](PassResult result, int* count) {
    out.remap = Remap::compose(out.remap, result.remap);
    out.sketch = std::move(result.sketch);
    *count += result.changes;
  };
  SimplifyCounts& n = out.counts;
  for (int before = -1; before != n.total(); ++n.rounds) {
    if (n.rounds == kMaxRounds) {
      out.settled = false;
      break;
    }
    before = n.total();
    take(remove_low_opacity(out.sketch, options.min_opacity), &n.low_opacity);
    take(visibility_filter(out.sketch, options.min_support_views, options.max_rms_px), &n.unseen);
    take(merge_overlaps(out.sketch, options), &n.overlaps);
    take(merge_collinear(out.sketch, options), &n.collinear);
    take(merge_endpoints(out.sketch, options), &n.endpoints);
  }
  return out;
}

}  // namespace sketchsplat

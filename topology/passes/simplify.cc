// SPDX-License-Identifier: MIT
#include "topology/passes/simplify.h"

#include "topology/core/description.h"

namespace sketchsplat {

namespace {
constexpr int kMostRounds = 20;
}

std::vector<std::pair<std::string, int>> SimplifyCounts::named() const {
  return {{"collinear", collinear}, {"endpoints", endpoints}};
}

Simplified simplify(const Sketch& sketch, const TopologyOptions& options,
                    const StrokePoints& points) {
  Simplified out;
  out.sketch = sketch;
  out.remap = Remap::identity(sketch.size());
  StrokePoints at = points.empty() ? drawn_points(sketch, options) : points;
  const auto take = [&](PassResult result, int* count) {
    out.remap = Remap::compose(out.remap, result.remap);
    out.sketch = std::move(result.sketch);
    at = std::move(result.points);
    *count += result.changes;
  };
  SimplifyCounts& n = out.counts;
  for (int before = -1; before != n.total(); ++n.rounds) {
    if (n.rounds == kMostRounds) {
      out.settled = false;
      break;
    }
    before = n.total();
    take(merge_collinear(out.sketch, options, at), &n.collinear);
    take(merge_endpoints(out.sketch, options, at), &n.endpoints);
  }
  out.points = std::move(at);
  return out;
}

}  // namespace sketchsplat

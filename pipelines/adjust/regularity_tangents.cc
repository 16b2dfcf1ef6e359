// SPDX-License-Identifier: MIT
#include <algorithm>

#include "pipelines/adjust/polish_tangent.h"
#include "pipelines/adjust/regularity_finder.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {

void RegularityFinder::find_tangents() {
  const double price = weigher_.options().price;
  for (Relation& r : tangent_relations(sketch(), weigher_.options().tangent_angle)) {
    r.scale = std::min(stroke_length(sketch(), r.stroke) / 2, stroke_length(sketch(), r.partner)) /
              weigher_.unit();
    std::vector<Relation> one = {r};
    // It is expected: that it agrees is no chance, however vague it is.
    const RelationTrial trial = weigher_.weigh(&one, r.scale, -2 * (price + kTangentLogOdds));
    if (trial.pays()) weigher_.take(one, trial, true);
    if (trial.pays() || !trial.news) tangents_.push_back({r.stroke, r.partner});
  }
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "pipelines/adjust/polish_tangent.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve/closest.h"
#include "sketches/curve/tangent_joint.h"

namespace sketchsplat {
namespace {

constexpr double kTurn = 20 * M_PI / 180;  // joints that turn less may be tangent
constexpr int kTries = 3;                  // fewer joints each time

// Where edgels put the strokes of a sketch.
struct Places {
  Observation o;
  double sigma = 1;  // world units
  std::vector<Measured> strokes;
};

Places places_of(const Sketch& sketch, const EdgeWorld& world, const Prices& prices) {
  Places out;
  out.o = observe_places(sketch, world);
  out.sigma = place_sigma_px(out.o, prices.sigma_px) * world.footprint;
  for (int s = 0; s < sketch.size(); ++s) out.strokes.push_back(measure(out.o, s, world.footprint));
  return out;
}

// [nat] by which a sketch is off the places of the halves of two strokes that lie next to their
// joint. A place may be on either: joints move along.
double nats_near(const TangentJoint& joint, const Places& places, const Sketch& drawn,
                 const Sketch& now) {
  double sum = 0;
  for (const int stroke : {joint.arc, joint.other}) {
    const Measured& m = places.strokes[stroke];
    const int n = int(m.placed.size());
    const bool first_half = drawn.strokes[stroke].begin == joint.node;
    for (int k = first_half ? 0 : n / 2; k < (first_half ? (n + 1) / 2 : n); ++k) {
      if (!m.placed[k]) continue;
      const double off = std::min(distance_to_stroke(now, joint.arc, m.point.col(k)).distance,
                                  distance_to_stroke(now, joint.other, m.point.col(k)).distance);
      sum += 0.5 * (off / places.sigma) * (off / places.sigma);
    }
  }
  return sum;
}

}  // namespace

Sketch polish_tangent(const Sketch& sketch, const EdgeWorld& world, const PolishOptions& options,
                      const Prices& prices, Observation* last) {
  const Sketch free = polish(sketch, world, options, last);
  std::vector<TangentJoint> joints = find_tangent_joints(free, kTurn);
  if (joints.empty() || options.rounds == 0) return free;
  const Places places = places_of(free, world, prices);
  for (int t = 0; t < kTries && !joints.empty() && !options.deadline.passed(); ++t) {
    PolishOptions held = options;
    held.tangent.assign(free.nodes.cols(), 0);
    for (const TangentJoint& joint : joints) held.tangent[joint.node] = 1;
    Observation seen;
    const Sketch tangent = polish(free, world, held, &seen);
    std::vector<TangentJoint> stay;
    for (const TangentJoint& joint : joints)
      if (nats_near(joint, places, free, tangent) - nats_near(joint, places, free, free) <
          prices.parameter + kTangentLogOdds)
        stay.push_back(joint);
    if (stay.size() == joints.size()) {
      *last = std::move(seen);
      return tangent;
    }
    joints = std::move(stay);
  }
  return free;
}

}  // namespace sketchsplat

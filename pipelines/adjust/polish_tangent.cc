// SPDX-License-Identifier: MIT
#include "pipelines/adjust/polish_tangent.h"

#include <utility>
#include <vector>

#include "sketches/curve/tangent_joint.h"
#include "topology/core/description.h"

namespace sketchsplat {
namespace {

constexpr int kTries = 3;  // fewer joints each time

// Places of the half of a stroke that lies next to a node.
Eigen::Matrix3Xd near_node(const Sketch& drawn, int stroke, int node, const StrokePoints& points) {
  const Eigen::Matrix3Xd& all = points[stroke];
  const Eigen::Index half = (all.cols() + 1) / 2;
  return drawn.strokes[stroke].begin == node ? all.leftCols(half) : all.rightCols(half);
}

// [nat] by which a sketch is off the places of two strokes next to their joint. A place may be on
// either: joints move along. `drawn`: what the places belong to.
double nats_near(const TangentJoint& joint, const Described& places, const Sketch& drawn,
                 const Sketch& now) {
  const std::vector<PlainCurve> curves = {plain_curve(now, joint.arc),
                                          plain_curve(now, joint.other)};
  double sum = 0;
  for (const int stroke : {joint.arc, joint.other})
    sum += misfit(curves, near_node(drawn, stroke, joint.node, places.points), places.cost);
  return sum;
}

}  // namespace

Sketch polish_tangent(const Sketch& sketch, const EdgeWorld& world, const PolishOptions& options,
                      const Prices& prices, Observation* last) {
  const Sketch free = polish(sketch, world, options, last);
  std::vector<TangentJoint> joints = find_tangent_joints(free, kMostTangentTurn);
  if (joints.empty() || options.rounds == 0) return free;
  const Described places = describe(free, world, prices);
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

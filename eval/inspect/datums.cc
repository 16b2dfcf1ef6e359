// SPDX-License-Identifier: MIT
#include "eval/inspect/datums.h"

#include <algorithm>

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Vector7 = Eigen::Matrix<double, 7, 1>;

constexpr double kHeldByDatum = 1e-3;

PoseSystem system_of(const RobustFit& robust, const std::vector<PosePlace>& places,
                     const Datum& d) {
  PoseSystem system;
  for (const PosePlace& p : places) {
    if (!belongs(robust.nominal(), p.edge, d)) continue;
    Matrix3d across = Matrix3d::Identity() - p.tangent * p.tangent.transpose();
    if (d.edge < 0) {
      const Vector3d& n = robust.nominal().planes[d.plane].normal;
      across = n * n.transpose();
    }
    robust.fit().add(p, across, &system);
  }
  return system;
}

}  // namespace

Datum datum_of(const Nominal& nominal, const std::string& name) {
  Datum d{find_edge(nominal, name), find_plane(nominal, name)};
  if (d.edge < 0 && d.plane < 0)
    throw InputError("--datum " + name,
                     "an edge (E1 to E" + std::to_string(nominal.edges.size()) +
                         ") or a plane (P1 to P" + std::to_string(nominal.planes.size()) +
                         ") of the nominal part",
                     "no such name");
  return d;
}

bool belongs(const Nominal& nominal, int edge, const Datum& d) {
  if (d.edge >= 0) return edge == d.edge;
  const std::vector<int>& edges = nominal.planes[d.plane].edges;
  return std::binary_search(edges.begin(), edges.end(), edge);
}

Similarity fit_to_datums(const RobustFit& robust, Similarity pose) {
  pose = robust.fitted(pose, 1, robust.basis());
  for (int k = 0; k < kMostPoseSteps; ++k) {
    const std::vector<PosePlace> places = robust.near_places(pose, 1);
    MatrixXd open = robust.basis();
    Vector7 move = Vector7::Zero();
    for (const std::string& name : robust.options().datums) {
      PoseSystem system = system_of(robust, places, datum_of(robust.nominal(), name));
      if (!(system.weight > 0))
        throw InputError("--datum " + name, "an edge or plane that was measured",
                         "nothing near it");
      if (open.cols() == 0) continue;
      system.slope += system.information * move;
      move += solve(system, open, kHeldByDatum, &open);
    }
    if (open.cols() > 0) {
      PoseSystem all;
      for (const PosePlace& p : robust.weighed_places(pose, 1))
        robust.fit().add(p, Matrix3d::Identity() - p.tangent * p.tangent.transpose(), &all);
      all.slope += all.information * move;
      move += solve(all, open, kFreeDirection, nullptr);
    }
    pose = robust.fit().after(pose, move);
    if (move.norm() < 1e-3 * kLeastGap * robust.nominal().extent) break;
  }
  return pose;
}

}  // namespace sketchsplat

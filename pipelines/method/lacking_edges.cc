// SPDX-License-Identifier: MIT
#include "pipelines/method/lacking_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/types/parallel.h"
#include "edges/views/unexplained.h"
#include "pipelines/survey/explained.h"
#include "sketches/curve/curve.h"
#include "topology/solid/surface.h"

namespace sketchsplat {
namespace {

constexpr double kSpacing = 2;   // [pixel footprints] of samples on the solid's edges
constexpr double kBesidePx = 3;  // [pixel footprints] by which contours may stand off
constexpr int kFewestViews = 6;  // that must agree on a point: shading agrees by chance in some
constexpr int kLeastChain = 12;  // [px] of edgels that nothing explains: shorter ones are corners

// A round face, all around, as far along its axis as its edges reach.
struct RoundFace {
  Layout layout;
  double low = -INFINITY, high = INFINITY;
};

std::vector<RoundFace> round_faces(const Solid& solid, double footprint) {
  std::vector<RoundFace> out;
  for (const SolidFace& face : solid.faces) {
    Surface s = solid.surfaces[face.surface];
    if (s.kind == SurfaceKind::kPlane) continue;
    // Lines of sight through its contours touch it, and may pass it by.
    (s.kind == SurfaceKind::kTorus ? s.minor_radius : s.radius) += kBesidePx * footprint;
    RoundFace round{Layout(s)};
    const bool ends = s.kind != SurfaceKind::kSphere && s.kind != SurfaceKind::kTorus;
    if (ends) round.low = INFINITY, round.high = -INFINITY;
    for (const Loop& loop : face.loops)
      for (const LoopStroke& edge : loop) {
        const Eigen::Matrix3Xd points = sample_stroke(solid.edges, edge.stroke, 4 * footprint);
        const Eigen::VectorXd up = (points.colwise() - s.origin).transpose() * s.axis;
        round.low = std::min(round.low, up.minCoeff() - kBesidePx * footprint);
        round.high = std::max(round.high, up.maxCoeff() + kBesidePx * footprint);
      }
    out.push_back(std::move(round));
  }
  return out;
}

// Does a line of sight meet a round face? What it shows may be the face's shading.
bool meets(const std::vector<RoundFace>& faces, const Eigen::Vector3d& from,
           const Eigen::Vector3d& to) {
  return std::any_of(faces.begin(), faces.end(), [&](const RoundFace& face) {
    const Surface& s = face.layout.surface();
    const Crossings all = crossings(face.layout, from, to);
    return std::any_of(all.t, all.t + all.count, [&](double t) {
      const double up = (from + t * (to - from) - s.origin).dot(s.axis);
      return up >= face.low && up <= face.high;
    });
  });
}

// Edgels along the solid's edges, outlines, and what may be shading.
EdgelFlags explained_by(const Solid& solid, const EdgeWorld& world) {
  EdgelFlags explained = edgels_along(solid.edges, world);
  const std::vector<RoundFace> faces = round_faces(solid, world.footprint);
  parallel_for(int(world.maps.size()), 1, [&](int v) {
    const View& view = world.views[v];
    const Eigen::Vector3d from = view.center_in_world();
    const double reach = (world.bounds.center() - from).norm() + world.bounds.diagonal().norm();
    const std::vector<Edgel>& edgels = world.maps[v].edgels;
    for (size_t i = 0; i < edgels.size(); ++i) {
      if (explained[v][i]) continue;
      const Eigen::Vector3d ray = view.cam_from_world.rotation.transpose() *
                                  view.camera.ray(Eigen::Vector2d(edgels[i].x, edgels[i].y));
      explained[v][i] = edgels[i].outline || meets(faces, from, from + reach * ray.normalized());
    }
  });
  return explained;
}

}  // namespace

LackingEdges lacking_edges(const Solid& solid, const EdgeWorld& world, const Detector& detector,
                           const LiftOptions& options) {
  LackingEdges out;
  if (!world.has_masks()) return out;
  LiftOptions lift = options;
  lift.min_views = std::max(lift.min_views, kFewestViews);
  const std::vector<EdgePoint> points =
      lift_edges(unexplained(world, explained_by(solid, world), kLeastChain), lift);
  if (points.empty()) return out;
  CurvePoints places;
  places.position.resize(3, long(points.size()));
  places.tangent.resize(3, long(points.size()));
  places.first = {0, int(points.size())};
  for (size_t i = 0; i < points.size(); ++i) {
    places.position.col(long(i)) = points[i].position;
    places.tangent.col(long(i)) = points[i].tangent;
  }
  const std::vector<EdgeKind> kinds = detector.judge(places);
  out.points = int(points.size() - std::count(kinds.begin(), kinds.end(), EdgeKind::kPrint));
  const double samples = points_on(solid.edges, kSpacing * world.footprint).first.back();
  const double known = samples * kSpacing / lift.stride_px;
  if (out.points > 0) out.share = out.points / (out.points + known);
  return out;
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/cad_part.h"

#include <utility>

#include "datasets/synthetic/render/visibility.h"
#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

constexpr double kDeflection = 1e-4;  // [extents] of the triangles that hide edges
constexpr double kLift = 2e-3;        // [extents] what is nearer hides nothing

// The same camera in the unit frame.
View in_unit_frame(View view, const UnitFrame& frame) {
  Pose& pose = view.cam_from_world;
  pose.translation = frame.scale * (pose.translation + pose.rotation * frame.centre);
  return view;
}

Eigen::Vector3d outward_near(const TruthCurve& curve, const Eigen::Vector3d& point) {
  Eigen::Index nearest = 0;
  (curve.points.colwise() - point).colwise().squaredNorm().minCoeff(&nearest);
  return curve.outward.col(nearest);
}

}  // namespace

CadPart read_cad_part(const std::string& path, double smooth_angle_deg) {
  return cad_part_of(read_step(path), path, smooth_angle_deg);
}

CadPart cad_part_of(Brep brep, const std::string& path, double smooth_angle_deg) {
  CadPart part;
  part.path = path;
  part.brep = std::move(brep);
  part.frame = unit_frame(part.brep, path);
  const Truth unit = sharp_edges(part.brep, part.frame, smooth_angle_deg);
  if (unit.curves.empty()) throw InputError(path, "a part with sharp edges", "none");
  part.edges = transformed(unit, 1 / part.frame.scale, part.frame.centre);
  return part;
}

std::vector<int> count_views(CadPart* part, const std::vector<View>& views,
                             const Eigen::Matrix3Xd& points, const std::vector<int>& strokes) {
  if (!part->tracer)
    part->tracer = std::make_shared<const Tracer>(
        tessellate(part->brep, part->frame, kDeflection, part->path));
  std::vector<View> unit_views;
  for (const View& view : views) unit_views.push_back(in_unit_frame(view, part->frame));
  std::vector<int> counts(strokes.size());
  const int n = int(strokes.size());
  parallel_for(n, 64, [&](int i) {
    const TruthCurve& curve = part->edges.curves[part->edges.curve_of_stroke[strokes[i]]];
    const Eigen::Vector3d outward = outward_near(curve, points.col(i));
    for (const View& view : unit_views)
      counts[i] += sees(view, *part->tracer, part->frame * points.col(i), outward, kLift);
  });
  return counts;
}

}  // namespace sketchsplat

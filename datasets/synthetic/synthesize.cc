// SPDX-License-Identifier: MIT
#include "datasets/synthetic/synthesize.h"

#include <algorithm>
#include <cctype>

#include "datasets/errors.h"
#include "datasets/synthetic/mesh_part.h"
#include "datasets/synthetic/parts.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

void require(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw InputError(name, std::to_string(low) + " to " + std::to_string(high),
                   std::to_string(value));
}

void check(const SynthesizeOptions& o) {
  require("extent", o.extent, 1e-12, 1e12);
  require("smooth angle", o.smooth_angle_deg, 1e-9, 90);
  require("crease angle", o.crease_deg, 1, 180);
  require("deflection", o.deflection, 1e-6, 1e-2);
  require("views", o.rig.views, 1, 100000);
  require("resolution", o.rig.resolution, 16, 8192);
  require("focal length", o.rig.focal, 0, 1e6);
  require("distance", o.rig.distance, 1.6, 1000);
  require("elevation", o.rig.elevation_deg, -85, 85);
  require("noise", o.render.noise, 0, 100);
  require("blur", o.render.blur, 0, 20);
  require("exposure", o.render.exposure, 0, 2);
  require("background", o.render.background, 0, 1);
}

bool is_step_file(const std::string& part) {
  std::string ending = part.substr(std::min(part.size(), part.rfind('.')));
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".step" || ending == ".stp";
}

// How many views see each point of an edge: rays start a little way into the free space between the
// faces, further than triangles stray from the surface.
void count_views(const Tracer& tracer, const std::vector<View>& views, double lift,
                 TruthCurve* curve) {
  curve->visible_views.assign(curve->points.cols(), 0);
  for (int i = 0; i < curve->points.cols(); ++i) {
    const Vector3d from = curve->points.col(i) + lift * curve->outward.col(i);
    for (const View& view : views) {
      double depth;
      const Eigen::Vector2d pixel = view.project(curve->points.col(i), &depth);
      if (!(depth > 0) || !view.camera.contains(pixel)) continue;
      const Vector3d eye = view.center_in_world();
      // An edge without a free side starts on its way to the eye instead.
      const Vector3d start =
          curve->outward.col(i).isZero() ? from + lift * (eye - from).normalized() : from;
      if (!tracer.blocked(start.cast<float>(), eye.cast<float>())) ++curve->visible_views[i];
    }
  }
}

MeshPart make_object(const SynthesizeOptions& options) {
  if (is_mesh_file(options.part))
    return make_mesh_part(read_mesh(options.part), options.crease_deg, options.part);
  const Brep brep =
      is_step_file(options.part) ? read_step(options.part) : make_part(options.part, options.seed);
  const UnitFrame frame = unit_frame(brep, options.part);
  return {tessellate(brep, frame, options.deflection),
          sharp_edges(brep, frame, options.smooth_angle_deg)};
}

Eigen::Matrix3Xd all_points(const Truth& truth) {
  Eigen::Index n = 0;
  for (const TruthCurve& curve : truth.curves) n += curve.points.cols();
  Eigen::Matrix3Xd points(3, n);
  n = 0;
  for (const TruthCurve& curve : truth.curves) {
    points.middleCols(n, curve.points.cols()) = curve.points;
    n += curve.points.cols();
  }
  return points;
}

}  // namespace

SyntheticScene synthesize(const SynthesizeOptions& options) {
  check(options);
  auto [surface, truth] = make_object(options);
  if (truth.curves.empty()) throw InputError(options.part, "a part with sharp edges", "none");
  const Tracer tracer(surface);
  const std::vector<View> unit_views = make_rig(options.rig, options.seed);
  const double lift = std::max(2e-4, 10 * options.deflection);
  std::vector<TruthCurve>& curves = truth.curves;
  const int n = int(curves.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < n; ++i) count_views(tracer, unit_views, lift, &curves[i]);
  const Vector3d shift = Vector3d::Constant(0.5 * options.extent);
  return {options,
          transformed(truth, options.extent, shift),
          transformed(unit_views, options.extent, shift),
          unit_views,
          all_points(truth),
          tracer};
}

Picture render(const SyntheticScene& scene, int view) {
  return render(scene.tracer, scene.unit_views[view], scene.hints, scene.options.render,
                scene.options.seed, view);
}

}  // namespace sketchsplat

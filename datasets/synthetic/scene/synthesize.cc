// SPDX-License-Identifier: MIT
#include "datasets/synthetic/scene/synthesize.h"

#include <algorithm>
#include <cctype>

#include "datasets/synthetic/cad/mesh_part.h"
#include "datasets/synthetic/cad/parts.h"
#include "datasets/synthetic/photo/photo_painter.h"
#include "datasets/synthetic/render/visibility.h"
#include "datasets/synthetic/scene/photo_world.h"
#include "datasets/tags/april_tag.h"
#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"

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
  if (o.rig.height != 0) require("height", o.rig.height, 16, 8192);
  if (o.rig.distance != 0) require("distance", o.rig.distance, 1.6, 1000);
  require("elevation", o.rig.elevation_deg, -85, 85);
  require("object size", o.rig.object_size, 0, 10);
  require("spread", o.rig.spread_deg, 1, 180);
  require("texture strength", o.render.texture_strength, 0, 1);
  require("even light", o.render.even_light, 0, 1);
  require("JPEG quality", o.render.jpeg, 0, 100);
  require("noise", o.render.noise, 0, 100);
  require("blur", o.render.blur, 0, 20);
  require("exposure", o.render.exposure, 0, 2);
  require("background", o.render.background, 0, 1);
  require("pose noise", o.degrade.pose_noise_px, 0, 100);
  require("focal error", o.degrade.focal_error_percent, -50, 50);
  require("distortion", o.photo.distortion, 0, 3);
  require("pose error", o.photo.pose_error_px, 0, 50);
  require("tag", o.photo.tag, -1, tag36h11_count() - 1);
  require("tag size", o.photo.tag_size, 0, o.extent);
  require("missing", o.degrade.missing, 0, 1);
  require("truncated", o.degrade.truncated, 0, 1);
  parse_outputs(o.outputs);
}

bool is_step_file(const std::string& part) {
  std::string ending = part.substr(std::min(part.size(), part.rfind('.')));
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".step" || ending == ".stp";
}

struct Object {
  SurfaceMesh surface;
  Truth truth;
  Brep brep;  // empty for a mesh
  UnitFrame frame;
};

Object make_object(const SynthesizeOptions& options) {
  if (is_mesh_file(options.part)) {
    MeshPart part = make_mesh_part(read_mesh(options.part), options.crease_deg, options.part);
    return {std::move(part.surface), std::move(part.truth), {}, part.frame};
  }
  const Brep brep = is_step_file(options.part)
                        ? read_step(options.part)
                        : make_part(options.part, options.seed, options.parameters);
  const UnitFrame frame = unit_frame(brep, options.part);
  return {tessellate(brep, frame, options.deflection, options.part),
          sharp_edges(brep, frame, options.smooth_angle_deg), brep, frame};
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

std::shared_ptr<const Clutter> clutter_behind(const std::vector<View>& views, std::uint64_t seed) {
  double reach = 1;
  for (const View& view : views) reach = std::max(reach, view.center_in_world().norm());
  return std::make_shared<const Clutter>(make_clutter(reach, seed));
}

void scale(double factor, Image<float>* image) {
  for (float& value : image->data) value = float(value * factor);
}

}  // namespace

SyntheticScene synthesize(const SynthesizeOptions& given) {
  check(given);
  SynthesizeOptions options = given;
  const bool photographs = options.render.style == Style::kPhoto;
  options.rig = resolved(options.rig, photographs);
  auto [surface, truth, brep, frame] = make_object(options);
  if (truth.curves.empty()) throw InputError(options.part, "a part with sharp edges", "none");
  const Tracer tracer(surface);
  std::vector<View> unit_views = make_rig(options.rig, options.seed);
  const double lift = std::max(2e-4, 10 * options.deflection);
  std::vector<TruthCurve>& curves = truth.curves;
  std::shared_ptr<const PhotoWorld> photo;
  if (photographs) {
    photo = std::make_shared<const PhotoWorld>(make_photo_world(options, surface));
    make_photo_views(options, *photo, &unit_views);
    for (TruthCurve& curve : curves) lift_off_table(*photo, 2 * lift, &curve);
  }
  const Tracer& all = photo ? photo->tracer : tracer;
  const int n = int(curves.size());
  parallel_for(n, 1, [&](int i) { count_views(all, unit_views, lift, &curves[i]); });
  const Vector3d shift = Vector3d::Constant(0.5 * options.extent);
  return {options,
          transformed(truth, options.extent, shift),
          transformed(unit_views, options.extent, shift),
          unit_views,
          curves,
          all_points(truth),
          tracer,
          options.render.clutter ? clutter_behind(unit_views, options.seed) : nullptr,
          photo,
          lift,
          brep,
          frame};
}

RenderedView render_view(const SyntheticScene& scene, int view) {
  const RenderOptions& options = scene.options.render;
  const std::uint64_t seed = scene.options.seed;
  if (scene.photo) {
    RenderedView out;
    const PhotoShader shader(*scene.photo, {scene.options.photo.surface, seed}, scene.lift);
    out.picture =
        paint_photo(*scene.photo, shader, scene.unit_curves, scene.unit_views[view], seed, view);
    out.mask = std::move(out.picture.alpha);
    expose_photo(options, seed, view, &out.picture);
    return out;
  }
  const Tracer* behind = scene.clutter ? &scene.clutter->tracer : nullptr;
  const Look look{options.style, options.texture_strength, options.even_light};
  const Shader shader(scene.tracer, behind, look, seed, scene.lift);
  const Subject subject{scene.tracer, shader, scene.clutter.get(), scene.hints};
  Painting painting = paint(subject, scene.unit_views[view], seed, view);
  RenderedView out;
  out.picture = expose(painting, options, seed, view);
  out.mask = std::move(painting.alpha);
  out.depth = std::move(painting.depth);
  scale(scene.options.extent, &out.depth);
  out.normal_x = std::move(painting.normal_x);
  out.normal_y = std::move(painting.normal_y);
  out.normal_z = std::move(painting.normal_z);
  return out;
}

Picture render(const SyntheticScene& scene, int view) { return render_view(scene, view).picture; }

}  // namespace sketchsplat

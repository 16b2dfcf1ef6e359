// SPDX-License-Identifier: MIT
#include "pipelines/results/outputs.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/readers/colmap_write.h"
#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/version.h"
#include "pipelines/pages/overlay.h"
#include "pipelines/results/known_scale.h"
#include "pipelines/results/report.h"
#include "pipelines/results/solid_output.h"
#include "sketches/io/io.h"
#include "sketches/io/json.h"
#include "topology/faces/planar_faces.h"

namespace sketchsplat {
namespace fs = std::filesystem;
namespace {

constexpr double kObjDeflection = 1e-4;  // of the extent

// Views that are called as COLMAP does: by the path below the folder that holds all images.
std::vector<View> named_by_path(std::vector<View> views) {
  fs::path common = fs::path(views.at(0).image_path).parent_path();
  for (const View& view : views)
    while (!common.empty() && view.image_path.rfind(common.string() + "/", 0) != 0)
      common = common.parent_path() == common ? fs::path() : common.parent_path();
  for (View& view : views)
    if (!common.empty())
      view.name = fs::path(view.image_path).lexically_relative(common).generic_string();
  return views;
}

// The refined cameras as a model of COLMAP, without its points; nothing of an earlier run.
void write_cameras(const std::string& folder, const std::vector<View>& views) {
  const char* const names[] = {"/cameras.txt", "/images.txt", "/points3D.txt"};
  if (views.empty()) {
    std::error_code ignored;
    for (const char* name : names) fs::remove(folder + name, ignored);
    if (fs::is_empty(folder, ignored)) fs::remove(folder, ignored);
    return;
  }
  prepare_output_folder(folder);
  const ColmapText text = colmap_text(named_by_path(views));
  const std::string* const texts[] = {&text.cameras, &text.images, &text.points};
  for (int k = 0; k < 3; ++k)
    write_atomically(folder + names[k], [&](std::ostream& out) { out << *texts[k]; });
}

Json json_of(const std::vector<Regularity>& regularities) {
  Json out = Json::array();
  for (const Regularity& r : regularities)
    out.push_back({{"kind", relation_name(r.kind)}, {"strokes", r.strokes}});
  return out;
}

std::string product_name(const Scene& scene, const std::string& otherwise) {
  const std::string name =
      fs::path(scene.folder + "/.").lexically_normal().parent_path().filename().string();
  return name.empty() ? otherwise : name;
}

double count_of(const Reconstruction& reconstruction, const std::string& wanted) {
  for (const auto& [name, value] : reconstruction.report.counts)
    if (name == wanted) return value;
  return 0;
}

double footprint_of(const Reconstruction& reconstruction) {
  return count_of(reconstruction, "footprint");
}

SolidOutputOptions solid_options(const Reconstruction& reconstruction, const Scene& scene,
                                 const KnownScale& scale, const OutputOptions& options) {
  const CadOptions cad = at_scale(options.cad, scale);
  Json extra = {{"program", "sketchsplat"}, {"version", program_version()}};
  if (!scale.source.empty()) extra["scale"] = parse_json<Json>(scale_json(scale));
  SolidOutputOptions out;
  out.step = {product_name(scene, "solid"), cad.scale, cad.unit};
  out.scale = scale;
  out.sigma.footprint = footprint_of(reconstruction);
  out.sigma.bias_px = typical_bias_px(reconstruction.sketch);
  out.extra = json_text(extra);
  return out;
}

void write_sketch(const std::string& folder, const Reconstruction& reconstruction,
                  const Scene& scene, const std::string& options_json, const KnownScale& scale,
                  const OutputOptions& options) {
  const Sketch& sketch = reconstruction.sketch;
  Json extra = {{"program", "sketchsplat"}, {"version", program_version()}};
  extra["options"] = parse_json<Json>(options_json);
  extra["regularities"] = json_of(reconstruction.report.regularities);
  extra["views"] = reconstruction.views;
  if (!scale.source.empty()) extra["scale"] = parse_json<Json>(scale_json(scale));
  if (footprint_of(reconstruction) > 0) extra["footprint"] = footprint_of(reconstruction);
  if (count_of(reconstruction, "pose_scale_sigma") > 0)
    extra["pose_scale_sigma"] = count_of(reconstruction, "pose_scale_sigma");
  // Names of files may hold bytes that are no UTF-8.
  const std::string members = json_text(extra);
  write_atomically(folder + "/sketch.json",
                   [&](std::ostream& out) { write_sketch_json(out, sketch, members); });
  write_atomically(folder + "/parametric_edges.json",
                   [&](std::ostream& out) { write_parametric_edges(out, sketch); });
  const CadOptions cad = at_scale(options.cad, scale);
  write_atomically(folder + "/sketch.obj",
                   [&](std::ostream& out) { write_obj(out, sketch, kObjDeflection, cad.scale); });
  const StepOptions step = step_options(sketch, product_name(scene, "sketch"), cad);
  write_atomically(folder + "/sketch.step",
                   [&](std::ostream& out) { write_step(out, sketch, step); });
  const double size = sketch_extent(sketch).size;
  const double spacing = kPointSpacing * (size > 0 ? size : 1);
  write_atomically(folder + "/edge_points.ply",
                   [&](std::ostream& out) { write_edge_points(out, sketch, spacing); });
}

// A scale that cannot be determined is a warning: the curves are useful without it.
KnownScale scale_of(const Reconstruction& reconstruction, const CadOptions& options,
                    const RunLog& log) {
  // As its file counts curves and nodes.
  std::stringstream file;
  write_sketch_json(file, reconstruction.sketch);
  const Sketch sketch = read_sketch_json(file, "sketch.json");
  try {
    return known_scale(options, sketch, footprint_of(reconstruction), reconstruction.tags);
  } catch (const InputError& e) {
    log.warn(std::string(e.what()) + ": all lengths stay in world units");
    KnownScale none;
    none.unit = options.unit;
    return none;
  }
}

}  // namespace

StepOptions step_options(const Sketch& sketch, const std::string& name, const CadOptions& options) {
  StepOptions step;
  step.name = name;
  step.scale = options.scale;
  step.unit = options.unit;
  if (options.faces) step.faces = planar_faces(sketch);
  return step;
}

KnownScale write_outputs(const std::string& folder, Reconstruction reconstruction,
                         const Scene& scene, const PhotoAlbum& album,
                         ReconstructOptions reconstruct_options, OutputOptions output_options,
                         Progress* progress) {
  // sketch.json holds what decides the sketch; the report all options.
  Fields method;
  method.add("seed", &reconstruct_options.seed, "", 0, HUGE_VAL, "");
  list_fields(&reconstruct_options, &method);
  Fields all = method;
  list_fields(&output_options, &all);
  const Sketch& sketch = reconstruction.sketch;
  ReportPage page = {&sketch};
  KnownScale scale;
  SolidOutcome solid;
  {
    const RunLog log{&reconstruction.report, progress};
    Stage stage("write", log);
    scale = scale_of(reconstruction, output_options.cad, log);
    write_sketch(folder, reconstruction, scene, fields_json(method.list), scale, output_options);
    solid = write_solid(folder, reconstruction.solid,
                        solid_options(reconstruction, scene, scale, output_options));
    write_cameras(folder + "/cameras", reconstruction.refined);
    Scene seen = scene;
    if (!reconstruction.refined.empty()) seen.views = reconstruction.refined;
    const auto warning = [&](const std::string& text) { log.warn(text); };
    const size_t overlays =
        write_overlays(folder, "overlay", painted_curves(sketch), seen.views,
                       sketch_extent(sketch).center, output_options.overlays, warning)
            .size();
    if (overlays > 0) page.photos = album.photos(seen.views);
    stage.result(std::to_string(overlays) + " overlays, " + std::to_string(page.photos.size()) +
                 " photographs");
  }
  if (!solid.mesh.empty()) page.solid = &solid;
  const std::string report = report_json({&reconstruction, &scene, fields_json(all.list),
                                          output_options.reproducible, &scale, &solid});
  write_atomically(folder + "/report.json", [&](std::ostream& out) { out << report; });
  write_atomically(folder + "/report.html",
                   [&](std::ostream& out) { out << report_html(report, page); });
  if (reconstruct_options.solid == "require" && !solid.written)
    throw TooLittleError(scene.folder +
                         ": expected curves that bound a solid, found none: " + solid.why);
  return scale;
}

}  // namespace sketchsplat

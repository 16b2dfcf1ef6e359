// SPDX-License-Identifier: MIT
#include "pipelines/results/report.h"

#include <omp.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipelines/base/version.h"
#include "pipelines/pages/overlay.h"
#include "pipelines/pages/page.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/graph/inferred.h"
#include "sketches/graph/kind_color.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

constexpr int kBlendPoints = 32;  // along a blend, of the points that are listed

Json number(double value) {
  if (std::nearbyint(value) == value && std::abs(value) < 1e15) return int64_t(value);
  return value;
}

Json object_of(const Numbers& numbers) {
  Json object = Json::object();
  for (const auto& [name, value] : numbers) object[name] = number(value);
  return object;
}

Json stages_json(const RunReport& run, bool reproducible) {
  Json stages = Json::array();
  for (const StageReport& s : run.stages) {
    Json stage = {{"name", s.name}};
    if (!reproducible) {
      stage["seconds"] = s.seconds;
      stage["peak_mb"] = s.peak_mb;
    }
    stage["result"] = s.result;
    stages.push_back(stage);
  }
  return stages;
}

Json counts_json(const ReportInput& input) {
  const Sketch& sketch = input.reconstruction->sketch;
  Json counts = object_of(input.reconstruction->report.counts);
  const std::vector<CurveChain> chains = curve_chains(sketch);
  const std::vector<bool> inner = inner_joints(sketch, chains);
  counts["curves"] = chains.size();
  for (const StrokeKind kind :
       {StrokeKind::kLine, StrokeKind::kArc, StrokeKind::kCircle, StrokeKind::kEllipse,
        StrokeKind::kEllipticArc, StrokeKind::kBezier}) {
    int n = 0;
    for (const CurveChain& chain : chains) n += sketch.strokes[chain.strokes[0]].kind == kind;
    counts[kind_name(kind) + std::string("s")] = n;
  }
  counts["junctions"] = std::count(inner.begin(), inner.end(), false);
  return counts;
}

// Points of a curve for the screen, relative to the extent.
Json points_json(const Sketch& sketch, int s, double length, const Extent& extent) {
  const int pieces = sketch.strokes[s].kind == StrokeKind::kLine ? 1 : 64;
  const Eigen::Matrix3Xd points = sample_stroke(sketch, s, length / pieces);
  Json flat = Json::array();
  for (int i = 0; i < points.cols(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double x = (points(k, i) - extent.center[k]) / extent.size;
      flat.push_back(std::round(x * 1e6) / 1e6);
    }
  return flat;
}

Json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json curves_json(const Sketch& sketch, const Extent& extent) {
  Json curves = Json::array();
  const std::vector<int> curve = chain_of_strokes(curve_chains(sketch), sketch.size());
  for (int s = 0; s < sketch.size(); ++s) {
    const double length = stroke_length(sketch, s);
    const Evidence e = s < int(sketch.evidence.size()) ? sketch.evidence[s] : Evidence();
    const bool visible = length > 0 && extent.size > 0;
    curves.push_back(
        {{"kind", kind_name(sketch.strokes[s].kind)},
         {"nodes", {sketch.strokes[s].begin, sketch.strokes[s].end}},
         {"curve", curve[s]},
         {"length", length},
         {"opacity", e.opacity},
         {"support_views", e.support_views},
         {"rms_px", e.rms_px},
         {"sigma", e.sigma},
         {"inferred", is_inferred(e)},
         {"confidence", std::isnan(e.confidence) ? Json() : Json(e.confidence)},
         {"points", visible ? points_json(sketch, s, length, extent) : Json::array()}});
  }
  return curves;
}

// All that is needed to draw the curves over the photograph, as View and Lens do it.
Json photo_json(const PagePhoto& photo) {
  const View& view = photo.view;
  const Camera& c = view.camera;
  const Lens::Terms& k = view.lens.terms();
  Json rotation = Json::array();
  for (int r = 0; r < 3; ++r) rotation.push_back(json_of(view.cam_from_world.rotation.row(r)));
  Json json = {{"name", view.name},
               {"size", {c.width, c.height}},
               {"camera", {c.fx, c.fy, c.cx, c.cy}},
               {"rotation", rotation},
               {"translation", json_of(view.cam_from_world.translation)},
               {"jpeg", base64(photo.jpeg)}};
  if (view.lens.is_identity()) return json;
  json["fisheye"] = view.lens.model() == LensModel::kOpencvFisheye;
  json["lens"] = {k.k1, k.k2, k.p1, k.p2, k.k3, k.k4, k.k5, k.k6};
  json["range"] = std::isfinite(view.lens.range()) ? Json(view.lens.range()) : Json();
  return json;
}

// Triangles of the faces of the solid, for the screen, relative to the extent.
Json face_json(const FaceMesh& mesh, SurfaceKind kind, const Extent& extent) {
  Json points = Json::array(), triangles = Json::array();
  for (const Eigen::Vector3d& p : mesh.points)
    for (int k = 0; k < 3; ++k)
      points.push_back(std::round((p[k] - extent.center[k]) / extent.size * 1e5) / 1e5);
  for (const std::array<int, 3>& t : mesh.triangles)
    for (const int corner : t) triangles.push_back(corner);
  return {{"kind", surface_name(kind)}, {"points", points}, {"triangles", triangles}};
}

Json faces_json(const SolidOutcome* solid, const Extent& extent) {
  constexpr size_t kMostBytes = 300'000;  // of a page of 3 MB
  Json faces = Json::array();
  if (!solid || !(extent.size > 0)) return faces;
  const Solid& shown = *solid->search.solid;
  for (size_t f = 0; f < solid->mesh.size(); ++f)
    faces.push_back(face_json(solid->mesh[f], shown.surfaces[shown.faces[f].surface].kind, extent));
  return json_text(faces).size() > kMostBytes ? Json::array() : faces;
}

Json blends_json(const Blends& blends) {
  Json out = Json::array();
  for (size_t b = 0; b < blends.blends.size(); ++b) {
    const Blend& blend = blends.blends[b];
    const double length = stroke_length(blends.curves, int(b));
    const Eigen::Matrix3Xd points =
        sample_stroke(blends.curves, int(b), std::max(1e-12, length / kBlendPoints));
    Json along = Json::array();
    for (int i = 0; i < points.cols(); ++i)
      along.push_back({points(0, i), points(1, i), points(2, i)});
    out.push_back({{"kind", kind_name(blends.curves.strokes[b].kind)},
                   {"radius", blend.radius > 0 ? Json(blend.radius) : Json()},
                   {"sigma", blend.radius > 0 ? Json(blend.sigma) : Json()},
                   {"views", blend.views},
                   {"length", length},
                   {"along", along}});
  }
  return out;
}

}  // namespace

Extent sketch_extent(const Sketch& sketch) {
  Eigen::AlignedBox3d box;
  for (int s = 0; s < sketch.size(); ++s) {
    const double length = stroke_length(sketch, s);
    if (!(length > 0) || !std::isfinite(length)) continue;
    const Eigen::Matrix3Xd points = sample_stroke(sketch, s, length / 64);
    for (int i = 0; i < points.cols(); ++i) box.extend(points.col(i));
  }
  if (box.isEmpty()) return {};
  return {box.center(), box.sizes().maxCoeff(), box.sizes()};
}

std::string report_json(const ReportInput& input) {
  const RunReport& run = input.reconstruction->report;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - run.started;
  Json rounds = Json::array();
  for (const Numbers& round : run.rounds) rounds.push_back(object_of(round));
  Json json;
  json["program"] = "sketchsplat";
  json["version"] = program_version();
  json["commit"] = program_commit();
  json["scene"] = {{"folder", input.scene->folder}, {"format", input.scene->format}};
  if (!input.reproducible) {
    json["threads"] = omp_get_max_threads();
    json["seconds"] = seconds.count();
    json["peak_mb"] = peak_memory_mb();
  }
  json["counts"] = counts_json(input);
  if (input.scale && !input.scale->source.empty())
    json["scale"] = parse_json<Json>(scale_json(*input.scale));
  if (input.solid) json["solid"] = parse_json<Json>(solid_json(*input.solid));
  json["stages"] = stages_json(run, input.reproducible);
  json["rounds"] = rounds;
  json["strokes"] = Json::array();
  for (const Numbers& stroke : run.strokes) json["strokes"].push_back(object_of(stroke));
  if (!input.reconstruction->blends.blends.empty())
    json["blends"] = blends_json(input.reconstruction->blends);
  json["warnings"] = run.warnings;
  json["options"] = Json::parse(input.options_json);
  return json_text(json, 2) + "\n";
}

std::string report_html(const std::string& report, const ReportPage& page) {
  const Extent extent = sketch_extent(*page.sketch);
  Json data;
  data["report"] = parse_json<Json>(report);
  data["kinds"] = Json::array();
  for (const StrokeKind kind :
       {StrokeKind::kLine, StrokeKind::kArc, StrokeKind::kCircle, StrokeKind::kEllipse,
        StrokeKind::kEllipticArc, StrokeKind::kBezier})
    data["kinds"].push_back({{"name", kind_name(kind)}, {"color", kind_color(kind)}});
  data["extent"] = {
      {"center", json_of(extent.center)}, {"size", extent.size}, {"sides", json_of(extent.sides)}};
  data["curves"] = curves_json(*page.sketch, extent);
  data["faces"] = faces_json(page.solid, extent);
  data["photos"] = Json::array();
  for (const PagePhoto& photo : page.photos) data["photos"].push_back(photo_json(photo));

  return fill_page(kReportPage, json_text(data));
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include <cmath>
#include <istream>
#include <nlohmann/json.hpp>
#include <ostream>

#include "datasets/types/errors.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/graph/inferred.h"
#include "sketches/io/io.h"
#include "sketches/io/json.h"
#include "sketches/io/sketch_json.h"

namespace sketchsplat {
namespace {

constexpr int kSketchVersion = 1;
constexpr size_t kMostCount = 2000000000;  // of views

// What a reader who does not know our control points wants to know; we do not read it back.
void add_derived(const Sketch& sketch, int i, Json* stroke) {
  const StrokeKind kind = sketch.strokes[i].kind;
  if (kind == StrokeKind::kArc || kind == StrokeKind::kCircle) {
    const CircleParameters c = circle_parameters(sketch, i);
    if (!c.straight) {
      (*stroke)["centre"] = json_of_point(c.centre);
      (*stroke)["normal"] = json_of_point(c.normal);
      (*stroke)["radius"] = c.radius;
    }
    if (kind == StrokeKind::kArc) (*stroke)["angle"] = c.angle;
  } else if (kind == StrokeKind::kEllipse) {
    const ControlPoints c = control_points(sketch, i);
    const EllipseAxes axes = principal_axes(c.p[1], c.p[2]);
    (*stroke)["centre"] = json_of_point(c.p[0]);
    (*stroke)["major"] = json_of_point(axes.major);
    (*stroke)["minor"] = json_of_point(axes.minor);
  } else if (kind == StrokeKind::kEllipticArc) {
    const EllipticArcParameters e = elliptic_arc_parameters(control_points(sketch, i));
    if (e.straight) return;
    double shift = 0;
    const EllipseAxes axes = principal_axes(e.p, e.q, &shift);
    (*stroke)["centre"] = json_of_point(e.centre);
    (*stroke)["major"] = json_of_point(axes.major);
    (*stroke)["minor"] = json_of_point(axes.minor);
    (*stroke)["angles"] = {-e.half_angle - shift, e.half_angle - shift};
  }
}

// `node`: the index in the file of every node.
Json json_of(const Sketch& sketch, const CurveChain& chain, const std::vector<int>& node) {
  const int i = chain.strokes[0];
  const Stroke& s = sketch.strokes[i];
  const Evidence e = chain_evidence(sketch, chain);
  Json out;
  out["kind"] = kind_name(s.kind);
  out["nodes"] = is_closed(s.kind) ? Json::array() : Json{node[chain.begin], node[chain.end]};
  out["handles"] = Json::array();
  if (chain.strokes.size() > 1) {
    const Eigen::Matrix3Xd p = chain_points(sketch, chain);
    for (int k = 1; k + 1 < p.cols(); ++k)
      out["handles"].push_back(json_of_point(Eigen::Vector3d(p.col(k))));
  } else {
    for (int h = 0; h < num_handles(s.kind); ++h)
      out["handles"].push_back(json_of_point(Eigen::Vector3d(sketch.handles.col(s.handle + h))));
  }
  add_derived(sketch, i, &out);
  out["opacity"] = e.opacity;
  out["support_views"] = e.support_views;
  out["rms_px"] = e.rms_px;
  if (e.bias_px > 0) out["bias_px"] = e.bias_px;
  out["sigma"] = e.sigma;
  if (!std::isnan(e.confidence)) out["confidence"] = e.confidence;
  if (is_inferred(e)) out["inferred"] = true;
  if (!e.views.empty()) out["views"] = e.views;
  if (!e.covariance.empty()) {
    out["determined"] = e.determined;
    out["covariance"] = e.covariance;
  }
  return out;
}

void read_stroke(const JsonValue& j, size_t num_nodes, Sketch* sketch) {
  StrokeKind kind;
  if (!parse_kind(j["kind"].text(), &kind))
    j["kind"].complain("line, arc, circle, ellipse, bezier or elliptic_arc");
  const std::vector<JsonValue> nodes = j["nodes"].elements();
  if (nodes.size() != (is_closed(kind) ? 0u : 2u))
    j["nodes"].complain(is_closed(kind) ? "no nodes" : "two nodes");
  int ends[2] = {-1, -1};
  for (size_t k = 0; k < nodes.size(); ++k) ends[k] = nodes[k].index(num_nodes);
  std::vector<Eigen::Vector3d> points;
  for (const JsonValue& h : j["handles"].elements(kMostParts)) points.push_back(h.point());
  const bool spans = kind == StrokeKind::kBezier && points.size() % 3 == 2;
  if (!spans && int(points.size()) != num_handles(kind))
    j["handles"].complain(std::to_string(num_handles(kind)) + " handles" +
                          (kind == StrokeKind::kBezier ? ", or 3 n - 1 for n cubics" : ""));
  Evidence e;
  e.opacity = j.number("opacity", e.opacity);
  if (j.has("support_views")) e.support_views = j["support_views"].index(kMostCount);
  e.rms_px = j.number("rms_px", e.rms_px);
  e.bias_px = j.number("bias_px", e.bias_px);
  e.sigma = j.number("sigma", e.sigma);
  e.confidence = j.number("confidence", e.confidence);
  if (j.has("views"))
    for (const JsonValue& v : j["views"].elements()) e.views.push_back(v.index(kMostCount));
  if (j.has("covariance")) e.covariance = j["covariance"].numbers();
  if (j.has("determined")) e.determined = j["determined"].index(kMostCount);
  // Each third point of a chain of cubics is a joint.
  size_t at = 0;
  for (; spans && at + 2 < points.size(); at += 3) {
    const int joint = sketch->add_node(points[at + 2]);
    sketch->add_stroke(kind, ends[0], joint, {points[at], points[at + 1]}, e);
    ends[0] = joint;
  }
  sketch->add_stroke(kind, ends[0], ends[1], {points.begin() + long(at), points.end()}, e);
}

}  // namespace

Json json_of_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

void write_json_array(std::ostream& out, const char* name, const std::vector<Json>& items) {
  out << "  \"" << name << "\": [";
  for (size_t i = 0; i < items.size(); ++i)
    out << (i ? ",\n    " : "\n    ") << json_text(items[i]);
  out << (items.empty() ? "]" : "\n  ]");
}

void write_sketch_members(std::ostream& out, const Sketch& sketch,
                          const std::vector<CurveChain>& chains) {
  const std::vector<bool> inner = inner_joints(sketch, chains);
  std::vector<Json> nodes, strokes;
  std::vector<int> node(inner.size(), -1);
  for (size_t i = 0; i < inner.size(); ++i) {
    if (inner[i]) continue;
    node[i] = int(nodes.size());
    nodes.push_back(json_of_point(Eigen::Vector3d(sketch.nodes.col(i))));
  }
  for (const CurveChain& chain : chains) strokes.push_back(json_of(sketch, chain, node));
  write_json_array(out, "nodes", nodes);
  out << ",\n";
  write_json_array(out, "strokes", strokes);
}

void write_sketch_json(std::ostream& out, const Sketch& sketch, const std::string& extra) {
  out << "{\n  \"format_version\": " << kSketchVersion << ",\n";
  if (!extra.empty()) {
    Json members;
    try {
      members = parse_json<Json>(extra);
    } catch (const Json::parse_error&) {
    }
    if (!members.is_object()) throw InputError("extra members of a sketch", "a JSON object", extra);
    for (const auto& [key, value] : members.items())
      if (key != "format_version" && key != "nodes" && key != "strokes")
        out << "  " << json_text(Json(key)) << ": " << json_text(value) << ",\n";
  }
  write_sketch_members(out, sketch, curve_chains(sketch));
  out << "\n}\n";
}

Sketch sketch_of_members(const JsonValue& object) {
  Sketch sketch;
  const std::vector<JsonValue> nodes = object["nodes"].elements(kMostParts);
  sketch.nodes.resize(3, Eigen::Index(nodes.size()));
  for (size_t i = 0; i < nodes.size(); ++i) sketch.nodes.col(Eigen::Index(i)) = nodes[i].point();
  for (const JsonValue& stroke : object["strokes"].elements(kMostParts)) {
    read_stroke(stroke, nodes.size(), &sketch);
    if (sketch.strokes.size() > kMostParts)
      throw InputError(object.path, "at most " + std::to_string(kMostParts) + " pieces of curves",
                       "more");
  }
  const std::vector<std::string> complaints = validate(sketch);
  if (complaints.empty()) return sketch;
  const size_t more = complaints.size() - 1;
  throw InputError(object.path, "a sound sketch",
                   complaints[0] + (more ? " (and " + std::to_string(more) + " more)" : ""));
}

Sketch read_sketch_json(std::istream& in, const std::string& path) {
  const JsonValue file = read_json(in, path, "a sketch as JSON");
  file.expect_version(kSketchVersion);
  return sketch_of_members(file);
}

}  // namespace sketchsplat

// SPDX-License-Identifier: MIT
#include "sketches/io/io_solid.h"

#include <cmath>
#include <istream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "sketches/curve/curve_chain.h"
#include "sketches/io/json.h"
#include "sketches/io/sketch_json.h"

namespace sketchsplat {
namespace {

constexpr int kSolidVersion = 1;

Json json_of_surface(const Surface& s) {
  Json out = {{"kind", surface_name(s.kind)}, {"origin", json_of_point(s.origin)}};
  if (s.kind != SurfaceKind::kSphere) out["axis"] = json_of_point(s.axis);
  if (s.kind == SurfaceKind::kExtrusion) {
    Json points = Json::array();
    for (const Eigen::Vector3d& p : s.profile) points.push_back(json_of_point(p));
    out["profile"] = {{"kind", kind_name(s.profile_kind)}, {"points", points}};
    return out;
  }
  if (s.kind != SurfaceKind::kPlane) out["radius"] = s.radius;
  if (s.kind == SurfaceKind::kCone) out["slope"] = s.slope;
  if (s.kind == SurfaceKind::kTorus) out["minor_radius"] = s.minor_radius;
  return out;
}

// Each loop as [[edge, forward], ...].
Json json_of_face(const SolidFace& face) {
  Json loops = Json::array();
  for (const Loop& loop : face.loops) {
    loops.push_back(Json::array());
    for (const LoopStroke& s : loop) loops.back().push_back({s.stroke, s.forward});
  }
  return {{"surface", face.surface}, {"reversed", face.reversed}, {"loops", loops}};
}

SurfaceKind kind_of(const JsonValue& j) {
  const std::string name = j["kind"].text();
  for (int k = 0; k < kNumSurfaceKinds; ++k)
    if (name == surface_name(SurfaceKind(k))) return SurfaceKind(k);
  j["kind"].complain("plane, cylinder, cone, sphere, torus or extrusion");
}

void read_profile(const JsonValue& profile, Surface* s) {
  if (!parse_kind(profile["kind"].text(), &s->profile_kind))
    profile["kind"].complain("a kind of curve");
  for (const JsonValue& p : profile["points"].elements(kMostParts)) s->profile.push_back(p.point());
  if (int(s->profile.size()) != num_controls(s->profile_kind))
    profile["points"].complain(std::to_string(num_controls(s->profile_kind)) + " points");
}

Surface read_surface(const JsonValue& j) {
  constexpr double kNoDirection = 1e-6;  // off the length of a unit vector
  Surface s;
  s.kind = kind_of(j);
  s.origin = j["origin"].point();
  if (j.has("axis")) s.axis = j["axis"].point();
  s.radius = j.number("radius", 0);
  s.slope = j.number("slope", 0);
  s.minor_radius = j.number("minor_radius", 0);
  if (s.kind == SurfaceKind::kExtrusion) read_profile(j["profile"], &s);
  if (!(std::abs(s.axis.norm() - 1) < kNoDirection)) j["axis"].complain("a unit vector");
  return s;
}

SolidFace read_face(const JsonValue& j, const Solid& solid) {
  SolidFace face;
  face.surface = j["surface"].index(solid.surfaces.size());
  face.reversed = j["reversed"].flag();
  for (const JsonValue& loop : j["loops"].elements(kMostParts)) {
    face.loops.emplace_back();
    for (const JsonValue& s : loop.elements()) {
      const std::vector<JsonValue> pair = s.elements();
      if (pair.size() != 2) s.complain("[edge, forward]");
      face.loops.back().push_back({pair[0].index(size_t(solid.edges.size())), pair[1].flag()});
    }
  }
  return face;
}

}  // namespace

void write_solid_json(std::ostream& out, const Solid& solid, const std::string& extra) {
  out << "{\n  \"format_version\": " << kSolidVersion << ",\n";
  const Json members = extra.empty() ? Json::object() : parse_json<Json>(extra);
  for (const auto& [key, value] : members.items())
    out << "  " << json_text(Json(key)) << ": " << json_text(value) << ",\n";
  Json inferred = Json::array();
  for (size_t i = 0; i < solid.inferred.size(); ++i)
    if (solid.inferred[i]) inferred.push_back(i);
  out << "  \"gap\": " << json_text(Json(solid.gap)) << ",\n  \"inferred\": " << json_text(inferred)
      << ",\n";
  std::vector<Json> surfaces, faces;
  for (const Surface& s : solid.surfaces) surfaces.push_back(json_of_surface(s));
  for (const SolidFace& f : solid.faces) faces.push_back(json_of_face(f));
  write_json_array(out, "surfaces", surfaces);
  out << ",\n";
  write_json_array(out, "faces", faces);
  out << ",\n  \"edges\": {\n";
  // Loops count strokes, so that no spans of a spline become one.
  const std::vector<bool> alone(size_t(solid.edges.size()), true);
  write_sketch_members(out, solid.edges, curve_chains(solid.edges, alone));
  out << "\n  }\n}\n";
}

Solid read_solid_json(std::istream& in, const std::string& path) {
  const JsonValue file = read_json(in, path, "a solid as JSON");
  file.expect_version(kSolidVersion);
  Solid solid;
  solid.edges = sketch_of_members(file["edges"]);
  solid.inferred.assign(size_t(solid.edges.size()), false);
  for (const JsonValue& i : file["inferred"].elements())
    solid.inferred[size_t(i.index(solid.inferred.size()))] = true;
  for (const JsonValue& s : file["surfaces"].elements(kMostParts))
    solid.surfaces.push_back(read_surface(s));
  for (const JsonValue& f : file["faces"].elements(kMostParts))
    solid.faces.push_back(read_face(f, solid));
  solid.gap = file.number("gap", 0);
  return solid;
}

}  // namespace sketchsplat

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

constexpr int kFormatVersion = 1;

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

SurfaceKind kind_of(const JsonReader& reader, const Json& j, const std::string& where) {
  const Json& name = reader.member(j, "kind", where);
  for (int k = 0; k < kNumSurfaceKinds; ++k)
    if (name.is_string() && name.get<std::string>() == surface_name(SurfaceKind(k)))
      return SurfaceKind(k);
  reader.fail("plane, cylinder, cone, sphere, torus or extrusion as \"kind\" of " + where,
              JsonReader::summary(name));
}

void read_profile(const JsonReader& reader, const Json& j, const std::string& where, Surface* s) {
  const Json& profile = reader.member(j, "profile", where);
  const Json& kind = reader.member(profile, "kind", "profile of " + where);
  if (!kind.is_string() || !parse_kind(kind.get<std::string>(), &s->profile_kind))
    reader.fail("a kind of curve as profile of " + where, JsonReader::summary(kind));
  for (const Json& p : reader.array(profile, "points", "profile of " + where, kMostParts))
    s->profile.push_back(reader.point(p, "a point of the profile of " + where));
  if (int(s->profile.size()) != num_controls(s->profile_kind))
    reader.fail(
        std::to_string(num_controls(s->profile_kind)) + " points in the profile of " + where,
        std::to_string(s->profile.size()));
}

Surface read_surface(const JsonReader& reader, const Json& j, const std::string& where) {
  constexpr double kNoDirection = 1e-6;  // off the length of a unit vector
  Surface s;
  s.kind = kind_of(reader, j, where);
  s.origin = reader.point(reader.member(j, "origin", where), "origin of " + where);
  if (j.contains("axis")) s.axis = reader.point(j["axis"], "axis of " + where);
  s.radius = reader.number(j, "radius", 0, where);
  s.slope = reader.number(j, "slope", 0, where);
  s.minor_radius = reader.number(j, "minor_radius", 0, where);
  if (s.kind == SurfaceKind::kExtrusion) read_profile(reader, j, where, &s);
  if (!(std::abs(s.axis.norm() - 1) < kNoDirection))
    reader.fail("a unit vector as axis of " + where, JsonReader::summary(j["axis"]));
  return s;
}

int index_of(const JsonReader& reader, const Json& j, size_t count, const std::string& what) {
  const int index = reader.integer(j, "an index of " + what);
  if (size_t(index) >= count)
    reader.fail("an index of " + what + " below " + std::to_string(count), std::to_string(index));
  return index;
}

bool flag(const JsonReader& reader, const Json& j, const std::string& where) {
  if (!j.is_boolean()) reader.fail("true or false as " + where, JsonReader::summary(j));
  return j.get<bool>();
}

SolidFace read_face(const JsonReader& reader, const Json& j, const Solid& solid,
                    const std::string& where) {
  SolidFace face;
  face.surface = index_of(reader, reader.member(j, "surface", where), solid.surfaces.size(),
                          "a surface in " + where);
  face.reversed = flag(reader, reader.member(j, "reversed", where), "\"reversed\" of " + where);
  for (const Json& loop : reader.array(j, "loops", where, kMostParts)) {
    face.loops.emplace_back();
    if (!loop.is_array()) reader.fail("an array as loop of " + where, loop.type_name());
    for (const Json& s : loop) {
      if (!s.is_array() || s.size() != 2)
        reader.fail("[edge, forward] in a loop of " + where, JsonReader::summary(s));
      const int edge =
          index_of(reader, s[0], size_t(solid.edges.size()), "an edge in a loop of " + where);
      face.loops.back().push_back({edge, flag(reader, s[1], "direction in a loop of " + where)});
    }
  }
  return face;
}

}  // namespace

void write_solid_json(std::ostream& out, const Solid& solid, const std::string& extra) {
  out << "{\n  \"format_version\": " << kFormatVersion << ",\n";
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
  const JsonReader reader(path);
  Json j;
  try {
    j = parse_json<Json>(in, path);
  } catch (const Json::exception& e) {
    reader.fail("a solid as JSON", e.what());
  }
  const Json& version = reader.member(j, "format_version", "the file");
  if (version != Json(kFormatVersion))
    reader.fail("format_version " + std::to_string(kFormatVersion), JsonReader::summary(version));
  Solid solid;
  solid.edges = sketch_of_members(reader.member(j, "edges", "the file"), reader);
  solid.inferred.assign(size_t(solid.edges.size()), false);
  for (const Json& i : reader.array(j, "inferred", "the file"))
    solid.inferred[size_t(index_of(reader, i, solid.inferred.size(), "an edge in \"inferred\""))] =
        true;
  const Json& surfaces = reader.array(j, "surfaces", "the file", kMostParts);
  for (size_t i = 0; i < surfaces.size(); ++i)
    solid.surfaces.push_back(read_surface(reader, surfaces[i], "surface " + std::to_string(i)));
  const Json& faces = reader.array(j, "faces", "the file", kMostParts);
  for (size_t i = 0; i < faces.size(); ++i)
    solid.faces.push_back(read_face(reader, faces[i], solid, "face " + std::to_string(i)));
  solid.gap = reader.number(j, "gap", 0, "the file");
  return solid;
}

}  // namespace sketchsplat

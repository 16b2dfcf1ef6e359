// SPDX-License-Identifier: MIT
#include "sketches/io/io_glb.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "sketches/curve/curve.h"
#include "sketches/graph/kind_color.h"
#include "sketches/io/json.h"
#include "sketches/io/little_endian.h"

namespace sketchsplat {
namespace {

constexpr StrokeKind kKinds[] = {StrokeKind::kLine,        StrokeKind::kArc,
                                 StrokeKind::kCircle,      StrokeKind::kEllipse,
                                 StrokeKind::kEllipticArc, StrokeKind::kBezier};
constexpr int kChords = 64;  // of a curve that is no line
// Numbers of the format (Khronos, glTF 2.0 specification).
constexpr int kFloat = 5126, kLines = 1, kVertices = 34962;

// Both ends of every chord of all strokes of a kind, one after another.
std::vector<Eigen::Vector3d> chord_ends(const Sketch& sketch, StrokeKind kind) {
  std::vector<Eigen::Vector3d> ends;
  for (int s = 0; s < sketch.size(); ++s) {
    const double length = stroke_length(sketch, s);
    if (sketch.strokes[s].kind != kind || !(length > 0)) continue;
    const Eigen::Matrix3Xd points =
        sample_stroke(sketch, s, length / (kind == StrokeKind::kLine ? 1 : kChords));
    for (int i = 0; i + 1 < points.cols(); ++i) {
      ends.push_back(points.col(i));
      ends.push_back(points.col(i + 1));
    }
  }
  return ends;
}

// The bytes of the positions, and a view and an accessor for them.
void add_positions(const std::vector<Eigen::Vector3d>& points, std::string* bytes, Json* gltf) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(INFINITY), high = -low;
  const size_t begin = bytes->size();
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3f f = p.cast<float>();
    low = low.cwiseMin(f);
    high = high.cwiseMax(f);
    for (int k = 0; k < 3; ++k) append(f[k], bytes);
  }
  (*gltf)["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", begin},
                                    {"byteLength", bytes->size() - begin},
                                    {"target", kVertices}});
  (*gltf)["accessors"].push_back({{"bufferView", (*gltf)["bufferViews"].size() - 1},
                                  {"componentType", kFloat},
                                  {"count", points.size()},
                                  {"type", "VEC3"},
                                  {"min", {low.x(), low.y(), low.z()}},
                                  {"max", {high.x(), high.y(), high.z()}}});
}

void write_chunk(std::ostream& out, const char* type, const std::string& bytes) {
  std::string head;
  append(std::uint32_t(bytes.size()), &head);
  out << head << std::string(type, 4) << bytes;
}

}  // namespace

void write_glb(std::ostream& out, const Sketch& sketch, const GlbOptions& options) {
  Json gltf = {{"asset", {{"version", "2.0"}, {"generator", "sketchsplat"}}}, {"scene", 0}};
  // The format's up is y, ours z.
  gltf["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
  const double half = std::sqrt(0.5);
  gltf["nodes"] = Json::array({{{"name", options.name}, {"rotation", {-half, 0, 0, half}}}});
  std::string bytes;
  for (const StrokeKind kind : kKinds) {
    std::vector<Eigen::Vector3d> points = chord_ends(sketch, kind);
    if (points.empty()) continue;
    for (Eigen::Vector3d& p : points) p *= options.scale;
    add_positions(points, &bytes, &gltf);
    const int index = int(gltf["accessors"].size()) - 1;
    const auto color = kind_color(kind);
    gltf["materials"].push_back(
        {{"name", kind_name(kind)},
         {"pbrMetallicRoughness", {{"baseColorFactor", {color[0], color[1], color[2], 1}}}},
         {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    const Json primitive = {
        {"attributes", {{"POSITION", index}}}, {"mode", kLines}, {"material", index}};
    gltf["meshes"].push_back({{"name", kind_name(kind)}, {"primitives", Json::array({primitive})}});
    gltf["nodes"][0]["children"].push_back(index + 1);
    gltf["nodes"].push_back({{"name", kind_name(kind)}, {"mesh", index}});
  }
  if (!bytes.empty()) {
    gltf["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
    gltf["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
  }
  std::string text = json_text(gltf);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string head = "glTF";
  append(std::uint32_t(2), &head);
  append(std::uint32_t(12 + 8 + text.size() + (bytes.empty() ? 0 : 8 + bytes.size())), &head);
  out << head;
  write_chunk(out, "JSON", text);
  if (!bytes.empty()) write_chunk(out, "BIN\0", bytes);
}

}  // namespace sketchsplat

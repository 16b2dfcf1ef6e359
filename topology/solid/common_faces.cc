// SPDX-License-Identifier: MIT
#include "topology/solid/common_faces.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace sketchsplat {
namespace {

using Numbers = std::vector<double>;

void append(const Eigen::Vector3d& v, Numbers* out) {
  out->insert(out->end(), v.data(), v.data() + 3);
}

Numbers numbers_of(const Sketch& sketch, int stroke) {
  Numbers out = {double(sketch.strokes[stroke].kind)};
  const ControlPoints c = control_points(sketch, stroke);
  for (int k = 0; k < c.count; ++k) append(c.p[k], &out);
  return out;
}

Numbers numbers_of(const Surface& s) {
  Numbers out = {double(s.kind), s.radius, s.slope, s.minor_radius};
  append(s.origin, &out);
  append(s.axis, &out);
  return out;
}

// Surface and side, and the curves with the directions in which they are run.
using Key = std::pair<Numbers, std::set<std::pair<Numbers, bool>>>;

Key key_of(const Solid& solid, const SolidFace& face) {
  Key key{numbers_of(solid.surfaces[face.surface]), {}};
  key.first.push_back(face.reversed);
  for (const Loop& loop : face.loops)
    for (const LoopStroke& s : loop)
      key.second.insert({numbers_of(solid.edges, s.stroke), s.forward});
  return key;
}

}  // namespace

Solid common_faces(const Solid& one, const Solid& other) {
  std::set<Key> keys;
  for (const SolidFace& face : other.faces) keys.insert(key_of(other, face));
  std::vector<bool> keep;
  for (const SolidFace& face : one.faces) keep.push_back(keys.count(key_of(one, face)) > 0);
  return keep_faces(one, keep);
}

Solid keep_faces(const Solid& solid, const std::vector<bool>& keep) {
  Solid out;
  std::vector<bool> bounds(solid.edges.size());
  std::map<int, int> surface_index;
  for (size_t f = 0; f < keep.size(); ++f) {
    if (!keep[f]) continue;
    const SolidFace& face = solid.faces[f];
    const auto [it, first] = surface_index.emplace(face.surface, int(out.surfaces.size()));
    if (first) out.surfaces.push_back(solid.surfaces[face.surface]);
    out.faces.push_back({it->second, face.reversed, face.loops});
    for (const Loop& loop : face.loops)
      for (const LoopStroke& s : loop) bounds[s.stroke] = true;
  }
  std::vector<int> index(bounds.size(), -1);
  for (size_t s = 0; s < bounds.size(); ++s)
    if (bounds[s]) {
      index[s] = int(out.inferred.size());
      out.inferred.push_back(solid.inferred[s]);
    }
  out.edges = keep_strokes(solid.edges, bounds);
  for (SolidFace& face : out.faces)
    for (Loop& loop : face.loops)
      for (LoopStroke& s : loop) s.stroke = index[s.stroke];
  return out;
}

}  // namespace sketchsplat

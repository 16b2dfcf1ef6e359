// SPDX-License-Identifier: MIT
#include "topology/solid/keep_faces.h"

#include <map>
#include <vector>

namespace sketchsplat {

Solid keep_faces(const Solid& solid, const std::vector<bool>& keep, std::vector<int>* edge_of) {
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
  if (edge_of) *edge_of = index;
  return out;
}

}  // namespace sketchsplat

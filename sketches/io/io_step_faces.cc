// SPDX-License-Identifier: MIT
#include <map>
#include <numeric>

#include "sketches/io/step_file.h"

namespace sketchsplat::step {
namespace {

int write_bound(StepFile* file, const char* entity, const Loop& loop,
                const std::vector<int>& edges) {
  std::vector<int> oriented;
  for (const LoopStroke& s : loop)
    oriented.push_back(file->add("ORIENTED_EDGE('',*,*," + reference(edges[s.stroke]) +
                                 (s.forward ? ",.T.)" : ",.F.)")));
  const int edge_loop = file->add("EDGE_LOOP(''," + list(oriented) + ")");
  return file->add(std::string(entity) + "(''," + reference(edge_loop) + ",.T.)");
}

int write_face(StepFile* file, const PlanarFace& face, const std::vector<int>& edges,
               const std::string& name) {
  std::vector<int> bounds = {write_bound(file, "FACE_OUTER_BOUND", face.outer, edges)};
  for (const Loop& hole : face.holes)
    bounds.push_back(write_bound(file, "FACE_BOUND", hole, edges));
  const int frame = file->placement(face.point, face.normal, plain_direction(face.normal));
  const int plane = file->add("PLANE(''," + reference(frame) + ")");
  return file->add("ADVANCED_FACE(" + quoted(name) + "," + list(bounds) + "," + reference(plane) +
                   ",.T.)");
}

// Number of the first face of the set that each face belongs to.
std::vector<int> sets_of(const std::vector<PlanarFace>& faces) {
  std::vector<int> set(faces.size());
  std::iota(set.begin(), set.end(), 0);
  const auto root = [&](int f) {
    while (set[f] != f) f = set[f];
    return f;
  };
  std::map<int, int> face_of;  // of a stroke
  for (int f = 0; f < int(faces.size()); ++f) {
    std::vector<Loop> loops = faces[f].holes;
    loops.push_back(faces[f].outer);
    for (const Loop& loop : loops)
      for (const LoopStroke& s : loop) {
        const int a = root(face_of.emplace(s.stroke, f).first->second), b = root(f);
        set[std::max(a, b)] = std::min(a, b);
      }
  }
  for (int f = 0; f < int(faces.size()); ++f) set[f] = root(f);
  return set;
}

}  // namespace

int write_surface_model(StepFile* file, const std::vector<PlanarFace>& faces,
                        const std::vector<int>& edges, const std::string& name,
                        std::vector<int>* face_ids) {
  const std::vector<int> set = sets_of(faces);
  std::map<int, std::vector<int>> shells;
  for (size_t f = 0; f < faces.size(); ++f) {
    face_ids->push_back(write_face(file, faces[f], edges, "face_" + std::to_string(f)));
    shells[set[f]].push_back(face_ids->back());
  }
  std::vector<int> ids;
  for (const auto& [first, members] : shells)
    ids.push_back(file->add("OPEN_SHELL(''," + list(members) + ")"));
  return file->add("SHELL_BASED_SURFACE_MODEL(" + quoted(name) + "," + list(ids) + ")");
}

}  // namespace sketchsplat::step

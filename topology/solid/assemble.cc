// SPDX-License-Identifier: MIT
#include "topology/solid/assemble.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "topology/solid/cell_index.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

using HalfEdge = std::pair<int, bool>;  // stroke, forward

// A face with what it takes to ask for points on it.
struct Patch {
  Surface surface;
  Layout layout;
  Cell cell;
  CellIndex index;
  bool turned = false;  ///< the solid is on the side of the surface's normal
};

std::set<HalfEdge> half_edges(const Cell& cell) {
  std::set<HalfEdge> out;
  for (const Loop& loop : cell.loops)
    for (const LoopStroke& s : loop) out.insert({s.stroke, s.forward});
  return out;
}

// Chosen cells of one surface without the strokes between two of them.
std::vector<Cell> merged(const Sketch& sketch, const std::vector<Matrix3Xd>& polylines,
                         const SurfaceStrokes& surface, int index,
                         const std::vector<const Cell*>& chosen) {
  std::set<HalfEdge> all;
  for (const Cell* cell : chosen) all.merge(half_edges(*cell));
  SurfaceStrokes border = surface;
  border.strokes.clear();
  for (const int s : surface.strokes)
    if (all.count({s, true}) != all.count({s, false})) border.strokes.push_back(s);
  std::vector<Cell> out;
  for (const Cell& cell : cells_of(sketch, polylines, border, index)) {
    const std::set<HalfEdge> own = half_edges(cell);
    if (std::includes(all.begin(), all.end(), own.begin(), own.end())) out.push_back(cell);
  }
  return out;
}

// Turns patches so that neighbours run their common stroke in opposite directions; false if that
// cannot be, or if a stroke has one patch and is not open. Each connected part keeps the sense of
// its first patch.
bool turn_alike(const std::vector<bool>& open, std::vector<Patch>* patches,
                std::vector<int>* part) {
  std::map<int, std::vector<std::pair<int, bool>>> uses;  // of a stroke: patch, forward
  for (int p = 0; p < int(patches->size()); ++p)
    for (const HalfEdge& h : half_edges((*patches)[p].cell))
      uses[h.first].emplace_back(p, h.second);
  std::vector<std::vector<std::pair<int, bool>>> beside(patches->size());
  for (const auto& [stroke, of] : uses) {
    if (of.size() == 1 && open[stroke]) continue;
    if (of.size() != 2) return false;
    const bool same = of[0].second == of[1].second;
    beside[of[0].first].emplace_back(of[1].first, same);
    beside[of[1].first].emplace_back(of[0].first, same);
  }
  part->assign(patches->size(), -1);
  for (int first = 0; first < int(patches->size()); ++first) {
    if ((*part)[first] >= 0) continue;
    std::vector<int> set = {first};
    (*part)[first] = first;
    for (size_t k = 0; k < set.size(); ++k)
      for (const auto& [other, same] : beside[set[k]]) {
        const bool turned = (*patches)[set[k]].turned != same;
        if ((*part)[other] >= 0) {
          if ((*patches)[other].turned != turned) return false;
          continue;
        }
        (*part)[other] = first;
        (*patches)[other].turned = turned;
        set.push_back(other);
      }
  }
  return true;
}

// Patches that a ray from a point meets.
int hits(const std::vector<Patch>& patches, const Vector3d& from, const Vector3d& to) {
  int count = 0;
  for (const Patch& p : patches) {
    const Crossings c = crossings(p.layout, from, to);
    for (int i = 0; i < c.count; ++i)
      count += p.index.holds(p.layout.flat(Vector3d(from + c.t[i] * (to - from))));
  }
  return count;
}

// Outside is where an odd number of patches lies behind, the own one counted. Several places vote:
// a ray may graze an edge.
void turn_outwards(const std::vector<int>& part, double extent, std::vector<Patch>* patches) {
  std::map<int, int> votes;
  for (size_t p = 0; p < patches->size(); ++p) {
    const Patch& patch = (*patches)[p];
    for (const Vector3d& point : points_within(patch.cell, patch.layout, 5)) {
      const Vector3d normal = surface_normal(patch.surface, point);
      const Vector3d aside = normal + 0.1 * Vector3d(0.3, 0.5, 0.8);
      const int ahead = hits(*patches, point + 1e-6 * extent * normal, point + 4 * extent * aside);
      votes[part[p]] += (ahead % 2 == 0) == patch.turned ? -1 : 1;
    }
  }
  for (size_t p = 0; p < patches->size(); ++p)
    if (votes[part[p]] < 0) (*patches)[p].turned = !(*patches)[p].turned;
}

Loop reversed(const Loop& loop) {
  Loop out(loop.rbegin(), loop.rend());
  for (LoopStroke& s : out) s.forward = !s.forward;
  return out;
}

}  // namespace

bool assemble(const Completed& all, const std::vector<Cell>& cells, const ChosenCells& chosen,
              Solid* solid, std::string* why) {
  const std::vector<SurfaceStrokes>& surfaces = all.surfaces;
  std::vector<Patch> patches;
  for (int i = 0; i < int(surfaces.size()); ++i) {
    std::vector<const Cell*> own;
    for (size_t c = 0; c < cells.size(); ++c)
      if (cells[c].surface == i && chosen.cell[c]) own.push_back(&cells[c]);
    if (own.empty()) continue;
    const Layout layout = layout_of(surfaces[i]);
    for (const Cell& cell : merged(all.sketch, all.polylines, surfaces[i], i, own))
      patches.push_back({surfaces[i].surface, layout, cell, CellIndex(cell, layout)});
  }
  std::vector<int> part;
  if (patches.empty() || !turn_alike(chosen.open, &patches, &part)) {
    *why = patches.empty() ? "no faces close" : "faces cannot be told inside from outside";
    return false;
  }
  turn_outwards(part, largest_extent(all.sketch), &patches);

  *solid = Solid();
  solid->edges = all.sketch;
  for (const EdgeOrigin origin : all.origin) solid->inferred.push_back(origin != EdgeOrigin::kSeen);
  for (const SurfaceStrokes& s : surfaces) solid->surfaces.push_back(s.surface);
  for (const Patch& p : patches) {
    SolidFace face{p.cell.surface, p.turned, {}};
    for (const Loop& loop : p.cell.loops) face.loops.push_back(p.turned ? reversed(loop) : loop);
    solid->faces.push_back(face);
  }
  return true;
}

}  // namespace sketchsplat
